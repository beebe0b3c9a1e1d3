// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that do not meet during a motion: bodies that were apart then stay apart, even where one encloses
// the other.
#include <algorithm>
#include <array>
#include <cmath>

#include "judge/motion_judge.h"
#include "judge/pair_path.h"
#include "surface/triangle_gap.h"

namespace vps::scenes {

namespace {

/// Number of failed proofs of a pair, less the successful ones, after which no further proof is tried.
constexpr int kFailures = 3;
/// Greatest number of boxes that are tested for one interval. A ball of 960 triangles that passes a bore of
/// 384 triangles takes 10,000 to 20,000 tests of boxes.
constexpr std::size_t kMostBoxes = 40000;

/// A piece of the relative motion, in the frame of a. Each point of b moves along a line and deviates from it
/// by at most bend_m.
struct Chord {
  Pose from_AB, to_AB;
  double bend_m = 0;

  [[nodiscard]] Box swept(const Box& box_B) const {
    Box box = moved(box_B, from_AB);
    const Box end = moved(box_B, to_AB);
    box.add(end.min);
    box.add(end.max);
    return grown(box, bend_m);
  }
};

Vec3 normalOf(const Triangle& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]);
}

Vec3 middleOf(const Triangle& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

/// Whether a plane with this normal separates a fixed triangle from a moving triangle (at both ends of its
/// motion) by more than apart_m.
bool areOnBothSides(const Vec3& n, const Triangle& fixed, const std::array<Triangle, 2>& moving,
                    double apart_m) {
  double low = 1e300, high = -1e300, moving_low = 1e300, moving_high = -1e300;
  for (const Vec3& p : fixed) {
    low = std::min(low, n.dot(p));
    high = std::max(high, n.dot(p));
  }
  for (const Triangle& t : moving)
    for (const Vec3& p : t) {
      moving_low = std::min(moving_low, n.dot(p));
      moving_high = std::max(moving_high, n.dot(p));
    }
  return std::max(moving_low - high, low - moving_high) > apart_m * n.norm();
}

/// Whether one plane separates the triangles along the whole chord.
bool areApart(const Triangle& fixed, const std::array<Triangle, 2>& moving, double apart_m) {
  const auto isAlong = [&](const Vec3& n) { return areOnBothSides(n, fixed, moving, apart_m); };
  if (isAlong(normalOf(fixed)) || isAlong(normalOf(moving[0])) || isAlong(normalOf(moving[1]))) return true;
  // A triangle that passes a rim, or passes through a ring, is separated from the rim or ring by a plane
  // along its path.
  const Vec3 way = middleOf(moving[1]) - middleOf(moving[0]);
  for (const Triangle& t : {fixed, moving[0], moving[1]})
    for (std::size_t v = 0; v < 3; ++v)
      if (isAlong((t[(v + 1) % 3] - t[v]).cross(way))) return true;
  return std::any_of(moving.begin(), moving.end(), [&](const Triangle& t) {
    const TriangleGap gap = triangleGap(fixed, t);
    return gap.distance_m > 0 && isAlong(gap.p_b - gap.p_a);
  });
}

/// Whether no triangles of the bodies can meet along the chord.
/// @param boxes number of boxes that may still be tested
bool areApartOn(const Chord& chord, const ExactBody& a, const ExactBody& b, std::size_t& boxes) {
  bool is_apart = true;
  visitPairs(
      a.tree(), b.tree(),
      [&](const Box& box_B) {
        if (boxes > 0) --boxes;
        return chord.swept(box_B);
      },
      [](const Box& of_a, const Box& of_b) { return distance2(of_a, of_b); },
      [&] {
        return is_apart && boxes > 0 ? 1e-300 : -1.0;
      },  // visits boxes that meet, until two triangles may meet
      [&](std::uint32_t i, std::uint32_t k) {
        if (!is_apart) return;
        const Triangle of_b = b.triangle(k);
        std::array<Triangle, 2> moving;
        for (std::size_t v = 0; v < 3; ++v) {
          moving[0][v] = chord.from_AB * of_b[v];
          moving[1][v] = chord.to_AB * of_b[v];
        }
        is_apart = areApart(a.triangle(i), moving, chord.bend_m);
      });
  return is_apart && boxes > 0;
}

}  // namespace

/// Whether it is proven that no triangles of the two bodies meet during the interval. Bodies that are apart
/// at one moment of the interval are then apart during all of it.
bool MotionJudge::areSurfacesApart(PairPath& path, double from, double to) {
  if (path.failures > kFailures) return false;
  const auto stepsOf = [&](const auto& visit) {
    for (double begin = from; begin < to;) {
      const double end = std::min(to, std::floor(begin) + 1);
      const double sagitta_m = path.sagitta_m[static_cast<std::size_t>(begin)];
      if (!visit(begin, end, sagitta_m, chordsOf(sagitta_m * (end - begin) * (end - begin)))) return false;
      begin = end;
    }
    return true;
  };
  double all = 0;
  if (!stepsOf([&](double, double, double, double chords) { return (all += chords) <= kMostChords; }))
    return false;  // the interval is too long; its halves are tried later
  const double most = std::max(may_prove_, 0.0) * static_cast<double>(kBoxesPerWork);
  const auto limit = static_cast<std::size_t>(std::min<double>(kMostBoxes, most));
  std::size_t boxes = limit;
  const auto poseOf = [&](double step) {
    return Pose(poseAt(path.a, step).inverse() * poseAt(path.b, step));
  };
  const bool is_apart = stepsOf([&](double begin, double end, double sagitta_m, double chords) {
    for (double i = 0; i < chords; ++i) {
      const double share = (end - begin) / chords;
      const Chord chord{poseOf(std::lerp(begin, end, i / chords)),
                        poseOf(std::lerp(begin, end, (i + 1) / chords)), sagitta_m * share * share};
      if (!areApartOn(chord, body(path.a), body(path.b), boxes)) return false;
    }
    return true;
  });
  const double work = 1 + static_cast<double>((limit - boxes) / kBoxesPerWork);
  spend(work);
  may_prove_ -= work;
  path.failures += is_apart ? -1 : 1;
  if (is_apart) path.end_depth_m = std::min(path.end_depth_m, path.travel_m.back() - path.travelAt(to));
  return is_apart;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_measures.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vps::scenes {

namespace {

/// A plane that the true face may have: that of a facet, or of an adjacent facet of the same curved face.
struct Leaning {
  Vec3 n;
  double chord_m;
};

/// Appends the planes of a facet. The normals of a curved face at a facet lie between the normals of the
/// facet and of its neighbours.
void addLeanings(const PartSurface& part, std::uint32_t facet, std::vector<Leaning>& to) {
  const double chord_m = part.chordBound_m(facet);
  const Vec3 n = part.normal(facet);
  to.push_back({n, chord_m});
  if (chord_m == 0) return;
  for (const std::uint32_t other : part.neighbours()[facet])
    if (other != kNoFacet && n.dot(part.normal(other)) > std::cos(kCurved_rad))
      to.push_back({part.normal(other), chord_m});
}

/// How far an edge between two faces can move along n if each face moves by its chord error.
double shiftOfEdge(const Leaning& one, const Leaning& two, const Vec3& n) {
  const double cosine = one.n.dot(two.n), sine2 = 1 - cosine * cosine;
  const double along_one = n.dot(one.n), along_two = n.dot(two.n);
  // An edge within one curved face or one plane moves with the face.
  if (cosine > std::cos(kCurved_rad))
    return std::max(one.chord_m, two.chord_m) * std::max(std::abs(along_one), std::abs(along_two));
  constexpr double kKnife = 1e-3;  // nearly opposite faces form a blade, whose edge may be anywhere
  if (sine2 < kKnife) return one.chord_m + two.chord_m > 0 ? std::numeric_limits<double>::infinity() : 0;
  return (std::abs(along_one - cosine * along_two) * one.chord_m +
          std::abs(along_two - cosine * along_one) * two.chord_m) /
         sine2;
}

/// The chord error of the surface at the point of it that is nearest to p.
double chordAt(const PartSurface& part, const Solid::Closest& nearest, const Vec3& p) {
  const Triangle t = part.triangle(nearest.triangle);
  double chord_m = part.chordBound_m(nearest.triangle);
  if (closestOnTriangle(p, t[0], t[1], t[2]).feature != 0)
    for (const std::uint32_t other : part.neighbours()[nearest.triangle])
      if (other != kNoFacet) chord_m = std::max(chord_m, part.chordBound_m(other));
  return chord_m;
}

class EdgeSearch {
 public:
  EdgeSearch(const PlacedSurface& in, const PlacedSurface& of)
      : in_(*in.surface), of_(*of.surface), X_WI_(in.X_WP), X_IO_(in.X_WP.inverse() * of.X_WP) {}

  void run(CertainOverlap& best) {
    const std::vector<std::array<std::uint32_t, 2>>& edges = of_.overlap().edges();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Vec3 a = X_IO_ * of_.mesh().vertices[edges[i][0]], b = X_IO_ * of_.mesh().vertices[edges[i][1]];
      Box box;
      box.add(a);
      box.add(b);
      if (distance2(box, in_.box()) > 0) continue;
      pollStop();
      searchPieces(i, a, b, best);
    }
  }

 private:
  void searchPieces(std::size_t edge, const Vec3& a, const Vec3& b, CertainOverlap& best) {
    crossings_.clear();
    in_.overlap().solid().appendCrossings(a, b, crossings_);
    std::sort(crossings_.begin(), crossings_.end());
    crossings_.push_back(1);
    double from = 0;
    for (const double to : crossings_) {
      if (to > from && in_.solid().isInside(a + 0.5 * (from + to) * (b - a)))
        for (const double share : {0.0, 1.0 / 3, 0.5, 2.0 / 3, 1.0})
          take(edge, a + (from + share * (to - from)) * (b - a), best);
      from = to;
    }
  }

  void take(std::size_t edge, const Vec3& p_I, CertainOverlap& best) {
    const Solid::Closest nearest = in_.solid().closest(p_I);
    const double depth_m = nearest.distance_m;
    if (depth_m - best.depth_m + best.error_m <= 0 || nearest.normal.dot(p_I - nearest.q) > 0) return;
    const double error_m = shiftAt(edge, nearest.normal) + chordAt(in_, nearest, p_I);
    if (depth_m - error_m > std::max(best.depth_m - best.error_m, 0.0))
      best = {depth_m, error_m, X_WI_ * p_I};
  }

  double shiftAt(std::size_t edge, const Vec3& n_I) {
    const Vec3 n_O = X_IO_.R.transpose() * n_I;
    const auto& [first, last] = of_.overlap().trianglesAtEdges()[edge];
    one_.clear();
    two_.clear();
    addLeanings(of_, first, one_);
    addLeanings(of_, last, two_);
    double most_m = 0;
    for (const Leaning& one : one_)
      for (const Leaning& two : two_) most_m = std::max(most_m, shiftOfEdge(one, two, n_O));
    return most_m;
  }

  const PartSurface &in_, &of_;
  Pose X_WI_, X_IO_;
  std::vector<double> crossings_;
  std::vector<Leaning> one_, two_;
};

}  // namespace

CertainOverlap certainOverlap(const PlacedSurface& a, const PlacedSurface& b) {
  CertainOverlap best;
  EdgeSearch(a, b).run(best);
  EdgeSearch(b, a).run(best);
  return best;
}

}  // namespace vps::scenes

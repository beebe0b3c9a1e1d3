// SPDX-License-Identifier: BSD-3-Clause
#include "ways/resting.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fits/fits.h"

namespace vps::scenes {

namespace {

using Wrench6 = Eigen::Matrix<double, 6, 1>;

/// A contact point of a part, and the unit direction of the contact force on it; in the world.
struct Support {
  Vec3 p_W, n_W;
};

/// Appends the points at which the surface of one part lies on another part, out of the vertices and edges of
/// its triangles.
/// @param side  sign of the force direction: 1 if `of` is the supported part, -1 if `other` is
void addSupports(const PlacedSurface& of, const PlacedSurface& other, double within_m, double side,
                 std::vector<Support>& out) {
  constexpr int kAlongEdge = 8;
  constexpr double kClear = 0.95;  // gradients are unit vectors at a face, shorter at an edge
  const Box near_W = grown(other.box_W, within_m);
  const Solid& solid = other.surface->solid();
  const Pose X_OW = other.X_WP.inverse();
  const double h_m = 4 * within_m;
  const auto add = [&](const Vec3& p_W) {
    if (!isWithin(p_W, near_W)) return;
    const Vec3 p = X_OW * p_W;
    if (std::abs(solid.signedDistance(p, h_m)) > within_m) return;  // beyond h_m the distance has no sign
    Vec3 n;
    for (int k = 0; k < 3; ++k)
      n[k] = (solid.signedDistance(p + h_m * Vec3::Unit(k)) - solid.signedDistance(p - h_m * Vec3::Unit(k))) /
             (2 * h_m);
    if (n.norm() > kClear) out.push_back({p_W, side * (other.X_WP.R * n.normalized())});
  };
  const auto count = static_cast<std::uint32_t>(of.surface->mesh().triangles.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const Triangle t = of.surface->triangle(i);
    Box box_W;
    for (const Vec3& p : t) box_W.add(of.X_WP * p);
    if (((box_W.max - near_W.min).array() < 0).any() || ((near_W.max - box_W.min).array() < 0).any())
      continue;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < kAlongEdge; ++j)
        add(of.X_WP * Vec3(t[k] + j / static_cast<double>(kAlongEdge) * (t[(k + 1) % 3] - t[k])));
  }
}

/// Whether contact forces at the points of support can balance a weight at the centre, by non-negative least
/// squares (coordinate descent).
bool canCarry(const std::vector<Support>& supports, const Vec3& center_W, const Vec3& up_W, double size_m) {
  constexpr int kSweeps = 300;
  constexpr double kBalanced = 0.03;  // residual, as a share of the weight, at a lever of the part's size
  std::vector<Wrench6> pushes;
  for (const Support& at : supports) {
    Wrench6 push;
    push << at.n_W, (at.p_W - center_W).cross(at.n_W) / size_m;
    pushes.push_back(push);
  }
  Wrench6 left;
  left << up_W, Vec3::Zero();
  std::vector<double> shares(pushes.size(), 0);
  for (int sweep = 0; sweep < kSweeps && left.norm() > kBalanced; ++sweep)
    for (std::size_t i = 0; i < pushes.size(); ++i) {
      const double share = std::max(0.0, shares[i] + pushes[i].dot(left) / pushes[i].squaredNorm());
      left -= (share - shares[i]) * pushes[i];
      shares[i] = share;
    }
  return left.norm() <= kBalanced;
}

}  // namespace

bool tipsOver(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held) {
  constexpr double kFall_m = 1e-3, kTouch_m = 10e-6;
  constexpr std::uint64_t kMostWork = 2'000'000;
  constexpr std::size_t kMostSupports = 2000;
  const Vec3& up_W = motions.directions()[motions.up()];
  const auto isHeld = [&](std::size_t one) { return std::ranges::find(held, one) != held.end(); };
  std::vector<std::size_t> near;
  for (const std::size_t one : held)
    if (motions.areNear(one, part)) near.push_back(one);
  if (std::ranges::none_of(motions.carriersOf(part), isHeld)) return false;
  SearchWork work{kMostWork};
  const PlacedSurface& drawn = motions.parts()[part];
  const Reach sunk = motions.search(drawn, part, near).reach({-up_W, Vec3::Zero(), false}, kFall_m, &work);
  const PlacedSurface placed = displaced(drawn, Pose::translation(-sunk.s * up_W));
  std::vector<Support> supports;
  for (const std::size_t one : near) {
    const PlacedSurface& other = motions.parts()[one];
    const double within_m = kTouch_m + drawn.surface->chordIn(drawn.surface->box()) +
                            other.surface->chordIn(other.surface->box());
    addSupports(placed, other, within_m, 1, supports);
    addSupports(other, placed, within_m, -1, supports);
  }
  // Without support points, or with too many to test, the part counts as carried.
  if (supports.empty() || supports.size() > kMostSupports) return false;
  const Vec3 center_W = placed.X_WP * placed.surface->solid().mass().com;
  return !canCarry(supports, center_W, up_W, placed.box_W.size().norm());
}

bool sinksFromItsPlace(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held) {
  constexpr double kFall_m = 1e-3;
  constexpr std::uint64_t kMostWork = 2'000'000;
  std::vector<std::size_t> near;
  for (const std::size_t one : held)
    if (motions.areNear(one, part)) near.push_back(one);
  double allowed_m = kSightTolerance_m;
  for (const CheckedFit& fit : motions.fitsOf(part))
    if (std::ranges::any_of(near, [&](std::size_t one) {
          const std::string& name = motions.parts()[one].name;
          return fit.shaft == name || fit.bore == name;
        }))
      allowed_m = std::min(allowed_m, fitTolerance_m(fit.diametral_clearance_m));
  const Vec3& up_W = motions.directions()[motions.up()];
  const auto chord_m = [](const PlacedSurface& of) { return of.surface->chordIn(of.surface->box()); };
  double others_m = 0;
  for (const std::size_t one : near) others_m = std::max(others_m, chord_m(motions.parts()[one]));
  allowed_m += chord_m(motions.parts()[part]) + others_m;
  SearchWork work{kMostWork};
  const Reach sunk =
      motions.search(motions.parts()[part], part, near).reach({-up_W, Vec3::Zero(), false}, kFall_m, &work);
  return !sunk.is_given_up && sunk.s > allowed_m;
}

bool leansInHole(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held) {
  constexpr double kLevel = 0.5,
                   kParallel =
                       0.999;  // absolute cosines: axes less than 30 degrees from level, and equal axes
  const PlacedSurface& placed = motions.parts()[part];
  const Vec3& up_W = motions.directions()[motions.up()];
  const auto isHeld = [&](const std::string& name) {
    return std::ranges::any_of(held, [&](std::size_t h) { return motions.parts()[h].name == name; });
  };
  std::vector<std::string> holes;
  double from_m = std::numeric_limits<double>::infinity(), to_m = -from_m;
  Vec3 axis_W = Vec3::Zero();
  for (const CheckedFit& fit : motions.fitsOf(part)) {
    if (fit.kind == FitKind::Key || fit.shaft != placed.name || !isHeld(fit.bore)) continue;
    if (std::abs(fit.axis_W.dot(up_W)) > kLevel) return false;
    if (axis_W.isZero()) axis_W = fit.axis_W;
    if (std::abs(fit.axis_W.dot(axis_W)) < kParallel) return false;
    const double middle_m = axis_W.dot(fit.at_W);
    from_m = std::min(from_m, middle_m - 0.5 * fit.length_m);
    to_m = std::max(to_m, middle_m + 0.5 * fit.length_m);
    holes.push_back(fit.bore);
  }
  const bool has_other = std::ranges::any_of(motions.carriersOf(part), [&](std::size_t carrier) {
    const std::string& name = motions.parts()[carrier].name;
    return isHeld(name) && std::ranges::find(holes, name) == holes.end();
  });
  if (holes.empty() || has_other) return false;
  const double center_m = axis_W.dot(placed.X_WP * placed.surface->solid().mass().com);
  return center_m < from_m || center_m > to_m;
}

namespace {

Motion along(const Vec3& d_W) {
  return {d_W, Vec3::Zero(), false};
}

/// Distance by which a part, displaced by `aside_m`, can move in both directions along an axis: the smaller
/// of the two distances, at most kSightTolerance_m.
double toBothSides_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                     const Vec3& aside_m, const Vec3& axis_W) {
  const PlacedSurface placed = displaced(motions.parts()[part], Pose::translation(aside_m));
  const MotionSearch search = motions.search(placed, part, held);
  const double there_m = search.reach(along(axis_W), kSightTolerance_m).s;
  return std::min(there_m, search.reach(along(-axis_W), there_m).s);
}

/// The place along `play_m` with most room in all four directions; between leaning walls, the room across
/// `play_m` narrows.
Vec3 roomiest_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                const Vec3& play_m, const Vec3& across_W) {
  constexpr int kPlaces = 16;
  Vec3 best_m = 0.5 * play_m;
  double most_m = 0;
  for (int i = kPlaces / 2; i > 1; --i) {
    const Vec3 aside_m = static_cast<double>(i) / kPlaces * play_m;
    const double room_m = std::min(aside_m.norm(), toBothSides_m(motions, part, held, aside_m, across_W));
    if (room_m <= most_m) continue;
    most_m = room_m;
    best_m = aside_m;
  }
  return best_m;
}

}  // namespace

Vec3 toMostRoom_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                  const Vec3& out_W) {
  constexpr double kAcross = 1e-6;
  constexpr double kRests_m = 10e-6;      // within this distance, the part counts as touching the side
  constexpr double kLeastPlay_m = 40e-6;  // assumed: less play does not help a hand that sees to 0.1 mm
  const PlacedSurface& home = motions.parts()[part];
  const MotionSearch search = motions.search(home, part, held);
  for (const std::size_t axis : motions.axesOf(part)) {
    const Vec3& d_W = motions.directions()[axis];
    if (std::abs(d_W.dot(out_W)) > kAcross) continue;
    const Reach play = search.reach(along(d_W), kSightTolerance_m);
    if (!play.is_stopped || play.s < kLeastPlay_m) continue;
    const Reach behind = search.reach(along(-d_W), kLeastPlay_m);
    if (!behind.is_stopped || behind.s > kRests_m) continue;
    const Vec3 aside_m = roomiest_m(motions, part, held, play.s * d_W, out_W.cross(d_W));
    const PlacedSurface placed = displaced(home, Pose::translation(aside_m));
    if (!motions.search(placed, part, held).reach(along(out_W), motions.leave_m()).is_stopped) return aside_m;
  }
  return Vec3::Zero();
}

}  // namespace vps::scenes

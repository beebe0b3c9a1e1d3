// SPDX-License-Identifier: BSD-3-Clause
#include "overlaps/room_beside.h"

#include <algorithm>
#include <cmath>

#include "fits/fits.h"

namespace vps::scenes {

namespace {

Motion along(const Vec3& d_W) {
  return {d_W, Vec3::Zero(), false};
}

/// Distance by which a part, displaced by `aside_m`, can move in both directions along an axis: the smaller
/// one, at most kSightTolerance_m.
double toBothSides_m(const PairMotions& motions, std::size_t part, const std::vector<std::size_t>& held,
                     const Vec3& aside_m, const Vec3& axis_W) {
  const PlacedSurface placed = displaced(motions.parts()[part], Pose::translation(aside_m));
  const MotionSearch search = motions.search(placed, part, held);
  const double there_m = search.reach(along(axis_W), kSightTolerance_m).s;
  return std::min(there_m, search.reach(along(-axis_W), there_m).s);
}

/// The place along `play_m` with most room in all four directions; between leaning walls the room across
/// narrows.
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
  constexpr double kLeastPlay_m = 40e-6;  // assumed: less does not help a hand that sees to 0.1 mm
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

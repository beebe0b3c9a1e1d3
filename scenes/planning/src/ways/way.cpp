// SPDX-License-Identifier: BSD-3-Clause
#include "ways/way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "motion/play.h"

namespace vps::scenes {

std::vector<Pose> cornersOf(const Way& way) {
  std::vector<Pose> corners{Pose()};
  for (std::size_t i = 0; i + 1 < way.legs.size(); ++i)
    corners.push_back(way.legs[i].motion.at(way.legs[i].s) * corners.back());
  return corners;
}

double leavingDistance_m(const Box& moving, const Box& held, const Vec3& d) {
  constexpr double kAcross = 1e-9;  // rounding of a direction along an axis
  double apart_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double ahead_m = held.max[axis] - moving.min[axis], behind_m = moving.max[axis] - held.min[axis];
    if (std::abs(d[axis]) < kAcross) {
      if (ahead_m < 0 || behind_m < 0) return 0;
      continue;
    }
    apart_m = std::min(apart_m, std::max(0.0, d[axis] > 0 ? ahead_m : behind_m) / std::abs(d[axis]));
  }
  return apart_m;
}

bool stopsWay(const PairMotions& motions, std::size_t held, std::size_t part, const Way& way) {
  if (way.kind == WayKind::Straight) return motions.stops(held, part, way.direction);
  const std::vector<Pose> corners = cornersOf(way);
  for (std::size_t i = 0; i < way.legs.size(); ++i) {
    const PlacedSurface placed = displaced(motions.parts()[part], corners[i]);
    const Leg& leg = way.legs[i];
    if (motions.search(placed, part, {held}).reach(leg.motion, leg.s).is_stopped) return true;
  }
  return false;
}

std::optional<Way> screwWay(const PairMotions& motions, std::size_t part,
                            const std::vector<std::size_t>& held) {
  const PlacedSurface& screw = motions.parts()[part];
  for (const CheckedFit& fit : motions.fitsOf(part)) {
    if (fit.kind != FitKind::Thread) continue;
    const std::string& mate = fit.shaft == screw.name ? fit.bore : fit.shaft;
    const auto at = std::ranges::find(held, mate, [&](std::size_t h) { return motions.parts()[h].name; });
    if (at == held.end()) continue;
    // Beyond its mate, the screw leaves straight.
    const auto along_m = [&](const Box& box) { return fit.axis_W.cwiseAbs().dot(box.size()); };
    const double out_m = along_m(screw.box_W) + along_m(motions.parts()[*at].box_W);
    const MotionSearch search = motions.search(screw, part, held);
    for (const ScrewWay& found : screwWaysOut(search, screw, {fit}, out_m)) {
      const double sign = (found.lead_m > 0 ? 1 : -1) * (found.axis_W.dot(fit.axis_W) > 0 ? 1 : -1);
      const double forward_m = found.lead_m / (2 * std::numbers::pi);
      Way way{WayKind::Screw, {}, kNoDirection, found.lead_m};
      way.legs.push_back({{sign * fit.axis_W, found.at_W, true, forward_m}, out_m / std::abs(forward_m)});
      way.legs.push_back({{found.axis_W, Vec3::Zero(), false}, motions.leave_m()});
      const PlacedSurface above = displaced(screw, cornersOf(way).back());
      if (motions.search(above, part, held).reach(way.legs.back().motion, motions.leave_m()).is_stopped)
        continue;
      return way;
    }
  }
  return std::nullopt;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Involute gears, outer and inner, that mesh with each other.
//
// An inner gear is a plate from which the outline of an outer gear is cut. One outline therefore serves both;
// only the tip and root circles are exchanged.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "support/swept.h"

namespace vps::test {

struct GearShape {
  double module_m = 1e-3;  ///< pitch diameter for each tooth
  int teeth = 30;
  double width_m = 10e-3;
  double backlash_m = 0;         ///< subtracted from the tooth's thickness along the pitch circle
  double other_radius_m = 5e-3;  ///< bore of an outer gear, outer radius of an inner gear
  int points_per_tooth = 48;     ///< points of the outline per tooth; a multiple of 8
  int axial_steps = 16;
  int radial_steps = 8;  ///< steps from the teeth to the other circle, on the two faces
};

inline double pitchRadius(const GearShape& gear) {
  return gear.module_m * gear.teeth / 2;
}

/// A point of the outline in polar coordinates.
struct OutlinePoint {
  double r_m = 0, angle_rad = 0;
};

/// The outline of an outer gear, counter-clockwise, tooth 0 centred on angle 0: each flank has three eighths
/// of a tooth's points (evenly spaced in radius), tip and root have one eighth each. The angle grows from
/// point to point, so that rays from the axis cut the outline once.
inline std::vector<OutlinePoint> gearOutline(const GearShape& gear, double root_m, double tip_m) {
  constexpr double kPressure_rad = 20 * std::numbers::pi / 180;
  /// Below the base circle there is no involute. Below the base circle the flank is nearly radial, with an
  /// angle that still grows.
  constexpr double kBelowBase_rad_per_m = 0.05;
  const double pitch_m = pitchRadius(gear), base_m = pitch_m * std::cos(kPressure_rad);
  const auto involute = [](double angle_rad) { return std::tan(angle_rad) - angle_rad; };
  const double half_at_pitch_rad = (std::numbers::pi * gear.module_m / 2 - gear.backlash_m) / (2 * pitch_m);
  const auto halfTooth = [&](double r_m) {
    const double by_involute_rad = r_m > base_m ? involute(std::acos(base_m / r_m)) : 0;
    const double below_m = std::max(0.0, base_m - r_m);
    return half_at_pitch_rad + involute(kPressure_rad) - by_involute_rad +
           kBelowBase_rad_per_m * below_m / pitch_m;
  };
  const int eighth = gear.points_per_tooth / 8, flank = 3 * eighth;
  const double root_gap_rad = kTurn_rad / gear.teeth - 2 * halfTooth(root_m);
  std::vector<OutlinePoint> outline;
  for (int tooth = 0; tooth < gear.teeth; ++tooth) {
    const double at_rad = kTurn_rad * tooth / gear.teeth;
    for (int k = 0; k < flank; ++k) {  // rising flank: the tooth becomes thinner and the angle grows
      const double r_m = root_m + (tip_m - root_m) * k / flank;
      outline.push_back({r_m, at_rad - halfTooth(r_m)});
    }
    for (int k = 0; k < eighth; ++k)
      outline.push_back({tip_m, at_rad + halfTooth(tip_m) * (2.0 * k / eighth - 1)});
    for (int k = 0; k < flank; ++k) {
      const double r_m = tip_m + (root_m - tip_m) * k / flank;
      outline.push_back({r_m, at_rad + halfTooth(r_m)});
    }
    for (int k = 0; k < eighth; ++k)
      outline.push_back({root_m, at_rad + halfTooth(root_m) + root_gap_rad * k / eighth});
  }
  return outline;
}

/// The section of a ring between an inner and an outer point.
inline std::vector<Vec3> ringSection(const Vec3& inner, const Vec3& outer, double half_width_m,
                                     int axial_steps, int radial_steps) {
  const Vec3 up(0, 0, half_width_m);
  std::vector<Vec3> loop;
  appendLine(loop, outer - up, outer + up, axial_steps);
  appendLine(loop, outer + up, inner + up, radial_steps);
  appendLine(loop, inner + up, inner - up, axial_steps);
  appendLine(loop, inner - up, outer - up, radial_steps);
  return loop;
}

/// A spur gear around z, centred at the origin, with a bore of other_radius_m. The mesh is closed, faces
/// outwards, and has teeth x points_per_tooth x 4 (axial_steps + radial_steps) triangles.
inline Mesh makeSpurGear(const GearShape& gear) {
  const double pitch_m = pitchRadius(gear);
  const auto outline = gearOutline(gear, pitch_m - 1.25 * gear.module_m, pitch_m + gear.module_m);
  const int columns = static_cast<int>(outline.size());
  return sweptSections(columns, [&](int i) {
    const auto& [r_m, angle_rad] = outline[static_cast<std::size_t>(i % columns)];
    return ringSection(polar(gear.other_radius_m, angle_rad, 0), polar(r_m, angle_rad, 0), gear.width_m / 2,
                       gear.axial_steps, gear.radial_steps);
  });
}

/// A ring with teeth inside; its tooth space 0 is centred on angle 0. The mesh has as many triangles as a
/// gear of makeSpurGear().
inline Mesh makeRingGear(const GearShape& gear) {
  const double pitch_m = pitchRadius(gear);
  GearShape space = gear;
  space.backlash_m = -gear.backlash_m;  // a tooth space becomes wider by as much as a tooth becomes thinner
  const auto outline = gearOutline(space, pitch_m - gear.module_m, pitch_m + 1.25 * gear.module_m);
  const int columns = static_cast<int>(outline.size());
  return sweptSections(columns, [&](int i) {
    const auto& [r_m, angle_rad] = outline[static_cast<std::size_t>(i % columns)];
    return ringSection(polar(r_m, angle_rad, 0), polar(gear.other_radius_m, angle_rad, 0), gear.width_m / 2,
                       gear.axial_steps, gear.radial_steps);
  });
}

}  // namespace vps::test

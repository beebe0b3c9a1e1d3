// SPDX-License-Identifier: BSD-3-Clause
// Assemblies of a part and a base that the part leaves only by a tilt, by the use of its play, by several
// legs or by a screw motion, or cannot leave at all.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/assemblies_to_plan.h"
#include "support/gear.h"
#include "support/units.h"

namespace vps::scenes {

/// A cover with one end under a lip, and a wall at its other end that is as high as the cover's room. Nothing
/// lets it leave straight: it has to tilt over the wall first.
/// @param room_m  height of the room under the lip; the cover is 3 mm thick
inline std::vector<DrawnPart> coverUnderLip(double room_m) {
  const double half_m = 10 * kMm, lip_m = 2 * kMm;
  Mesh base = block({-34 * kMm, -half_m, -5 * kMm}, {34 * kMm, half_m, 0});
  append(base, block({-34 * kMm, -half_m, 0}, {-30 * kMm, half_m, room_m + lip_m}));
  append(base, block({-30 * kMm, -half_m, room_m}, {-26 * kMm, half_m, room_m + lip_m}));
  append(base, block({30 * kMm, -half_m, 0}, {34 * kMm, half_m, room_m}));
  for (const double side : {-1.0, 1.0})
    append(base, block({-34 * kMm, side > 0 ? half_m : -half_m - 4 * kMm, -5 * kMm},
                       {34 * kMm, side > 0 ? half_m + 4 * kMm : -half_m, room_m + lip_m}));
  return {at("base", base, {0, 0, 0}),
          at("cover", block({-29.8 * kMm, -9.9 * kMm, 0.05 * kMm}, {29.8 * kMm, 9.9 * kMm, 3.05 * kMm}),
             {0, 0, 0})};
}

/// A slide in a channel that is open at +x, before a nub on the floor.
inline std::vector<DrawnPart> slideBeforeNub(double play_m, double nub_m) {
  const double half_m = 5 * kMm, roof_m = 3 * kMm + play_m;
  Mesh base = block({-24 * kMm, -9 * kMm, -4 * kMm}, {20 * kMm, 9 * kMm, 0});
  append(base, block({-24 * kMm, -9 * kMm, roof_m}, {20 * kMm, 9 * kMm, roof_m + 4 * kMm}));
  append(base, block({-24 * kMm, -9 * kMm, 0}, {-20 * kMm, 9 * kMm, roof_m}));
  for (const double side : {-1.0, 1.0})
    append(base, block({-20 * kMm, side > 0 ? half_m : -9 * kMm, 0},
                       {20 * kMm, side > 0 ? 9 * kMm : -half_m, roof_m}));
  append(base, block({10 * kMm, -half_m, 0}, {11 * kMm, half_m, nub_m}));
  return {at("base", base, {0, 0, 0}),
          at("slide", block({-10 * kMm, -half_m + 20 * kUm, 5 * kUm}, {9 * kMm, half_m - 20 * kUm, 3 * kMm}),
             {0, 0, 0})};
}

/// The gear, twisted around z to a helix.
inline Mesh helical(Mesh gear, double helix_rad, double pitch_m) {
  for (Vec3& v : gear.vertices) v = rotationFromVector({0, 0, v.z() * std::tan(helix_rad) / pitch_m}) * v;
  return gear;
}

inline test::GearShape helicalShape() {
  return {.module_m = 2 * kMm,
          .teeth = 16,
          .width_m = 20 * kMm,
          .backlash_m = 0.2 * kMm,
          .other_radius_m = 5 * kMm,
          .points_per_tooth = 16,
          .axial_steps = 10,
          .radial_steps = 2};
}

/// A helical gear on a pin of the base, in mesh with a gear that is part of the base.
inline std::vector<DrawnPart> helicalPair(double helix_rad, const test::GearShape& shape = helicalShape()) {
  const double pitch_m = test::pitchRadius(shape);
  const Mesh gear = helical(test::makeSpurGear(shape), helix_rad, pitch_m);
  const Pose half_tooth(rotationFromVector({0, 0, std::numbers::pi / shape.teeth}),
                        Vec3(2 * pitch_m + 0.1 * kMm, 0, 0));
  Mesh base = transformed(helical(test::makeSpurGear(shape), -helix_rad, pitch_m), half_tooth);
  append(base, makeCylinder(4.95 * kMm, 24 * kMm, 64));
  return {at("base", base, {0, 0, 0}), at("gear", gear, {0, 0, 0})};
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Sizes of the timed parts, for their meshes and their motions.
#pragma once

#include "support/fit.h"
#include "support/gear.h"
#include "support/screw.h"

namespace vps::bench {

/// Radial clearance of the peg in its bore.
inline constexpr double kPegClearance_m = 10e-6;
/// Backlash of each wheel along the pitch circle.
inline constexpr double kBacklash_m = 20e-6;
/// Radial clearance of the rod in its nut.
inline constexpr double kThreadClearance_m = 50e-6;
inline constexpr double kNutCorner_m = 12e-3;

/// Number of steps of a mesh, divided by `coarser` and still a multiple of `multiple`.
inline int coarsened(int steps, int coarser, int multiple) {
  const int fewer = steps / coarser / multiple * multiple;
  return fewer > multiple ? fewer : multiple;
}

inline test::PegShape pegShape(int coarser) {
  return {.radius_m = 5e-3, .length_m = 40e-3, .columns = coarsened(1024, coarser, 4)};
}
inline test::PlateShape plateShape(int coarser) {
  return {.bore_m = 5e-3 + kPegClearance_m, .columns = coarsened(1024, coarser, 4)};
}
inline test::GearShape ringShape(int coarser) {
  return {.teeth = 72,
          .backlash_m = kBacklash_m,
          .other_radius_m = 42e-3,
          .points_per_tooth = coarsened(32, coarser, 8),
          .axial_steps = coarsened(12, coarser, 2),
          .radial_steps = coarsened(10, coarser, 2)};
}
inline test::GearShape planetShape(int coarser) {
  return {.teeth = 30,
          .backlash_m = kBacklash_m,
          .other_radius_m = 5e-3,
          .points_per_tooth = coarsened(64, coarser, 8),
          .axial_steps = coarsened(14, coarser, 2),
          .radial_steps = coarsened(12, coarser, 2)};
}
inline test::ThreadShape rodThread(int coarser) {
  return {.columns = coarsened(240, coarser, 6), .rows_per_pitch = coarsened(32, coarser, 16)};
}
inline test::ThreadShape nutThread(int coarser) {
  test::ThreadShape thread = rodThread(coarser);
  thread.clearance_m = kThreadClearance_m;
  return thread;
}

}  // namespace vps::bench

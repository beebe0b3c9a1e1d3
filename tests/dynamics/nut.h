// SPDX-License-Identifier: BSD-3-Clause
// A nut on a vertical threaded rod: gravity turns it downwards, friction locks it.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct NutSize {
  double major_m = 10e-3;  ///< the rod's diameter over its crests
  double pitch_m = 1.5e-3;
  double height_m = 8e-3;
  double corner_m = 18.5e-3 / 2;  ///< from the axis to the hexagon's corners
};
inline constexpr NutSize kM10{10e-3, 1.5e-3, 8e-3, 18.5e-3 / 2};
inline constexpr NutSize kM16{16e-3, 2e-3, 13e-3, 27.7e-3 / 2};

/// @param columns  facets a turn, a multiple of 6
const PartMesh& nutPart(const NutSize& size, int columns = 384);
const PartMesh& rodPart(const NutSize& size, int columns = 384);

struct NutRunResult {
  double acceleration_m_s2 = 0;  ///< measured along the axis, over the first turn
  double theory_m_s2 = 0;        ///< g / (1 + I / (m r^2)), r = pitch / 2 pi, I of the mesh
  double advance_m = 0;          ///< in one turn
  double tilt_rad = 0;           ///< greatest angle between the axes of nut and rod
  double turns = 0;              ///< in the time simulated
  double deepest_m = 0;          ///< greatest penetration, measured every 50 ms
  double step_ms = 0;            ///< mean
  std::uint64_t hash = 0;        ///< of all states of the run
};

/// Without friction, under gravity, until it has turned once.
NutRunResult runNut(const SceneSettings& settings, const NutSize& size);

/// Without friction, spun downwards after it has come to lie on its thread.
struct NutSpinResult {
  double end_rad_s = 0, theory_rad_s = 0;  ///< about the axis, after `steps`
};
NutSpinResult spinNut(const SceneSettings& settings, const NutSize& size, double rad_s, int steps);

/// tan(lead angle at the pitch diameter) cos(30 degrees).
double selfLockTheory(const NutSize& size);

/// Rotation [rad] of a nut with this friction in duration_s after it was placed on the rod, without the first
/// 0.2 s.
double turnWithFriction_rad(const SceneSettings& settings, const NutSize& size, double mu, double duration_s);

/// The friction that just holds the nut, by bisection to `resolution`.
double selfLockFriction(const SceneSettings& settings, const NutSize& size, double resolution = 1e-3);

}  // namespace vps::dynamics

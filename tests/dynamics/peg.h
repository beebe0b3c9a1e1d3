// SPDX-License-Identifier: BSD-3-Clause
// A 10 x 30 mm steel peg and a blind bore 15 mm deep, with tens of micrometres of clearance.
#pragma once

#include "world.h"

namespace vps::dynamics {

inline constexpr double kBoreDepth_m = 15e-3, kPegLength_m = 30e-3, kPegRadius_m = 5e-3;

/// Around z, with its chamfered lower end at z = 0.
const PartMesh& pegPart();
/// A block around z with a chamfered mouth at z = 0. @param clearance_m  diameter of the bore minus that of
/// the peg
const PartMesh& borePart(double clearance_m);

struct PegDrop {
  double clearance_m = 50e-6;
  double offset_m = 0.2e-3;  ///< of the peg's lower end from the bore's axis
  double tilt_rad = 8.7e-3;  ///< half a degree
  double height_m = 1e-3;    ///< of its lower end above the mouth
  double friction = 0.15;
};

struct PegDropResult {
  double height_error_m = 0;  ///< of the lower end above the seat, at the end
  double deepest_m = 0;       ///< greatest penetration during fall and rest
  double jitter_m_s = 0;      ///< greatest speed of any point in the last second or seconds
  double drift_m = 0;         ///< in the same time
  double step_ms = 0;         ///< mean over the steps with contact
  double seated_s = 0;        ///< when it came within 10 um of its seat; -1: never
  [[nodiscard]] bool isSeated() const { return seated_s >= 0; }
};

/// Drops the peg off-centre and tilted; it falls into the bore and comes to rest.
PegDropResult dropPeg(const SceneSettings& settings, const PegDrop& drop = {});

struct LongRestResult {
  double drift_m = 0;  ///< greatest distance from where it came to rest
  double rest_s = 0;   ///< duration of the observation
  double step_ms = 0;
};

/// The seated peg at rest for ten minutes (short: ten seconds).
LongRestResult restPeg(const SceneSettings& settings);

}  // namespace vps::dynamics

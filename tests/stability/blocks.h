// SPDX-License-Identifier: BSD-3-Clause
// Steel blocks and plates with coarse models, for most rows.
#pragma once

#include "dynamics/world.h"

namespace vps::stability {

using dynamics::makePart;
using dynamics::PartMesh;
using dynamics::World;

inline constexpr double kGravity_m_s2 = World::kGravity_m_s2;
inline constexpr double kVoxel_m = 0.5e-3;
inline constexpr double kPlate_m = 60e-3;  ///< side of a plate
inline constexpr double kThick_m = 10e-3;  ///< of a plate
inline const dynamics::Resolution kCoarse{kVoxel_m, 1e-3};
inline const Vec3 kBlock_m(20e-3, 15e-3, 10e-3);

inline PartMesh block() {
  return makePart(makeBox(kBlock_m));
}

inline PartMesh plate(double side_m = kPlate_m) {
  return makePart(makeBox(Vec3(side_m, side_m, kThick_m)));
}

}  // namespace vps::stability

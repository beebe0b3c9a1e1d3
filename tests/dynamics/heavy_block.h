// SPDX-License-Identifier: BSD-3-Clause
// A block a thousand times as heavy as the peg on which it stands or falls.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct HeavyBlock {
  double ratio = 1000;     ///< block's mass over the peg's
  double speed_m_s = 0;    ///< 0: placed on the seated peg; otherwise the speed at which it arrives
  double offset_m = 1e-3;  ///< of the block's centre from the peg's axis
};

struct HeavyBlockResult {
  double deepest_m = 0;        ///< greatest penetration, of peg in bore and of block in peg
  double final_m = 0;          ///< the same at the end
  double energy_gained_J = 0;  ///< greatest increase of kinetic plus potential energy since the start
  double kinetic_J = 0;        ///< greatest kinetic energy in the last half second
  double peg_height_m = 0;     ///< of the peg over its seat at the end
  double block_height_m = 0;   ///< of the block over its right place on the peg's top at the end
  double speed_m_s = 0;        ///< greatest of any point in the last half second
  double step_ms = 0;
};

HeavyBlockResult loadPeg(const SceneSettings& settings, const HeavyBlock& load);

}  // namespace vps::dynamics

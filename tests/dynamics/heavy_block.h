// SPDX-License-Identifier: BSD-3-Clause
// A block a thousand times as heavy as the peg that it stands on, or falls on.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct HeavyBlock {
  double ratio = 1000;     ///< block's mass over the peg's
  double speed_m_s = 0;    ///< 0: put down on the seated peg; else it arrives at this speed
  double offset_m = 1e-3;  ///< of the block's centre from the peg's axis
};

struct HeavyBlockResult {
  double deepest_m = 0;        ///< worst penetration, of peg in bore and of block in peg
  double final_m = 0;          ///< the same at the end
  double energy_gained_J = 0;  ///< greatest rise of kinetic plus height energy over the start's
  double kinetic_J = 0;        ///< greatest kinetic energy in the last half second
  double peg_height_m = 0;     ///< of the peg over its seat at the end
  double block_height_m = 0;   ///< of the block over the peg's top at the end, where it belongs
  double speed_m_s = 0;        ///< greatest of any point in the last half second
  double step_ms = 0;
};

HeavyBlockResult loadPeg(const SceneSettings& settings, const HeavyBlock& load);

}  // namespace vps::dynamics

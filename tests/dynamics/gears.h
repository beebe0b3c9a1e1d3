// SPDX-License-Identifier: BSD-3-Clause
// Two involute gears of module 2 on hinges, 20 teeth driving 30 against a brake.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct GearPairResult {
  double turns = 0;  ///< of the driver
  double ratio_error_rad =
      0;  ///< greatest deviation of the driven gear from 20/30 of the driver, since the start
  double ratio_drift_rad = 0;  ///< between the means of the first and the last turn: skipped teeth or creep
  double torque_share = 0;     ///< mean brake torque over mean drive torque times 30/20; 1 without loss
  double deepest_m = 0;        ///< greatest penetration, measured every 50 ms
  double step_ms = 0;          ///< mean
};

/// The driver turns at 1 turn/s for 10 turns (short: half a turn).
GearPairResult runGears(const SceneSettings& settings);

}  // namespace vps::dynamics

// SPDX-License-Identifier: BSD-3-Clause
// Fifty parts of 5,000 points each, dropped into a box.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct HeapResult {
  int bodies = 0;
  double points = 0;              ///< of a part's shell; mean
  int asleep = 0;                 ///< bodies at the end
  double asleep_s = 0;            ///< when the last one fell asleep; -1: never
  int escaped = 0;                ///< bodies outside of the box at the end
  double final_m = 0;             ///< greatest penetration between neighbours at the end
  double step_ms[3] = {0, 0, 0};  ///< median, p99, worst, over all steps
  double our_share = 0;           ///< share of all time in the narrow phase and the solver
};

/// Twenty seconds (short: ten bodies, eight seconds). Sleeping is enabled, below 5 mm/s and 0.2 rad/s.
HeapResult dropHeap(const SceneSettings& settings);

/// One of its two parts, of 20 teeth.
PartMesh makeHeapGear();
/// The engine for this scene: shells of about 5,000 points.
Engine heapEngine();

}  // namespace vps::dynamics

// SPDX-License-Identifier: BSD-3-Clause
// A ring of 20,000 triangles dropped over a peg on a plate, with 0.1 mm of clearance.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct RingResult {
  double rest_height_m = 0;  ///< of the ring's centre above the plate; right: half the ring's height
  double height_error_m = 0;
  double deepest_m = 0;   ///< greatest penetration
  double jitter_m_s = 0;  ///< greatest speed of any point in the last half second
  double step_ms = 0;     ///< mean over the steps with contact
  int contact_steps = 0;
};

RingResult dropRing(const SceneSettings& settings);

}  // namespace vps::dynamics

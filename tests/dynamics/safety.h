// SPDX-License-Identifier: BSD-3-Clause
// Three short scenes about what must never happen: a burst, a proxy that collides, a part that tunnels.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct CreatedInsideResult {
  double overlap_m = 0;  ///< at the start
  double kinetic_J = 0;  ///< greatest over time
  double speed_m_s = 0;  ///< greatest of any point, by displacement too
  double left_m = 0;     ///< overlap at the end
  double overlap_J = 0;  ///< energy of the overlap as penalty contact sees it: 1/2 k A d^2, half of each side
};
/// A 20 x 15 x 10 mm block created `depth_m` deep in a fixed one, without gravity; a second is given.
CreatedInsideResult createInside(const SceneSettings& settings, double depth_m);

struct ProxyResult {
  double disturbed_m = 0;  ///< how far a part lying in the proxy's way was moved by it
  int responses = 0;       ///< most contacts of the proxy that a solver was given
  double held_m = 0;       ///< of the part in hand over the plate that holds it back, at the end
};
/// A kinematic proxy with the part's own shape is coupled to a part in hand and led down through a part at
/// rest (that the part in hand is kept away from by a plate above it).
ProxyResult leadProxyThrough(const SceneSettings& settings);

struct WallResult {
  double deepest_m = 0;  ///< worst penetration at any time
  double beyond_m =
      0;  ///< farthest that the part's centre got past the wall's face; negative: it stayed in front
  double speed_m_s = 0;  ///< at the end
};
/// A block flies at a wall 2 mm thick. @param is_turned  a corner first, else face on
WallResult shootAtWall(const SceneSettings& settings, double speed_m_s, bool is_turned);

}  // namespace vps::dynamics

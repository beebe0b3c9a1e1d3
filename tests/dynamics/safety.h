// SPDX-License-Identifier: BSD-3-Clause
// Three short scenes for failures that must never happen: a burst, a proxy that collides, a part that
// tunnels.
#pragma once

#include "world.h"

namespace vps::dynamics {

struct CreatedInsideResult {
  double overlap_m = 0;  ///< at the start
  double kinetic_J = 0;  ///< greatest over time
  double speed_m_s = 0;  ///< greatest of any point, also by displacement
  double left_m = 0;     ///< overlap at the end
  double overlap_J = 0;  ///< energy of the overlap in penalty contact: 1/2 k A d^2, half of it from each side
};
/// A 20 x 15 x 10 mm block created `depth_m` deep in a fixed one, without gravity, for one second.
CreatedInsideResult createInside(const SceneSettings& settings, double depth_m);

struct ProxyResult {
  double disturbed_m = 0;  ///< displacement of a part in the proxy's path
  int responses = 0;       ///< greatest number of the proxy's contacts that reached a solver
  double held_m = 0;       ///< height of the part in hand above the plate that stops it, at the end
};
/// A kinematic proxy with the part's own shape is coupled to a part in hand and moved down through a part at
/// rest. A plate above that part stops the part in hand.
ProxyResult leadProxyThrough(const SceneSettings& settings);

struct WallResult {
  double deepest_m = 0;  ///< greatest penetration at any time
  double beyond_m =
      0;  ///< greatest distance of the part's centre beyond the wall's face; negative: it stayed in front
  double speed_m_s = 0;  ///< at the end
};
/// A block flies at a wall 2 mm thick. @param is_turned  corner first; otherwise face on
WallResult shootAtWall(const SceneSettings& settings, double speed_m_s, bool is_turned);

}  // namespace vps::dynamics

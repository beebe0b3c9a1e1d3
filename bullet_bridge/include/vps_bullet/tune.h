// SPDX-License-Identifier: BSD-3-Clause
// Bullet's parameters, set for parts of millimetres and grams at 1 kHz; and put back.
#pragma once

#include <LinearMath/btScalar.h>

#include <string>
#include <utility>
#include <vector>

#include "vps_bullet/export.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace vps::bullet {

/// What tuneWorld changed, for its reader and for restoreWorld.
struct VPS_BULLET_API WorldTuning {
  /// A line for each: "split impulse threshold [m]: -0.04 -> 0".
  std::vector<std::string> changes;
  [[nodiscard]] bool empty() const { return changes.empty(); }

  /// Values before and after, by parameter.
  std::vector<std::pair<double, double>> values;
  /// Bodies that got tuneBody()'s thresholds. Only compared, so that they may be gone.
  std::vector<const btRigidBody*> bodies;
};

/// Sets a world's parameters to what contact at part scale needs; the reasons stand beside each in tune.cpp.
/// Also tuneBody() for the bodies in it that have Bullet's own sleeping thresholds: call it when they are
/// added. One parameter, the broadphase's margin, is the whole process's.
/// Throws std::invalid_argument for fewer than one iteration.
VPS_BULLET_API WorldTuning tuneWorld(btDiscreteDynamicsWorld& world, int solver_iterations = 100);

/// Puts back what tuneWorld changed, where it still is as tuneWorld set it.
VPS_BULLET_API void restoreWorld(btDiscreteDynamicsWorld& world, const WorldTuning& tuning);

/// Below these a body that keeps still for two seconds (Bullet's gDeactivationTime) may fall asleep. Bullet's
/// 0.8 m/s and 1 rad/s stop a part that slides at 0.1 m/s. At 1 mm/s a body has the energy of 0.05 um of
/// height; 0.1 rad/s is that speed at 10 mm.
inline constexpr double kSleepSpeed_m_s = 1e-3;
inline constexpr double kSleepSpin_rad_s = 0.1;

/// Sets a body's sleeping thresholds to those.
VPS_BULLET_API void tuneBody(btRigidBody& body);

}  // namespace vps::bullet

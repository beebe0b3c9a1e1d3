// SPDX-License-Identifier: BSD-3-Clause
// Sets Bullet's parameters for parts of millimetres and grams at 1 kHz, and restores them.
#pragma once

#include <LinearMath/btScalar.h>

#include <string>
#include <utility>
#include <vector>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace vps::bullet {

/// The changes that tuneWorld() made, as text and as input for restoreWorld().
struct WorldTuning {
  /// One line for each parameter: "split impulse threshold [m]: -0.04 -> 0".
  std::vector<std::string> changes;
  [[nodiscard]] bool empty() const { return changes.empty(); }

  /// Values before and after, for each parameter.
  std::vector<std::pair<double, double>> values;
  /// Bodies that received tuneBody()'s thresholds. Only the addresses are compared, so the bodies may have
  /// been deleted.
  std::vector<const btRigidBody*> bodies;
};

/// Sets a world's parameters for contact at part scale; tune.cpp gives the reason for each. Also calls
/// tuneBody() for the bodies of the world that have Bullet's default sleeping thresholds, so call tuneWorld()
/// after the bodies are added. One parameter, the margin of the broadphase, applies to the whole process.
/// Throws std::invalid_argument for fewer than one iteration.
VPS_BULLET_API WorldTuning tuneWorld(btDiscreteDynamicsWorld& world, int solver_iterations = 100);

/// Restores the values that tuneWorld() changed, except values that have been changed again since.
VPS_BULLET_API void restoreWorld(btDiscreteDynamicsWorld& world, const WorldTuning& tuning);

/// A body that stays below both speeds for two seconds (Bullet's gDeactivationTime) may fall asleep. Bullet's
/// defaults, 0.8 m/s and 1 rad/s, stop a part that slides at 0.1 m/s. At 1 mm/s a body has the energy of 0.05
/// um of height; 0.1 rad/s is 1 mm/s at a radius of 10 mm.
inline constexpr double kSleepSpeed_m_s = 1e-3;
inline constexpr double kSleepSpin_rad_s = 0.1;

/// Sets a body's sleeping thresholds to kSleepSpeed_m_s and kSleepSpin_rad_s.
VPS_BULLET_API void tuneBody(btRigidBody& body);

}  // namespace vps::bullet

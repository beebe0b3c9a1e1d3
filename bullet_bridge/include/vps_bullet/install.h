// SPDX-License-Identifier: BSD-3-Clause
// Registering VPS contact with an ordinary, unpatched Bullet world.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vps/fidelity.h"

class btCollisionDispatcher;
class btDiscreteDynamicsWorld;

namespace vps {

/// How contact is turned into motion.
enum class ContactMode {
  Constraint,  ///< rigid: a few contacts for the solver, friction as a cone
  /// Compliant: every touching point presses with stiffness times area times depth and rubs by a bristle,
  /// solved implicitly. Needs VpsSolver: other solvers get the rigid contacts. No restitution.
  Penalty,
};

struct VpsBulletSettings {
  ContactMode mode = ContactMode::Constraint;
  double stiffness_N_per_m3 = 1e12;  ///< of penalty contact, per area; assumed: steel, 0.2 m thick
  int contact_limit = 64;            ///< contacts given to the solver for each pair, >= 4
  /// A point is a contact if it can come within this of touching during the step. 20 um: measured; larger
  /// feeds the solver contacts that do not act, smaller misses what rotation and the solver's residual bring
  /// in.
  double slack_m = 20e-6;
  Sides sides = Sides::Both;
  Gradient gradient = Gradient::Continuous;
  bool use_surfaces = true;  ///< correct contacts by VpsModels::surfaces where there are any
  /// Near points of one side of a pair looked at, lowest ids first; 0: all. Bounds a step's time, and leaves
  /// a patch without contact where points are left out. At least contact_limit.
  int candidate_limit = 0;
};

/// Counters since installation, over all pairs of a dispatcher.
struct VpsBulletStats {
  std::size_t pair_updates = 0;  ///< pairs whose points were queried
  std::size_t points_tested = 0;
  std::size_t candidates = 0;  ///< points that could touch within the step
  std::size_t contacts = 0;    ///< of them given to the solver
  std::size_t left_out = 0;    ///< candidates beyond candidate_limit: raise it
};

/// Makes VpsShapes collide in worlds that use this dispatcher: with each other, and with Bullet's own shapes.
/// Contact and closest-point queries, both orders, every shape type. Installing again replaces the settings.
/// Call before bodies meet: a pair that exists keeps the algorithm it has.
/// Throws std::invalid_argument for settings out of range.
void installVps(btCollisionDispatcher& dispatcher, const VpsBulletSettings& settings = {});

/// Puts the dispatcher's stock functions back. First remove the bodies with VpsShapes from the world: their
/// pairs hold algorithms that belong to the installation. Without an installation: nothing. Must be called
/// before the dispatcher dies.
void uninstallVps(btCollisionDispatcher& dispatcher);

[[nodiscard]] bool isVpsInstalled(const btCollisionDispatcher& dispatcher);
[[nodiscard]] VpsBulletStats vpsStats(const btCollisionDispatcher& dispatcher);

/// Sets a world's parameters to what contact at part scale (millimetres, grams, 1 kHz) needs. Sleeping is
/// left alone.
/// @return what it changed, a line for each: "split impulse threshold: -0.04 -> 0 m".
std::vector<std::string> tuneWorld(btDiscreteDynamicsWorld& world, int solver_iterations = 100);

}  // namespace vps

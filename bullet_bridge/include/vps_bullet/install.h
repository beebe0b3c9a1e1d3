// SPDX-License-Identifier: BSD-3-Clause
// Registering VPS contact with an ordinary, unpatched Bullet world.
#pragma once

#include <cstddef>
#include "vps/fidelity.h"
#include "vps_bullet/export.h"
#include "vps_bullet/tune.h"

class btCollisionDispatcher;

namespace vps::bullet {

struct Settings {
  /// Penalty needs Solver: other solvers get the contacts of Constraint. Penalty has no restitution.
  ContactMethod mode = ContactMethod::Constraint;
  double stiffness_N_per_m3 = 1e12;  ///< of penalty contact, per area; assumed: steel, 0.2 m thick
  int contact_limit = 64;            ///< contacts given to the solver for each pair, >= 4
  /// A point is a contact if it can come within this of touching during the step. 20 um: measured; larger
  /// feeds the solver contacts that do not act, smaller misses what rotation and the solver's residual bring
  /// in.
  double contact_margin_m = 20e-6;
  Sides sides = Sides::Both;
  Gradient gradient = Gradient::Continuous;
  bool use_surfaces = true;  ///< correct contacts by ShapeModels::surfaces where there are any
  /// Near points of one side of a pair, and crossings of edges, looked at, lowest ids first; 0: all. Bounds a
  /// step's time, and leaves a patch without contact where points are left out. At least contact_limit.
  int candidate_limit = 0;
};

/// Counters since installation, over all pairs of a dispatcher.
struct Stats {
  std::size_t pair_updates = 0;  ///< pairs whose points were queried
  std::size_t points_tested = 0;
  /// Points and crossings that could touch within the step; of very many points on a map those that lead.
  std::size_t candidates = 0;
  std::size_t contacts = 0;  ///< of them given to the solver
  std::size_t left_out = 0;  ///< candidates beyond candidate_limit: raise it
  /// Pairs that were inside each other when they first met, deeper than their motion explains; they are moved
  /// apart at 0.05 m/s. The first is named on stderr.
  std::size_t overlapping_starts = 0;
  double deepest_start_m = 0;  ///< the deepest of them
};

/// Makes VpsShapes collide in worlds that use this dispatcher: with each other, and with Bullet's own shapes.
/// Contact and closest-point queries, both orders, every shape type; README.md lists them. Installing again
/// replaces the settings. Call before bodies meet: a pair that exists keeps the algorithm it has. See
/// tuneWorld for the world's own parameters. Throws std::invalid_argument for settings out of range.
VPS_BULLET_API void install(btCollisionDispatcher& dispatcher, const Settings& settings = {});

/// Puts back the functions that were registered before, where nobody has registered others since. Pairs that
/// exist keep VPS contact until their bodies part or are removed; that is said on stderr.
/// Without an installation: nothing. A dispatcher may also die without it; one that comes to lie at the same
/// address starts without an installation.
VPS_BULLET_API void uninstall(btCollisionDispatcher& dispatcher);

[[nodiscard]] VPS_BULLET_API bool isInstalled(const btCollisionDispatcher& dispatcher);
[[nodiscard]] VPS_BULLET_API Stats stats(const btCollisionDispatcher& dispatcher);

}  // namespace vps::bullet

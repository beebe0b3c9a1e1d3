// SPDX-License-Identifier: BSD-3-Clause
// Runs a world and looks at what every row is judged by: numbers, energy, overlap, rest.
#pragma once

#include <functional>
#include <vector>

#include "dynamics/world.h"
#include "judgement.h"

namespace vps::stability {

using dynamics::Placed;

struct Watching {
  int steps = 1000;
  double dt_s = 1e-3;
  int look_every = 5;  ///< steps from one look at the overlap to the next
  std::function<void(int)> before_step = nullptr;
  std::function<double(int)> step_s = nullptr;  ///< instead of dt_s, where it changes
};

struct Watched {
  bool is_finite = true;  ///< every pose and velocity at every step
  double start_J = 0;     ///< kinetic and height
  double gained_J = 0;    ///< greatest rise over the start
  double end_J = 0;
  double deepest_m = -1e300;  ///< worst overlap of any two
  double final_m = -1e300;    ///< at the end
  double speed_m_s = 0;       ///< greatest of any point in the last fifth
  double fastest_m_s = 0;     ///< greatest of any point ever
  double drift_m = 0;         ///< greatest way of any body's centre in the last fifth
};

/// @param parts  all that is looked at; overlap only of pairs of which one moves
Watched watch(dynamics::World& world, const std::vector<Placed>& parts, const Watching& watching);

/// Kinetic energy, and height along the world's gravity [J], of those that move.
double energy_J(dynamics::World& world, const std::vector<Placed>& parts);
/// Of those that move, about the origin of W.
Vec3 momentum_Ns(const std::vector<Placed>& parts);
Vec3 angularMomentum_Nms(const std::vector<Placed>& parts);

/// Numbers, energy and overlap. The overlap allowed, `deep_m`, may be pushed out again, which lifts all
/// weight by as much; and Bullet's steps lift what rises at v by v dt / 2 too much (semi-implicit Euler).
/// That, and rounding of the energy itself, is all that may be gained.
void judgeRun(Judgement& judgement, const Watched& watched, double weight_N, double deep_m, double dt_s);
/// It lies still: slower than a thousandth of what gravity adds in a step, so that contact holds it, not
/// chance.
void judgeRest(Judgement& judgement, const Watched& watched, double dt_s);

}  // namespace vps::stability

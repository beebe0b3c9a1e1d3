// SPDX-License-Identifier: BSD-3-Clause
// Runs a world and measures what every row is judged by: finite values, energy, overlap, rest.
#pragma once

#include <functional>
#include <vector>

#include "dynamics/world.h"
#include "rows.h"

namespace vps::stability {

using dynamics::Placed;

struct Watching {
  int steps = 1000;
  double dt_s = 1e-3;
  int measure_every = 5;  ///< steps between measurements of the overlap
  std::function<void(int)> before_step = nullptr;
  std::function<double(int)> step_s = nullptr;  ///< variable time step, instead of dt_s
};

struct Watched {
  bool is_finite = true;  ///< all poses and velocities at every step
  double start_J = 0;     ///< kinetic and potential energy at the start
  double gained_J = 0;    ///< greatest increase since the start
  double end_J = 0;
  double deepest_m = -1e300;  ///< greatest overlap of any two parts
  double final_m = -1e300;    ///< at the end
  double speed_m_s = 0;       ///< greatest speed of any point in the last fifth of the run
  double fastest_m_s = 0;     ///< greatest speed of any point in the whole run
  double drift_m = 0;         ///< greatest displacement of any body's centre in the last fifth of the run
};

/// @param parts  all parts that are measured; overlap only of pairs with a moving part
Watched watch(dynamics::World& world, const std::vector<Placed>& parts, const Watching& watching);

/// Kinetic energy, and potential energy in the world's gravity [J], of the moving parts.
double energy_J(dynamics::World& world, const std::vector<Placed>& parts);
/// Momentum, and angular momentum about the origin of W, of the moving parts.
Vec3 momentum_Ns(const std::vector<Placed>& parts);
Vec3 angularMomentum_Nms(const std::vector<Placed>& parts);

/// Finite values, energy and overlap. Two gains of energy are allowed besides rounding: contact may remove
/// the allowed overlap `deep_m`, which lifts all weight by this distance; and Bullet's semi-implicit Euler
/// steps lift a body that rises at v by v dt / 2 too much.
void judgeRun(Judgement& judgement, const Watched& watched, double weight_N, double deep_m, double dt_s);
/// A part is at rest if it is slower than a thousandth of the speed that gravity adds in a step, so that
/// contact must support it.
void judgeRest(Judgement& judgement, const Watched& watched, double dt_s);

}  // namespace vps::stability

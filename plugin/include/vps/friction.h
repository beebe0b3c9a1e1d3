// SPDX-License-Identifier: BSD-3-Clause
// Coulomb's law of dry friction, |f_t| <= mu f_n, in three forms: a cone for impulses of a solver, a bristle
// for penalty contact, and a damper for linear equations.
//
//     f_t                  f_t                 f_t
//      |                    |   ____            |   ____
//  ____|  cone              |  /  bristle       |  /  damper
//      |____ slip velocity  | /                 | /
//      |                    |/___ displacement  |/___ slip velocity
//
// Models whose coefficient depends on the speed of slip are rows of kFrictionModels in vps_bullet/settings.h.
//
// Sources: Coulomb 1785 for the law; Dahl 1968 for the bristle.
#pragma once

#include <algorithm>
#include <cmath>

#include "vps/pose.h"

namespace vps {

/// A body's factor of the coefficient of friction, for engines such as Bullet that multiply the values of
/// both bodies. For two bodies of one material the product is that material's coefficient.
inline double frictionFactor(double mu) {
  return std::sqrt(mu);
}

/// Coefficient of friction between two materials: the geometric mean of their coefficients on themselves.
inline double combinedFriction(double mu_a, double mu_b) {
  return frictionFactor(mu_a) * frictionFactor(mu_b);
}

/// Length of a tangential impulse or force. std::hypot is not used: impulses are far from the ends of a
/// double's range, and std::hypot took a sixth of the solving time of a heap.
inline double tangentLength(double t1, double t2) {
  return std::sqrt(t1 * t1 + t2 * t2);
}

/// Cone: shortens a tangential impulse or force to `limit` (mu times the normal impulse or force), keeping
/// its direction.
inline void limitToCone(double& t1, double& t2, double limit) {
  const double length = tangentLength(t1, t2);
  if (!(length > limit)) return;
  t1 *= limit / length;
  t2 *= limit / length;
}

/// Force of a bristle: a tangential spring between two bodies that slips where its force would exceed the
/// limit. A bristle holds a part at rest without creep, because its force follows displacement and not
/// velocity.
struct BristleForce {
  Vec3 f_N = Vec3::Zero();        ///< force along the bend
  double slip_m = 0;              ///< length of the bend if nothing had slipped; 0: the bristle sticks
  Vec3 direction = Vec3::Zero();  ///< direction of the slip, unit; zero: the bristle sticks
};

/// @param bend_m   displacement of the bristle's root relative to its tip, in the tangent plane
/// @param limit_N  mu times the normal force; if it is not positive, there is no friction
inline BristleForce bristleForce(const Vec3& bend_m, double k_N_per_m, double limit_N) {
  BristleForce force;
  if (!(limit_N > 0)) return force;
  const double length2 = bend_m.squaredNorm();
  if (!(length2 > 0)) return force;
  if (k_N_per_m * k_N_per_m * length2 <= limit_N * limit_N) {
    force.f_N = k_N_per_m * bend_m;
  } else {
    force.slip_m = std::sqrt(length2);
    force.direction = bend_m / force.slip_m;
    force.f_N = limit_N * force.direction;
  }
  return force;
}

/// Damper: the viscous coefficient [N s/m] whose force is `limit_N` at the slip speed. Below `creep_m_s` the
/// coefficient is constant, so that the force is linear and smaller. The limit may also be an impulse [N s],
/// or a torque with speeds in rad/s.
inline double frictionDamping(double limit_N, double speed_m_s, double creep_m_s) {
  return limit_N / std::max(speed_m_s, creep_m_s);
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Coulomb's law of dry friction, |f_t| <= mu f_n, in the three forms that contact needs it: the cone for
// impulses that a solver finds, a bristle for penalty contact, a damper for equations that must be linear.
//
//     f_t                  f_t                 f_t
//      |                    |   ____            |   ____
//  ____|  cone              |  /  bristle       |  /  damper
//      |____ slip velocity  | /                 | /
//      |                    |/___ displacement  |/___ slip velocity
//
// Sources: Coulomb 1785 for the law; Dahl 1968 for the bristle.
#pragma once

#include <algorithm>
#include <cmath>

#include "vps/pose.h"

namespace vps {

/// A body's share in the coefficient of friction, for engines that multiply the values of both bodies, as
/// Bullet does. Two bodies of one material have that material's coefficient together.
inline double frictionFactor(double mu) {
  return std::sqrt(mu);
}

/// Coefficient of friction between two materials: the geometric mean of their coefficients on themselves.
inline double combinedFriction(double mu_a, double mu_b) {
  return frictionFactor(mu_a) * frictionFactor(mu_b);
}

/// Length of a tangential impulse or force. Impulses are far from the ends of a double's range; std::hypot
/// guards those and took a sixth of the solving time of a heap.
inline double tangentLength(double t1, double t2) {
  return std::sqrt(t1 * t1 + t2 * t2);
}

/// Cone: shortens a tangential impulse or force to `limit` (mu times the normal one), keeping its direction.
inline void limitToCone(double& t1, double& t2, double limit) {
  const double length = tangentLength(t1, t2);
  if (!(length > limit)) return;
  t1 *= limit / length;
  t2 *= limit / length;
}

/// Force of a bristle: a tangential spring between two bodies that slips where its force would exceed the
/// limit. It holds a part at rest without creep, since it is bent by displacement and not by velocity.
struct BristleForce {
  Vec3 f_N = Vec3::Zero();        ///< along the bend
  double slip_m = 0;              ///< length of the bend if nothing had slipped; 0: the bristle sticks
  Vec3 direction = Vec3::Zero();  ///< of the slip, unit; zero: it sticks
};

/// @param bend_m   displacement of the bristle's root against its tip, in the tangent plane
/// @param limit_N  mu times the normal force; without one there is no friction
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

/// Damper: the viscous coefficient [N s/m] that gives `limit_N` at the slip speed, and less below
/// `creep_m_s`, where the law is made linear. Also for an impulse as limit [N s], or a torque with rad/s.
inline double frictionDamping(double limit_N, double speed_m_s, double creep_m_s) {
  return limit_N / std::max(speed_m_s, creep_m_s);
}

}  // namespace vps

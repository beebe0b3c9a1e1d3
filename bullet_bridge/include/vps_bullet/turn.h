// SPDX-License-Identifier: BSD-3-Clause
// How far bodies may turn in one step, and the number of substeps that keeps them within that limit.
//
//     for (int k = 0, n = substepsFor(world, dt_s, 100); k < n; ++k) world.stepSimulation(dt_s / n, 0);
#pragma once

#include <numbers>
#include <vector>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

class btCollisionWorld;
class btRigidBody;

namespace vps::bullet {

/// Greatest turn in a step of two bodies in contact, relative to each other [rad]. A contact is a plane for
/// the whole step, and a point at distance r from the axis leaves its plane by r turn^2 / 2. At 0.1 rad this
/// distance is 5 % of the point's path, and the plane's normal is off by 6 degrees. Measured with involute
/// gears of 12 to 100 teeth: the driven gear's speed is right to 0.3 % up to 0.12 rad, and wrong by 1 % or
/// more from 0.13 to 0.17 rad on (tests/families, D_gears).
inline constexpr double kContactTurn_rad = 0.1;
/// If bodies turn farther than kContactTurn_rad: greatest distance by which a contact point may leave its
/// plane within a step without a report [m]: the overlap that is allowed between parts (10 um, also in
/// scenes). A point at distance r from the axis of the relative motion leaves its plane by r turn^2 / 2; for
/// rolling contact r is 0.
inline constexpr double kContactSagitta_m = 10e-6;
/// Turns that are too far for contacts are reported after this number of consecutive steps. An impact and its
/// rebound last one or two steps each, so the error that they cause is limited to these steps.
inline constexpr int kTurnsInRow = 5;
/// Greatest turn in a step that Bullet carries out fully (btTransformUtil::integrateTransform) [rad].
inline constexpr double kBulletTurn_rad = std::numbers::pi / 4;

/// Rotation of a body, relative to the limit that requires the shortest step.
struct BodyTurn {
  const btRigidBody* body = nullptr;
  bool is_in_contact = false;  ///< the rotation is relative to a body in contact
  double w_rad_s = 0;
  /// Greatest acceleration, over all contacts of the body, with which a contact leaves its plane because of
  /// the relative rotation. In a step of dt_s the contact leaves its plane by leaving_m_s2 * dt_s^2 / 2.
  double leaving_m_s2 = 0;

  [[nodiscard]] double limit_rad() const { return is_in_contact ? kContactTurn_rad : kBulletTurn_rad; }
  /// Number of steps per second with which the body turns by no more than the limit in a step.
  [[nodiscard]] double rate_hz() const { return w_rad_s / limit_rad(); }
};

/// Appends the rotation of each dynamic btRigidBody, with the contacts of the last step that act on the
/// bodies (no triggers). The order is that of the world's bodies. Allocates only in `out`. O(bodies +
/// contacts).
VPS_BULLET_API void findTurns(btCollisionWorld& world, std::vector<BodyTurn>& out);

/// Number of equal substeps into which the next dt_s must be divided so that no body turns too far at its
/// present speed. Bodies whose bounding boxes overlap on their way in dt_s, at their velocity and weight,
/// count as in contact if the dispatcher lets them collide and respond (filters, joints, triggers). The
/// result is between 1 and `most`, and deterministic. O(pairs of the broadphase).
VPS_BULLET_API int substepsFor(btCollisionWorld& world, double dt_s, int most);

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// How far bodies may turn in one step, and into how many steps a time must be divided so that they do not.
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
/// the whole step, and a point at distance r from the axis leaves its plane by r turn^2 / 2: at 0.1 rad by 5
/// % of its way, and the plane's normal is then off by 6 degrees. Measured with involute gears of 12 to 100
/// teeth: the driven gear's speed is right to 0.3 % up to 0.12 rad, and wrong by 1 % or more from 0.13 to
/// 0.17 rad on (tests/families, D_gears).
inline constexpr double kContactTurn_rad = 0.1;
/// Where bodies turn farther, a contact point may leave its plane within a step by this, before it matters
/// [m]: the overlap that is allowed between parts (10 um; scenes judge by the same). With r the distance of
/// the point from the axis of the relative motion, it leaves by r turn^2 / 2. What rolls has r = 0.
inline constexpr double kContactSagitta_m = 10e-6;
/// In so many steps in a row, before it is reported: an impact and its rebound last one or two steps each,
/// and give no more than that step's error.
inline constexpr int kTurnsInRow = 5;
/// Above this Bullet turns a body by less than its speed in a step (btTransformUtil::integrateTransform)
/// [rad].
inline constexpr double kBulletTurn_rad = std::numbers::pi / 4;

/// How fast a body turns, by the bound that asks for the shortest step.
struct BodyTurn {
  const btRigidBody* body = nullptr;
  bool is_in_contact = false;  ///< the rotation is that against a body in contact
  double w_rad_s = 0;
  /// Greatest acceleration with which a contact leaves its plane, by the rotation of the
  /// two bodies about the axis of their relative motion: of all pairs of the body. In a step of dt_s it
  /// leaves by half of it times dt_s^2.
  double leaving_m_s2 = 0;

  [[nodiscard]] double limit_rad() const { return is_in_contact ? kContactTurn_rad : kBulletTurn_rad; }
  /// Steps a second in which the body turns by no more than the limit.
  [[nodiscard]] double rate_hz() const { return w_rad_s / limit_rad(); }
};

/// The rotation of each dynamic btRigidBody, with the contacts of the last step, as far as these act on the
/// bodies (no triggers). Appends to `out`, in the order of the world's bodies, and allocates nothing else.
/// O(bodies + contacts).
VPS_BULLET_API void findTurns(btCollisionWorld& world, std::vector<BodyTurn>& out);

/// Into how many steps of equal length the next dt_s must be divided so that no body turns too far, at its
/// present speed. Bodies whose bounding boxes overlap on their way in dt_s, at their velocity and weight,
/// count as in contact, since they may come to be, if the dispatcher lets them collide and respond (filters,
/// joints, triggers). At least 1, at most `most`. O(pairs of the broadphase); the same for the same state of
/// the world.
VPS_BULLET_API int substepsFor(btCollisionWorld& world, double dt_s, int most);

}  // namespace vps::bullet

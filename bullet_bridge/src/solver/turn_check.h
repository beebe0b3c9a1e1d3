// SPDX-License-Identifier: BSD-3-Clause
// Says once that bodies turn farther in a step than the step can hold.
#pragma once

#include <atomic>
#include <span>

class btCollisionObject;

namespace vps::bullet {

/// What one installation has reported.
struct TurnReports {
  bool is_on = true;  ///< Settings::warns_of_turns
  std::atomic_flag clamped, in_contact;
};

/// Reports (log.h) a body that Bullet turns by less than its speed, once. O(bodies).
void reportClampedTurn(TurnReports& reports, std::span<btCollisionObject* const> bodies, double dt_s);

/// Reports bodies in contact that turn too far against each other, once.
/// @param w_rad_s  of their relative rotation
void reportContactTurn(TurnReports& reports, const btCollisionObject& body0, const btCollisionObject& body1,
                       double w_rad_s, double dt_s);

}  // namespace vps::bullet

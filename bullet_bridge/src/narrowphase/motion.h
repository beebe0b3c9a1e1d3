// SPDX-License-Identifier: BSD-3-Clause
// How a collision object will move in the coming step, before contact.
#pragma once

#include "vps/pose.h"

class btCollisionObject;

namespace vps::bullet::inline v0 {

/// Velocity about the world's origin, in W, that the object would reach by the end of the step without
/// contact: its own, plus external forces, plus (with_couplings) the pull of its CouplingConstraints. A link
/// of a btMultiBody has the velocity that its joints give it. Zero for static objects.
Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings = true);

}  // namespace vps::bullet::inline v0

// SPDX-License-Identifier: BSD-3-Clause
// How a collision object will move in the coming step, before contact.
#pragma once

#include "vps/pose.h"

class btCollisionObject;

namespace vps::bullet {

/// Velocity about the world's origin, in W, that the object would reach by the end of the step without
/// contact: its own, plus external forces, plus (with_couplings) the pull of its CouplingConstraints. A link
/// of a btMultiBody has the velocity that its joints give it. Zero for static objects.
Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings = true);

/// Where a twist about the world's origin, constant for t_s, takes the object, in W. It turns about its own
/// centre, wherever the world's origin is.
Pose displacement(const btCollisionObject& object, const Twist& V, double t_s);

}  // namespace vps::bullet

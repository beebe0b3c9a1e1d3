// SPDX-License-Identifier: BSD-3-Clause
// Rotation of a free body within a step.
#pragma once

#include "vps/pose.h"

namespace vps::bullet {

/// The constant angular velocity with which a step turns a free body, so that the body keeps its angular
/// momentum and its energy at once, and a body that spins about a principal axis turns at exactly its own
/// velocity. All vectors are in the body's principal frame B.
///
/// Sought is W in  J W + h(W) W x J W = J w,  with  h = tan(|W| dt / 2) / |W|.
///
/// Let R0 and R1 = R0 exp(W dt) be the rotation before and after the step, and w1 the velocity after it that
/// keeps the momentum: R1 J w1 = R0 J w. Written with Cayley's transform, exp(W dt) = (1 - hW)^-1 (1 + hW),
/// momentum says J (w1 - w) + hW x J (w1 + w) = 0, which the equation above solves with w1 = 2 W - w. So (w1
/// + w) / 2 = W, and the product with w1 + w gives w1 J w1 = w J w: the energy is kept for any h. [Simo and
/// Wong 1991; with h = dt / 2 their ALGO_C1, which turns a spinning disc too slowly by (w dt)^2 / 12.]
///
/// Where |W| dt is above pi / 4, Bullet turns a body by less: by 2 atan(h |W|) with h = tan(pi / 8) / (pi /
/// 4) dt. With that h momentum and energy are kept all the same.
///
/// @param inertia_kg_m2  principal moments J, positive
/// @param w_B            angular velocity before the step, with the torques that act in it [rad/s]
/// @return W [rad/s]; w_B itself if it is zero, or if no W is found: where a value is not
/// finite, or for inertias that no body has (one above the sum of the others)
/// Newton's method: two to four iterations of a 3x3 system below 100 rad/s at 1 kHz.
Vec3 meanAngularVelocity(const Vec3& inertia_kg_m2, const Vec3& w_B, double dt_s);

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// A contact as a point of Bullet's manifolds.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

#include "narrowphase/contact_candidate.h"
#include "narrowphase/pair_material.h"

namespace vps::bullet {

// Bits of m_contactPointFlags far above Bullet's own: the point was given to gContactAddedCallback, which set
// friction directions, or a normal, of its own.
constexpr int kWasAdded = 1 << 25, kOwnDirections = 1 << 26, kOwnNormal = 1 << 27;

/// Positions on both bodies: the shell point on its own side, its foot on the other's surface.
void positions(const Candidate& c, Vec3& on0, Vec3& on1);

/// Index of the shell point on its own side; at a crossing, of the edge on either side.
int indexOn(const Candidate& c, int side);

/// With all that btManifoldResult::addContactPoint() would set from the bodies, without impulses.
btManifoldPoint makePoint(const Candidate& c, const PairMaterial& material,
                          const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion);

/// Gives a point the last step's impulses, in its own friction directions.
void copyImpulses(btManifoldPoint& point, const btManifoldPoint& old);

/// Gives a point that is not added again what the user's callback has set.
void keepMaterial(btManifoldPoint& point, const btManifoldPoint& old);

}  // namespace vps::bullet

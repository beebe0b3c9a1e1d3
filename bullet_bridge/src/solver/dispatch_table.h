// SPDX-License-Identifier: BSD-3-Clause
// Read access to a dispatcher's create functions, which Bullet lets users write but only derived classes
// read.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace vps::bullet {

/// Bullet's shape type of a bullet::Shape. See shape.h for the reason.
inline constexpr int kShapeType = FAST_CONCAVE_MESH_PROXYTYPE;

struct DispatchTable : btCollisionDispatcher {
  using Functions =
      btCollisionAlgorithmCreateFunc* [MAX_BROADPHASE_COLLISION_TYPES][MAX_BROADPHASE_COLLISION_TYPES];
  static const Functions& contact(const btCollisionDispatcher& d) {
    return d.*(&DispatchTable::m_doubleDispatchContactPoints);
  }
  static const Functions& closest(const btCollisionDispatcher& d) {
    return d.*(&DispatchTable::m_doubleDispatchClosestPoints);
  }
};

}  // namespace vps::bullet

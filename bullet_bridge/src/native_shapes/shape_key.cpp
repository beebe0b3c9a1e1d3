// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/shape_key.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMeshShape.h>
#include <LinearMath/btTransform.h>

namespace vps::bullet {

ShapeKey keyOf(const btCollisionShape& shape) {
  ShapeKey key;
  key.type = shape.getShapeType();
  key.shape = &shape;
  if (const auto* hull = dynamic_cast<const btConvexHullShape*>(&shape))
    key.vertices = hull->getUnscaledPoints();
  if (const auto* mesh = dynamic_cast<const btTriangleMeshShape*>(&shape))
    key.vertices = mesh->getMeshInterface();
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3& scale = shape.getLocalScaling();
  for (int k = 0; k < 3; ++k) {
    key.numbers[k] = low[k];
    key.numbers[3 + k] = high[k];
    key.numbers[6 + k] = scale[k];
  }
  return key;
}

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// Loads a world that was saved in Bullet's format, with its parts. Header-only: link BulletWorldImporter and
// BulletFileLoader (Debian: libbullet-extras-dev), in the precision of this package.
#pragma once

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>

#include <map>
#include <memory>

#include "vps_bullet/saved_shape.h"
#include "vps_bullet/shape.h"

namespace vps::bullet::inline v0 {

/// Drop-in for btBulletWorldImporter. Rigid bodies whose shape was a Shape get one again; its models are
/// built anew at the resolution that they had. Owns these shapes, so it must outlive the bodies. A Shape
/// inside a compound stays the mesh that Bullet reads.
class WorldImporter : public btBulletWorldImporter {
 public:
  using btBulletWorldImporter::btBulletWorldImporter;

  btRigidBody* createRigidBody(bool is_dynamic, btScalar mass, const btTransform& X_WB,
                               btCollisionShape* shape, const char* name) override {
    return btBulletWorldImporter::createRigidBody(is_dynamic, mass, X_WB, restored(shape), name);
  }

 private:
  btCollisionShape* restored(btCollisionShape* shape) {
    const char* saved_as = getNameForPointer(shape);
    const auto* compound = shape->isCompound() ? static_cast<const btCompoundShape*>(shape) : nullptr;
    if (!saved_as || !compound || compound->getNumChildShapes() != 1) return shape;
    const btCollisionShape* child = compound->getChildShape(0);
    if (child->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE) return shape;
    std::unique_ptr<Shape>& own = shapes_[shape];
    if (!own)
      own = restoreShape(saved_as, *static_cast<const btBvhTriangleMeshShape*>(child)->getMeshInterface());
    return own ? own.get() : shape;
  }

  std::map<const btCollisionShape*, std::unique_ptr<Shape>> shapes_;
};

}  // namespace vps::bullet::inline v0

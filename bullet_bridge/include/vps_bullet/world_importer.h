// SPDX-License-Identifier: BSD-3-Clause
// Loads a world that was saved in Bullet's format, with its parts. Header-only: link BulletWorldImporter and
// BulletFileLoader (Debian: libbullet-extras-dev), in the precision of this package.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletFileLoader/btBulletFile.h>
#include <BulletWorldImporter/btBulletWorldImporter.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vps_bullet/shape.h"

namespace vps::bullet {

/// Drop-in for btBulletWorldImporter. Bodies whose shape was a Shape, or a compound that contains one at any
/// depth, get a Shape again; its models are built again at their previous resolution. Rigid bodies also get
/// back their inertia, velocities and sleeping thresholds, which Bullet's importer drops. Owns the Shapes, so
/// it must outlive the bodies.
class WorldImporter : public btBulletWorldImporter {
 public:
  using btBulletWorldImporter::btBulletWorldImporter;

  bool convertAllObjects(bParse::btBulletFile* file) override {
    const bool is_converted = btBulletWorldImporter::convertAllObjects(file);
    const bool is_double = (file->getFlags() & bParse::FD_DOUBLE_PRECISION) != 0;
    for (int i = 0; i < file->m_rigidBodies.size(); ++i) {
      const void* data = file->m_rigidBodies[i];
      btCollisionObject** object = m_bodyMap.find(data);
      btRigidBody* body = object ? btRigidBody::upcast(*object) : nullptr;
      if (body && is_double) restoreState(*static_cast<const btRigidBodyDoubleData*>(data), *body);
      if (body && !is_double) restoreState(*static_cast<const btRigidBodyFloatData*>(data), *body);
    }
    shape_of_.clear();  // the keys are addresses in the file's memory, which is freed
    return is_converted;
  }
  btRigidBody* createRigidBody(bool is_dynamic, btScalar mass, const btTransform& X_WB,
                               btCollisionShape* shape, const char* name) override {
    return btBulletWorldImporter::createRigidBody(is_dynamic, mass, X_WB, restored(shape), name);
  }
  btCollisionObject* createCollisionObject(const btTransform& X_WB, btCollisionShape* shape,
                                           const char* name) override {
    return btBulletWorldImporter::createCollisionObject(X_WB, restored(shape), name);
  }

 private:
  static btVector3 vectorOf(const btVector3DoubleData& saved) {
    btVector3 v;
    v.deSerializeDouble(saved);
    return v;
  }
  static btVector3 vectorOf(const btVector3FloatData& saved) {
    btVector3 v;
    v.deSerializeFloat(saved);
    return v;
  }
  template <typename Data>
  static void restoreState(const Data& saved, btRigidBody& body) {
    if (body.getInvMass() == 0) return;
    btVector3 inertia = vectorOf(saved.m_invInertiaLocal);
    for (int k = 0; k < 3; ++k) inertia[k] = inertia[k] != 0 ? 1 / inertia[k] : 0;
    body.setMassProps(1 / body.getInvMass(), inertia);
    body.updateInertiaTensor();
    body.setLinearVelocity(vectorOf(saved.m_linearVelocity));
    body.setAngularVelocity(vectorOf(saved.m_angularVelocity));
    body.setSleepingThresholds(btScalar(saved.m_linearSleepingThreshold),
                               btScalar(saved.m_angularSleepingThreshold));
  }

  btCollisionShape* restored(btCollisionShape* shape) {
    for (int i = 0; i < m_shapeMap.size(); ++i)
      if (*m_shapeMap.getAtIndex(i) == shape)
        return restored(*static_cast<const btCollisionShapeData*>(m_shapeMap.getKeyAtIndex(i).getPointer()),
                        shape);
    return shape;
  }
  /// @param saved  data of `shape` in the file
  btCollisionShape* restored(const btCollisionShapeData& saved, btCollisionShape* shape) {
    if (!shape->isCompound()) return shape;
    auto& compound = *static_cast<btCompoundShape*>(shape);
    if (Shape* own = restoredPart(saved, compound)) return own;
    const auto& children = reinterpret_cast<const btCompoundShapeData&>(saved);
    if (children.m_numChildShapes != compound.getNumChildShapes())
      return shape;  // some children were not readable
    std::vector<std::pair<btTransform, btCollisionShape*>> again;
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      again.emplace_back(compound.getChildTransform(i),
                         restored(*children.m_childShapePtr[i].m_childShape, compound.getChildShape(i)));
    while (compound.getNumChildShapes() > 0)
      compound.removeChildShapeByIndex(compound.getNumChildShapes() - 1);
    for (const auto& [X_SC, child] : again) compound.addChildShape(X_SC, child);
    return shape;
  }
  /// The Shape that was saved as this compound; null if it was not saved by a Shape.
  Shape* restoredPart(const btCollisionShapeData& saved, const btCompoundShape& compound) {
    if (!saved.m_name || compound.getNumChildShapes() != 1) return nullptr;
    const btCollisionShape* child = compound.getChildShape(0);
    if (child->getShapeType() != TRIANGLE_MESH_SHAPE_PROXYTYPE) return nullptr;
    Shape*& own = shape_of_[&saved];
    if (own) return own;
    auto made =
        restoreShape(saved.m_name, *static_cast<const btBvhTriangleMeshShape*>(child)->getMeshInterface());
    own = made.get();
    if (made) shapes_.push_back(std::move(made));
    return own;
  }

  std::map<const btCollisionShapeData*, Shape*> shape_of_;
  std::vector<std::unique_ptr<Shape>> shapes_;
};

}  // namespace vps::bullet

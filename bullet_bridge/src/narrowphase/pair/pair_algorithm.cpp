// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_algorithm.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>

#include "solver/contact_stores.h"

namespace vps::bullet {

PairAlgorithm::PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                             const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1)
    : btActivatingCollisionAlgorithm(info, body0, body1),
      shape_{body0->getCollisionShape(), body1->getCollisionShape()},
      type_{shape_[0]->getShapeType(), shape_[1]->getShapeType()} {}

bool PairAlgorithm::isFor(const btCollisionShape* shape0, const btCollisionShape* shape1) const {
  return shape0 == shape_[0] && shape1 == shape_[1] && shape0->getShapeType() == type_[0] &&
         shape1->getShapeType() == type_[1];
}

namespace {

const btCollisionShape* shapeOf(const btBroadphaseProxy* proxy) {
  return static_cast<const btCollisionObject*>(proxy->m_clientObject)->getCollisionShape();
}

// GImpact registers itself for all types, which may happen after install().
void restoreFunction(btCollisionDispatcher& dispatcher, int type0, int type1) {
  ContactCreateFunction* ours = contactFunctionOf(&dispatcher);
  if (!ours) return;
  const auto isGImpact = [](btCollisionAlgorithmCreateFunc* function) {
    return dynamic_cast<btGImpactCollisionAlgorithm::CreateFunc*>(function) != nullptr;
  };
  if (isGImpact(DispatchTable::contact(dispatcher)[type0][type1]))
    dispatcher.registerCollisionCreateFunc(type0, type1, ours);
  if (isGImpact(DispatchTable::closest(dispatcher)[type0][type1]))
    dispatcher.registerClosestPointsCreateFunc(type0, type1, ours);
}

}  // namespace

void renewIfSwapped(btBroadphasePair& pair, btCollisionDispatcher& dispatcher) {
  const btCollisionShape *shape0 = shapeOf(pair.m_pProxy0), *shape1 = shapeOf(pair.m_pProxy1);
  const int type0 = shape0->getShapeType(), type1 = shape1->getShapeType();
  const bool has_shape = type0 == kShapeType || type1 == kShapeType;
  if (has_shape && (type0 == GIMPACT_SHAPE_PROXYTYPE || type1 == GIMPACT_SHAPE_PROXYTYPE))
    restoreFunction(dispatcher, type0, type1);
  if (!pair.m_algorithm) return;
  if (const auto* ours = dynamic_cast<const PairAlgorithm*>(pair.m_algorithm)) {
    if (ours->isFor(shape0, shape1)) return;
  } else if (!has_shape ||
             DispatchTable::contact(dispatcher)[type0][type1] != contactFunctionOf(&dispatcher)) {
    return;  // an algorithm of Bullet, or of a function that the user registered
  }
  pair.m_algorithm->~btCollisionAlgorithm();
  dispatcher.freeCollisionAlgorithm(pair.m_algorithm);
  pair.m_algorithm = nullptr;
}

}  // namespace vps::bullet

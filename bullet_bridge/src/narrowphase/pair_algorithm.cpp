// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair_algorithm.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

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

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// A collision algorithm whose contacts can be found before Bullet processes the pair.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>

namespace vps::bullet::inline v0 {

class PairAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  /// Finds the contacts of the coming step: everything in processCollision() except writing manifolds.
  /// Changes only this pair, so that different pairs may be prepared in parallel; processCollision() then
  /// uses the result.
  virtual void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                       const btDispatcherInfo& info) = 0;
  /// Bullet never runs CCD on concave shapes; speculative contacts replace it.
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }

 protected:
  using btActivatingCollisionAlgorithm::btActivatingCollisionAlgorithm;
};

}  // namespace vps::bullet::inline v0

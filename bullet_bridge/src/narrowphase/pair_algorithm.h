// SPDX-License-Identifier: BSD-3-Clause
// A collision algorithm whose contacts can be found before Bullet processes the pair.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>

class btCollisionShape;

namespace vps::bullet {

class PairAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  /// True if the pair was made for these shapes. A body's shape may be swapped while its pairs exist; another
  /// shape at the address of a deleted one is told by its type, and a Shape also by its revision().
  [[nodiscard]] bool isFor(const btCollisionShape* shape0, const btCollisionShape* shape1) const;

  /// Finds the contacts of the coming step: everything in processCollision() except writing manifolds.
  /// Changes only this pair, so that different pairs may be prepared in parallel; processCollision() then
  /// uses the result. Nothing by default.
  virtual void prepare(const btCollisionObjectWrapper* /*body0*/, const btCollisionObjectWrapper* /*body1*/,
                       const btDispatcherInfo& /*info*/) {}
  /// Bullet never runs CCD on concave shapes; speculative contacts replace it.
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }

 protected:
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
                const btCollisionObjectWrapper* body1);

 private:
  const btCollisionShape* shape_[2];
  int type_[2];
};

}  // namespace vps::bullet

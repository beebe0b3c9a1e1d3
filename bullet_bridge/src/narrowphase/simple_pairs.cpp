// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/simple_pairs.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>

namespace vps::bullet::inline v0 {

static_assert(sizeof(CompoundPair) <= sizeof(btConvexConcaveCollisionAlgorithm));

CompoundPair::CompoundPair(const btCollisionAlgorithmConstructionInfo& info,
                           const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1)
    : PairAlgorithm(info, body0, body1),
      inner_(std::make_unique<btCompoundCollisionAlgorithm>(info, body0, body1,
                                                            body1->getCollisionShape()->isCompound())) {}

CompoundPair::~CompoundPair() = default;

void CompoundPair::processCollision(const btCollisionObjectWrapper* body0,
                                    const btCollisionObjectWrapper* body1, const btDispatcherInfo& info,
                                    btManifoldResult* result) {
  inner_->processCollision(body0, body1, info, result);
}

void CompoundPair::getAllContactManifolds(btManifoldArray& manifolds) {
  inner_->getAllContactManifolds(manifolds);
}

}  // namespace vps::bullet::inline v0

// SPDX-License-Identifier: BSD-3-Clause
// The pairs of a Shape in which it has no contact itself: with a compound, and with what it cannot meet.
#pragma once

#include <memory>

#include "narrowphase/pair_algorithm.h"

namespace vps::bullet::inline v0 {

/// A Shape and a compound: Bullet's own algorithm, which visits the children one by one.
class CompoundPair final : public PairAlgorithm {
 public:
  CompoundPair(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
               const btCollisionObjectWrapper* body1);
  ~CompoundPair() override;
  void prepare(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
               const btDispatcherInfo&) override {}
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  std::unique_ptr<btCollisionAlgorithm> inner_;
};

/// No contact: with an empty shape, or where contact was refused.
class EmptyPair final : public PairAlgorithm {
 public:
  EmptyPair(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
            const btCollisionObjectWrapper* body1)
      : PairAlgorithm(info, body0, body1) {}
  void prepare(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
               const btDispatcherInfo&) override {}
  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo&, btManifoldResult*) override {}
  void getAllContactManifolds(btManifoldArray&) override {}
};

}  // namespace vps::bullet::inline v0

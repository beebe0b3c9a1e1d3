// SPDX-License-Identifier: BSD-3-Clause
// The pair of a Shape with what it cannot meet.
#pragma once

#include "narrowphase/pair_algorithm.h"

namespace vps::bullet {

/// No contact: with an empty shape, or where contact was refused.
class EmptyPair final : public PairAlgorithm {
 public:
  EmptyPair(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
            const btCollisionObjectWrapper* body1)
      : PairAlgorithm(info, body0, body1) {}
  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo&, btManifoldResult*) override {}
  void getAllContactManifolds(btManifoldArray&) override {}
};

}  // namespace vps::bullet

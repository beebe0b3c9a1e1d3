// SPDX-License-Identifier: BSD-3-Clause
// Narrow phase for pairs of a Shape with a shape that a NativeShape stands in for.
#pragma once

#include <memory>

#include "vps_bullet/algorithm.h"

namespace vps::bullet {

class NativeShape;

/// Algorithm with one side's shape replaced by its stand-in. Renews the stand-in when the shape's key
/// changes (scaled, resized, refitted); the contacts' impulses are then forgotten.
class NativeShapeAlgorithm final : public PairAlgorithm {
 public:
  /// @param native_side  0 or 1: whose shape is replaced. Throws as NativeShapeCache::get().
  NativeShapeAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                       const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                       std::shared_ptr<Context> context, int native_side);
  ~NativeShapeAlgorithm() override;

  /// Does nothing where the stand-in must be renewed: that is left to processCollision(), one pair at a time.
  void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
               const btDispatcherInfo& info) override;
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  struct State;
  // Behind a pointer: Bullet's algorithm pool has elements of a fixed size that it does not check in Release.
  std::unique_ptr<State> state_;
};

}  // namespace vps::bullet

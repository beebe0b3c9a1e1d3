// SPDX-License-Identifier: BSD-3-Clause
// Narrow phase for pairs of a Shape with one of Bullet's own shapes that needs a NativeShapeAdapter.
#pragma once

#include <memory>

#include "narrowphase/pair_algorithm.h"

namespace vps::bullet {

struct Context;

/// ContactAlgorithm with the shape of one side replaced by its adapter. Builds the adapter again when the
/// shape's key changes (scaled, resized, refitted); the impulses of its contacts are then dropped.
class NativeShapeAlgorithm final : public PairAlgorithm {
 public:
  /// @param native_side  0 or 1: whose shape is replaced. Throws as NativeShapeCache::get().
  NativeShapeAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                       const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                       std::shared_ptr<Context> context, int native_side);
  ~NativeShapeAlgorithm() override;

  /// Does nothing where the adapter must be built again: processCollision() does that, one pair at a time.
  void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
               const btDispatcherInfo& info) override;
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  struct State;
  // Behind a pointer: elements of Bullet's algorithm pool have a fixed size, which Release does not check.
  std::unique_ptr<State> state_;
};

}  // namespace vps::bullet

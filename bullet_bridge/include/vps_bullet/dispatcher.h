// SPDX-License-Identifier: BSD-3-Clause
// A dispatcher that looks at many pairs of parts at once.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>

#include "vps_bullet/export.h"

namespace vps::bullet {

/// Drop-in for btCollisionDispatcher: before Bullet goes through the pairs one by one, the contacts of those
/// of two bodies with VpsAlgorithms are chosen by several threads. The same bits as with the stock
/// dispatcher, for any number of threads, and nothing in Bullet need be thread-safe: manifolds and callbacks
/// are served in Bullet's own order, by the calling thread. A pair that is new in this step, and children of
/// compounds, wait for their turn.
class VPS_BULLET_API Dispatcher : public btCollisionDispatcher {
 public:
  /// @param threads  at least 1; 0: one for each core
  explicit Dispatcher(btCollisionConfiguration* config, int threads = 0);
  ~Dispatcher() override;

  void dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// A dispatcher that processes many pairs of parts in parallel.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <memory>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

/// Drop-in for btCollisionDispatcher: several threads find the contacts of all pairs with VPS contact before
/// Bullet visits the pairs one by one. Results have the same bits as with the stock dispatcher, for any
/// number of threads, and nothing in Bullet needs to be thread-safe: manifolds and callbacks are processed by
/// the calling thread, in Bullet's own order. Pairs that are new in this step, and children of compounds, are
/// computed one by one when Bullet visits them.
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

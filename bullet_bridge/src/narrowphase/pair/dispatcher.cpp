// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/dispatcher.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <stdexcept>
#include <vector>

#include "narrowphase/pair/pair_algorithm.h"

namespace vps::bullet {

struct Dispatcher::Arena {
  tbb::task_arena arena;
  std::vector<btBroadphasePair*> pairs;
};

Dispatcher::Dispatcher(btCollisionConfiguration* config, int threads)
    : btCollisionDispatcher(config), arena_(std::make_unique<Arena>()) {
  if (threads < 0) throw std::invalid_argument("Dispatcher: threads must be 0 (one for each core) or more");
  arena_->arena.initialize(threads == 0 ? tbb::task_arena::automatic : threads);
}

Dispatcher::~Dispatcher() = default;

void Dispatcher::dispatchAllCollisionPairs(btOverlappingPairCache* pairs, const btDispatcherInfo& info,
                                           btDispatcher* dispatcher) {
  const auto objectOf = [](const btBroadphaseProxy* proxy) {
    return static_cast<btCollisionObject*>(proxy->m_clientObject);
  };
  arena_->pairs.clear();
  for (int i = 0; i < pairs->getNumOverlappingPairs(); ++i) {
    btBroadphasePair& pair = pairs->getOverlappingPairArrayPtr()[i];
    renewIfSwapped(pair, *this);
    if (dynamic_cast<PairAlgorithm*>(pair.m_algorithm) == nullptr) continue;
    if (needsCollision(objectOf(pair.m_pProxy0), objectOf(pair.m_pProxy1))) arena_->pairs.push_back(&pair);
  }
  const bool is_step = info.m_dispatchFunc == btDispatcherInfo::DISPATCH_DISCRETE;
  if (is_step && arena_->pairs.size() > 1)
    arena_->arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, arena_->pairs.size(), [&](std::size_t i) {
        const btBroadphasePair& pair = *arena_->pairs[i];
        const btCollisionObject *a = objectOf(pair.m_pProxy0), *b = objectOf(pair.m_pProxy1);
        const btCollisionObjectWrapper body0(nullptr, a->getCollisionShape(), a, a->getWorldTransform(), -1,
                                             -1),
            body1(nullptr, b->getCollisionShape(), b, b->getWorldTransform(), -1, -1);
        dynamic_cast<PairAlgorithm*>(pair.m_algorithm)->prepare(&body0, &body1, info);
      });
    });
  btCollisionDispatcher::dispatchAllCollisionPairs(pairs, info, dispatcher);
}

}  // namespace vps::bullet

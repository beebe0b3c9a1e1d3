// SPDX-License-Identifier: BSD-3-Clause
#include "install/probe.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btPoolAllocator.h>
#include <LinearMath/btThreads.h>

#include <stdexcept>
#include <string>

#include "vps_bullet/precision.h"

namespace vps::bullet {

namespace {

// The size that the library's compiled code gives a manifold. Neither the configuration nor its pool has a
// member whose size depends on the precision, so that asking is safe.
int manifoldBytesOfLibrary() {
  btDefaultCollisionConstructionInfo small;
  small.m_defaultMaxPersistentManifoldPoolSize = 1;
  small.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  btDefaultCollisionConfiguration configuration(small);
  return configuration.getPersistentManifoldPool()->getElementSize();
}

[[noreturn]] void refuse(const char* whose, int theirs) {
  const bool is_double = VPS_BULLET_SCALAR_BYTES == 8;
  std::string words = "install: ";
  words.append(whose)
      .append(" a manifold of ")
      .append(std::to_string(theirs))
      .append(" bytes, and this package one of ");
  words.append(std::to_string(sizeof(btPersistentManifold)));
  words.append(": it is Bullet in another precision. vps::bullet was built for ")
      .append(is_double ? "double" : "single");
  words.append(
      is_double
          ? " precision; link LinearMath-float64, BulletCollision-float64 and BulletDynamics-float64 and no "
            "other of Bullet's libraries, or build vps with VPS_BULLET_DOUBLE=OFF"
          : " precision; link Bullet's libraries without -float64, or build vps with VPS_BULLET_DOUBLE=ON");
  throw std::invalid_argument(words);
}

}  // namespace

void requireSamePrecision(const btCollisionDispatcher& dispatcher) {
  constexpr int kOurs = static_cast<int>(sizeof(btPersistentManifold));
  static const int library = manifoldBytesOfLibrary();
  if (library != kOurs) refuse("Bullet's library has", library);
  // A host may give a pool of its own, with larger elements.
  const int pool = dispatcher.getInternalManifoldPool()->getElementSize();
  if (pool < kOurs) refuse("the dispatcher's pool has", pool);
}

void requireOneThread(const btCollisionDispatcher& dispatcher) {
  const btITaskScheduler* scheduler = btGetTaskScheduler();
  if (!dynamic_cast<const btCollisionDispatcherMt*>(&dispatcher) || !scheduler ||
      scheduler->getNumThreads() < 2)
    return;
  throw std::invalid_argument(
      "install: btCollisionDispatcherMt with several threads gives manifolds in another order in each run, "
      "so that "
      "no two runs would have the same bits. Use vps::bullet::Dispatcher (vps_bullet/dispatcher.h), which "
      "finds the "
      "contacts of VPS parts in parallel with the bits of one thread, or set a task scheduler of one thread");
}

}  // namespace vps::bullet

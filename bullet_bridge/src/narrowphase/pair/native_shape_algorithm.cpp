// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_algorithm.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>

#include <stdexcept>

#include "log/report.h"
#include "narrowphase/pair/pair_state.h"
#include "native_shapes/native_shape_adapter.h"

namespace vps::bullet {

static_assert(sizeof(NativeShapeAlgorithm) <= sizeof(btConvexConcaveCollisionAlgorithm));

namespace {

/// Both bodies, with the adapter in place of the native shape.
struct AdaptedBodies {
  btCollisionObjectWrapper replaced;
  const btCollisionObjectWrapper* wrapper[2];
  AdaptedBodies(const NativeShapeAdapter& adapter, int side, const btCollisionObjectWrapper* body0,
                const btCollisionObjectWrapper* body1)
      : AdaptedBodies(adapter, *(side == 0 ? body0 : body1), body0, body1) {
    wrapper[side] = &replaced;
  }

 private:
  AdaptedBodies(const NativeShapeAdapter& adapter, const btCollisionObjectWrapper& native,
                const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1)
      : replaced(native.m_parent, &adapter, native.m_collisionObject, native.getWorldTransform(),
                 native.m_partId, native.m_index),
        wrapper{body0, body1} {}
};

}  // namespace

struct NativeShapeAlgorithm::State {
  std::shared_ptr<Context> context;
  int native_side = 0;
  ShapeKey key;
  std::shared_ptr<const NativeShapeAdapter> adapter;  // null if the shape has become one without contact
  std::unique_ptr<ContactAlgorithm> inner;

  void renew(btDispatcher& dispatcher, const btCollisionObjectWrapper* const (&bodies)[2]) {
    const btCollisionShape& shape = *bodies[native_side]->getCollisionShape();
    key = keyOf(shape);
    inner.reset();
    adapter = context->native_shapes->get(shape);
    const AdaptedBodies adapted(*adapter, native_side, bodies[0], bodies[1]);
    btCollisionAlgorithmConstructionInfo info(&dispatcher, 0);
    inner = std::make_unique<ContactAlgorithm>(info, adapted.wrapper[0], adapted.wrapper[1], context);
  }
  // Reports errors instead of throwing, since Bullet's step is not exception-safe.
  void renewOrReport(btDispatcher& dispatcher, const btCollisionObjectWrapper* const (&bodies)[2]) {
    if (key == keyOf(*bodies[native_side]->getCollisionShape())) return;
    try {
      renew(dispatcher, bodies);
    } catch (const std::exception& error) {
      adapter.reset();
      report(LogLevel::Error, error.what());
    }
  }
};

NativeShapeAlgorithm::NativeShapeAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                                           const btCollisionObjectWrapper* body0,
                                           const btCollisionObjectWrapper* body1,
                                           std::shared_ptr<Context> context, int native_side)
    : PairAlgorithm(info, body0, body1), state_(std::make_unique<State>()) {
  state_->context = std::move(context);
  state_->native_side = native_side;
  state_->renew(*m_dispatcher, {body0, body1});
}

NativeShapeAlgorithm::~NativeShapeAlgorithm() = default;

void NativeShapeAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  if (state_->inner) state_->inner->getAllContactManifolds(manifolds);
}

void NativeShapeAlgorithm::prepare(const btCollisionObjectWrapper* body0,
                                   const btCollisionObjectWrapper* body1, const btDispatcherInfo& info) {
  const btCollisionObjectWrapper* native = state_->native_side == 0 ? body0 : body1;
  if (!state_->adapter || state_->key != keyOf(*native->getCollisionShape())) return;
  const AdaptedBodies bodies(*state_->adapter, state_->native_side, body0, body1);
  state_->inner->prepare(bodies.wrapper[0], bodies.wrapper[1], info);
}

void NativeShapeAlgorithm::processCollision(const btCollisionObjectWrapper* body0,
                                            const btCollisionObjectWrapper* body1,
                                            const btDispatcherInfo& info, btManifoldResult* result) {
  state_->renewOrReport(*m_dispatcher, {body0, body1});
  if (!state_->adapter) return;
  const AdaptedBodies bodies(*state_->adapter, state_->native_side, body0, body1);
  state_->inner->processCollision(bodies.wrapper[0], bodies.wrapper[1], info, result);
}

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// The collision algorithms that Bullet calls for pairs of bodies with a Shape.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>

#include <memory>

class btCollisionDispatcher;
class btCollisionShape;
struct btBroadphasePair;

namespace vps::bullet {

struct Context;
struct PairState;

class PairAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  /// True if the pair was made for these shapes. A body's shape may be swapped while its pairs exist. Another
  /// shape at the address of a deleted one is recognised by its type, and a Shape also by its revision().
  [[nodiscard]] bool isFor(const btCollisionShape* shape0, const btCollisionShape* shape1) const;

  /// Finds the contacts of the coming step: everything in processCollision() except writing manifolds.
  /// Changes only this pair, so that different pairs may be prepared in parallel; processCollision() then
  /// uses the result. Does nothing by default.
  virtual void prepare(const btCollisionObjectWrapper* /*body0*/, const btCollisionObjectWrapper* /*body1*/,
                       const btDispatcherInfo& /*info*/) {}
  /// Bullet never runs CCD on concave shapes; speculative contacts replace it.
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }

 protected:
  PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
                const btCollisionObjectWrapper* body1);

 private:
  const btCollisionShape* shape_[2];
  int type_[2];
};

/// Contact of two Shapes, or of a Shape and one of Bullet's analytic shapes (isPrimitive()).
///
///   1. Find candidates: points of each side that can touch the other within the step, and crossings of edges
///      (speculative contact: the distance may be > 0).
///   2. Reduce the candidates to about contact_limit that keep depth, extent and directions; contacts of the
///      last step are preferred.
///   3. Refine distance and normal by the exact surfaces.
///   4. Write the contacts into as many manifolds of four as needed, each contact with its impulse of the
///      last step.
///
/// Manifold points are written directly: addContactPoint would merge neighbours nearer than the breaking
/// threshold. gContactAddedCallback and the contact-stiffness flags still work. m_index0/m_index1 hold the
/// point's id in the shell of body 0/1 (-1 on the side that has the map), or, at a crossing, the edge of each
/// body.
class ContactAlgorithm final : public PairAlgorithm {
 public:
  ContactAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
                   const btCollisionObjectWrapper* body1, std::shared_ptr<Context> context);
  ~ContactAlgorithm() override;

  void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
               const btDispatcherInfo& info) override;
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  // Held by pointer, since elements of Bullet's algorithm pool have a fixed size, which Release builds do not
  // check.
  std::unique_ptr<PairState> state_;
};

/// ContactAlgorithm with the shape of one side replaced by its adapter. Builds the adapter again when the
/// shape's key changes (scaled, resized, refitted); the impulses of its contacts are then dropped.
class NativeShapeAlgorithm final : public PairAlgorithm {
 public:
  /// @param native_side  0 or 1: the body whose shape is replaced by its adapter. Throws as
  ///   NativeShapeCache::get().
  NativeShapeAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                       const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                       std::shared_ptr<Context> context, int native_side);
  ~NativeShapeAlgorithm() override;

  /// Does nothing if the adapter must be built again; processCollision() builds it, one pair at a time.
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

/// True for a Shape, and for a compound that contains a Shape at any depth.
bool containsShape(const btCollisionShape& shape);

/// Runs, for each child of a compound and the other body, the algorithm that the dispatcher has for them.
///
/// Bullet's own algorithm for compounds visits a child when its box touches the other body's. Such a visit is
/// too late for speculative contact: a part that falls at 0.6 m/s was found only when it was up to a step's
/// travel deep (0.4 mm at 1 kHz, 7 mm at 60 Hz). CompoundPair visits a child when it can touch within the
/// step.
class CompoundPair final : public PairAlgorithm {
 public:
  CompoundPair(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
               const btCollisionObjectWrapper* body1, std::shared_ptr<Context> context);
  ~CompoundPair() override;
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  struct State;
  // Behind a pointer: elements of Bullet's algorithm pool have a fixed size, which Release does not check.
  std::unique_ptr<State> state_;
};

/// A pair without contact: with an empty shape, or with a shape for which contact was refused.
class EmptyPair final : public PairAlgorithm {
 public:
  EmptyPair(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
            const btCollisionObjectWrapper* body1)
      : PairAlgorithm(info, body0, body1) {}
  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                        const btDispatcherInfo&, btManifoldResult*) override {}
  void getAllContactManifolds(btManifoldArray&) override {}
};

/// Frees a pair's algorithm if it was made for other shapes, before install(), or by a function that GImpact
/// registered in place of that of install(), so that Bullet makes a new one. Bullet itself keeps the
/// algorithm while the bodies are near each other, whatever shapes they get. Does nothing for pairs without a
/// Shape, and without an installation.
void renewIfSwapped(btBroadphasePair& pair, btCollisionDispatcher& dispatcher);

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// Bullet's narrow phase for pairs with a Shape: candidates from the voxmaps, a few contacts for the solver.
#pragma once

#include <memory>

#include "narrowphase/pair_algorithm.h"

namespace vps::bullet {

struct PairState;
struct Context;

/// Contact of two Shapes, or of a Shape and one of Bullet's analytic shapes (isPrimitive()).
///
///   1. Find candidates: points of each side that can touch the other within the step, and crossings of edges
///      (speculative contact: the distance may be > 0).
///   2. Reduce them to about contact_limit that keep depth, extent and directions, preferring last step's.
///   3. Refine distance and normal by the exact surfaces.
///   4. Write them into as many manifolds of four as needed, each contact with its impulse of the last step.
///
/// Manifold points are written directly: addContactPoint would merge neighbours nearer than the breaking
/// threshold. gContactAddedCallback and the contact-stiffness flags are served nevertheless.
/// m_index0/m_index1 hold the point's id in the shell of body 0/1 (-1 on the side that has the map), or, at a
/// crossing, the edge of each body.
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
  // Behind a pointer: elements of Bullet's algorithm pool have a fixed size, which Release does not check.
  std::unique_ptr<PairState> state_;
};

}  // namespace vps::bullet

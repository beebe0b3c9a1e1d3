// SPDX-License-Identifier: BSD-3-Clause
// Bullet's narrow phase for pairs with a Shape: candidates from the voxmaps, a few contacts for the
// solver.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

#include <memory>

#include "vps_bullet/export.h"
#include "vps_bullet/install.h"

namespace vps::bullet {

struct PairState;
struct Context;

/// A pair whose contacts can be chosen beside those of others.
class VPS_BULLET_API PairAlgorithm : public btActivatingCollisionAlgorithm {
 public:
  /// Chooses the contacts of the coming step: all of processCollision() but what goes into manifolds. Touches
  /// the pair alone, so that different pairs may be prepared at once; processCollision() then takes what is
  /// ready.
  virtual void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                       const btDispatcherInfo& info) = 0;
  /// CCD never runs on concave shapes; speculative contacts take its place.
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }

 protected:
  using btActivatingCollisionAlgorithm::btActivatingCollisionAlgorithm;
};

/// Contact of two VpsShapes, or of a Shape and one of Bullet's plane, box, sphere, capsule and cylinder.
///
///   1. query: crossings of edges, and points of each side that can touch the other within the step
///   (speculative contact: distance may be > 0)
///   2. reduce to contact_limit contacts that keep depth, extent and directions, preferring last step's
///   3. correct them by the exact surfaces
///   4. write them into as many manifolds of four as needed, each with the impulses it had last step
///
/// Manifold points are written directly: addContactPoint would merge neighbours nearer than the breaking
/// threshold. gContactAddedCallback and the contact-stiffness flags are served all the same.
/// m_index0/m_index1 hold the point's id in the shell of body 0/1 (-1 on the side that has the map), or,
/// where edges cross, each body's edge.
class VPS_BULLET_API Algorithm final : public PairAlgorithm {
 public:
  Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
            const btCollisionObjectWrapper* body1, std::shared_ptr<Context> context);
  ~Algorithm() override;

  void prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
               const btDispatcherInfo& info) override;
  void processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  void getAllContactManifolds(btManifoldArray& manifolds) override;

 private:
  // Behind a pointer: Bullet's algorithm pool has elements of a fixed size that it does not check in Release.
  std::unique_ptr<PairState> state_;
};

}  // namespace vps::bullet

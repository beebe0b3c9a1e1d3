// SPDX-License-Identifier: BSD-3-Clause
// Writes a pair's contacts into Bullet's manifolds and remembers their impulses by id.
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <span>
#include <vector>

#include "narrowphase/contact_candidate.h"

class btDispatcher;
class btCollisionObject;
class btManifoldResult;
struct btCollisionObjectWrapper;

namespace vps::bullet {

/// Candidate::key() of a contact we wrote: the side with the shell has the point's id as its index, the other
/// -1; of a crossing each has its edge's.
std::uint64_t keyOf(const btManifoldPoint& point);

class ManifoldWriter {
 public:
  ManifoldWriter(btDispatcher& dispatcher, const btCollisionObject* object0,
                 const btCollisionObject* object1);
  ~ManifoldWriter();
  ManifoldWriter(const ManifoldWriter&) = delete;
  ManifoldWriter& operator=(const ManifoldWriter&) = delete;

  /// Marks the candidates that were contacts in the manifolds as they stand, with their impulses.
  void recall(std::vector<Candidate>& candidates);
  /// Replaces all contacts. Points that stay keep impulses, lifetime and user data.
  void write(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
             const RelativeMotion& motion);
  /// Ids now mean other points: nothing of last step's contacts passes to the next.
  void forget();
  void append(btAlignedObjectArray<btPersistentManifold*>& manifolds) const;
  [[nodiscard]] std::span<btPersistentManifold* const> manifolds() const { return manifolds_; }

 private:
  struct Old {
    std::uint64_t key;
    btManifoldPoint point;
  };
  void harvest();

  btDispatcher& dispatcher_;
  const btCollisionObject* objects_[2];
  std::vector<btPersistentManifold*> manifolds_;
  std::vector<Old> old_;  // last step's points, ascending by key
};

/// Hands contacts to a contactTest's result, one by one.
void reportToQuery(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
                   btManifoldResult& result);

}  // namespace vps::bullet

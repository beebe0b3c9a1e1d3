// SPDX-License-Identifier: BSD-3-Clause
// Writes a pair's contacts into Bullet's manifolds and keeps their impulses by id.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btAlignedObjectArray.h>

#include <span>
#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "narrowphase/pair/pair_view.h"

class btCollisionObject;
class btDispatcher;
class btManifoldResult;
struct btCollisionObjectWrapper;

namespace vps::bullet {

// Bits of m_contactPointFlags above Bullet's own: gContactAddedCallback was called for the point; the
// callback set friction directions; the callback set a normal; the callback set the coefficient of friction.
constexpr int kWasAdded = 1 << 25, kOwnDirections = 1 << 26, kOwnNormal = 1 << 27, kOwnFriction = 1 << 30;

/// Positions of a contact on both bodies: the shell point, and the nearest point of the other body's surface.
void positions(const Candidate& c, Vec3& on0, Vec3& on1);

/// Index of the shell point, for the side that has it, else -1; for a crossing, index of the side's edge.
int indexOn(const Candidate& c, int side);

/// Makes a manifold point with all values that btManifoldResult::addContactPoint() would set from the bodies,
/// without impulses.
btManifoldPoint makePoint(const Candidate& c, const PairMaterial& material,
                          const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion);

/// Copies the last step's impulses to a point, in the point's friction directions.
void copyImpulses(btManifoldPoint& point, const btManifoldPoint& old);

/// Copies to a point the values that the user's callback set in an earlier step, if the callback is not
/// called again.
void keepMaterial(btManifoldPoint& point, const btManifoldPoint& old);

class ManifoldWriter {
 public:
  /// @param friction_model  must outlive the writer
  ManifoldWriter(btDispatcher& dispatcher, const btCollisionObject* object0, const btCollisionObject* object1,
                 const FrictionModel& friction_model);
  ~ManifoldWriter();
  ManifoldWriter(const ManifoldWriter&) = delete;
  ManifoldWriter& operator=(const ManifoldWriter&) = delete;

  /// Sets was_contact and impulse_Ns of the candidates that are contacts in the present manifolds.
  void markExistingContacts(std::vector<Candidate>& candidates);
  /// Replaces all contacts. Points that remain keep impulses, lifetime and user data. Bullet's callbacks are
  /// called as for a pair with one manifold (see "Callbacks" in contact_callbacks.md).
  /// @param keeps_spare  allocate spare manifolds, so that the solver can add contacts
  void write(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
             const RelativeMotion& motion, bool keeps_spare);
  /// Adds a contact, or replaces the contact that has the same key. Returns null if the manifolds are full.
  /// The pointer is valid until the next write().
  btManifoldPoint* put(const Candidate& contact, const btCollisionObjectWrapper* const (&bodies)[2],
                       const RelativeMotion& motion);
  /// The present contact with this key; null if there is none.
  /// @param place  likely index among the contacts of the last write()
  [[nodiscard]] btManifoldPoint* find(std::uint64_t key, std::size_t place = 0) const;
  /// Sum of the normal impulses of the contacts that the last write() dropped.
  [[nodiscard]] double lostLoad_Ns() const { return lost_load_Ns_; }
  /// Must be called when ids refer to other points: no impulse then passes from old contacts to new ones.
  void invalidateIds();
  void append(btAlignedObjectArray<btPersistentManifold*>& manifolds) const;
  [[nodiscard]] std::span<btPersistentManifold* const> manifolds() const { return manifolds_; }

 private:
  struct Old {
    std::uint64_t key;
    btManifoldPoint point;
  };
  void readManifolds();
  void callAdded(btManifoldPoint& point, const btCollisionObjectWrapper* const (&bodies)[2]) const;
  void callProcessed() const;
  void end();

  btDispatcher& dispatcher_;
  const btCollisionObject* objects_[2];
  const FrictionModel& friction_model_;
  std::vector<btPersistentManifold*> manifolds_;
  std::vector<Old> old_;      // last step's points, ascending by key
  bool has_started_ = false;  // contact has started, and has not ended
  double lost_load_Ns_ = 0;
  std::size_t turn_ = 0;  // counter that selects the manifold whose points are added again in this step
};

/// Passes contacts to a contactTest's result, one by one.
void reportContacts(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
                    btManifoldResult& result);

}  // namespace vps::bullet

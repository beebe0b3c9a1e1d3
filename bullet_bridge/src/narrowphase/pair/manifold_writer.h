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

// Bits of m_contactPointFlags far above Bullet's own: the point was given to gContactAddedCallback, which set
// friction directions, or a normal, of its own.
constexpr int kWasAdded = 1 << 25, kOwnDirections = 1 << 26, kOwnNormal = 1 << 27;

/// Positions on both bodies: the shell point on its own side, its foot on the other's surface.
void positions(const Candidate& c, Vec3& on0, Vec3& on1);

/// Index of the shell point on its own side; at a crossing, of the edge on either side.
int indexOn(const Candidate& c, int side);

/// With all that btManifoldResult::addContactPoint() would set from the bodies, without impulses.
btManifoldPoint makePoint(const Candidate& c, const PairMaterial& material,
                          const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion);

/// Gives a point the last step's impulses, in its own friction directions.
void copyImpulses(btManifoldPoint& point, const btManifoldPoint& old);

/// Gives a point that is not added again what the user's callback has set.
void keepMaterial(btManifoldPoint& point, const btManifoldPoint& old);

class ManifoldWriter {
 public:
  ManifoldWriter(btDispatcher& dispatcher, const btCollisionObject* object0,
                 const btCollisionObject* object1);
  ~ManifoldWriter();
  ManifoldWriter(const ManifoldWriter&) = delete;
  ManifoldWriter& operator=(const ManifoldWriter&) = delete;

  /// Marks the candidates that are contacts in the manifolds as they are now, with their impulses.
  void markExistingContacts(std::vector<Candidate>& candidates);
  /// Replaces all contacts. Points that stay keep impulses, lifetime and user data. Bullet's callbacks are
  /// called as Bullet does for a pair with one manifold (README.md, "Callbacks").
  /// @param keeps_spare  more manifolds than needed, so that the solver can add contacts
  void write(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
             const RelativeMotion& motion, bool keeps_spare);
  /// Adds a contact in a free place, or replaces the one with its key. Null if no place is free. The contact
  /// stays where it is until the next write().
  btManifoldPoint* put(const Candidate& contact, const btCollisionObjectWrapper* const (&bodies)[2],
                       const RelativeMotion& motion);
  /// The contact with this key, as it is now; null if there is none.
  /// @param place  where it probably is: its index among those that write() was given
  [[nodiscard]] btManifoldPoint* find(std::uint64_t key, std::size_t place = 0) const;
  /// Normal impulse of the contacts that the last write() left out.
  [[nodiscard]] double lostLoad_Ns() const { return lost_load_Ns_; }
  /// To be called when ids refer to other points: no impulse passes from the old contacts to new ones.
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
  std::vector<btPersistentManifold*> manifolds_;
  std::vector<Old> old_;      // last step's points, ascending by key
  bool has_started_ = false;  // gContactStartedCallback was due, and gContactEndedCallback is not yet
  double lost_load_Ns_ = 0;
  std::size_t turn_ = 0;  // of the manifold whose points are added again in this step
};

/// Passes contacts to a contactTest's result, one by one.
void reportContacts(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
                    btManifoldResult& result);

}  // namespace vps::bullet

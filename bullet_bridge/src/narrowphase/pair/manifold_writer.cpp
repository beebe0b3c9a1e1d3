// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/manifold_writer.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <utility>

#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

constexpr int kPerManifold = MANIFOLD_CACHE_SIZE;

bool wantsAdded(const btCollisionObject* a, const btCollisionObject* b) {
  const int flags = a->getCollisionFlags() | b->getCollisionFlags();
  return gContactAddedCallback && (flags & btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK) != 0;
}

}  // namespace

ManifoldWriter::ManifoldWriter(btDispatcher& dispatcher, const btCollisionObject* object0,
                               const btCollisionObject* object1, const FrictionModel& friction_model)
    : dispatcher_(dispatcher), objects_{object0, object1}, friction_model_(friction_model) {}

ManifoldWriter::~ManifoldWriter() {
  // Bullet would report the end of contact once per manifold.
  for (btPersistentManifold* manifold : manifolds_) {
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      manifold->clearUserCache(manifold->getContactPoint(i));
    manifold->setNumContacts(0);
  }
  end();
  for (btPersistentManifold* manifold : manifolds_) dispatcher_.releaseManifold(manifold);
}

void ManifoldWriter::append(btAlignedObjectArray<btPersistentManifold*>& manifolds) const {
  for (btPersistentManifold* manifold : manifolds_) manifolds.push_back(manifold);
}

void ManifoldWriter::invalidateIds() {
  // Points without a valid id match no candidate, and the next write() destroys their user data.
  for (btPersistentManifold* manifold : manifolds_)
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      btManifoldPoint& point = manifold->getContactPoint(i);
      point.m_index0 = point.m_index1 = -1;
    }
}

void ManifoldWriter::readManifolds() {
  old_.clear();
  for (const btPersistentManifold* manifold : manifolds_)
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      old_.push_back({keyOf(manifold->getContactPoint(i)), manifold->getContactPoint(i)});
  // The points are usually in ascending order of their keys already, and sorting them is expensive.
  const auto isBefore = [](const Old& a, const Old& b) { return a.key < b.key; };
  if (!std::is_sorted(old_.begin(), old_.end(), isBefore)) std::sort(old_.begin(), old_.end(), isBefore);
}

void ManifoldWriter::markExistingContacts(std::vector<Candidate>& candidates) {
  readManifolds();
  if (old_.empty()) return;
  for (Candidate& c : candidates) {
    const auto it = std::lower_bound(old_.begin(), old_.end(), c.key(),
                                     [](const Old& old, std::uint64_t key) { return old.key < key; });
    if (it == old_.end() || it->key != c.key()) continue;
    c.was_contact = true;
    c.impulse_Ns = it->point.m_appliedImpulse;
  }
}

void ManifoldWriter::write(std::span<const Candidate> contacts,
                           const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion,
                           bool keeps_spare) {
  readManifolds();
  const std::size_t used = (contacts.size() + kPerManifold - 1) / kPerManifold;
  // Assumed: a pair with many contacts may lack more contacts.
  const std::size_t manifold_count = keeps_spare ? used + 4 + used / 2 : used;
  while (manifolds_.size() < manifold_count) {
    btPersistentManifold* manifold = dispatcher_.getNewManifold(objects_[0], objects_[1]);
    if (!manifold) break;  // the pool is full and may not grow
    manifolds_.push_back(manifold);
  }
  const bool is_custom = wantsAdded(objects_[0], objects_[1]);
  const PairMaterial material(bodies, friction_model_);
  // Bullet's own algorithms call the added callback again for up to four points in each step and keep the
  // other points' values. Here the points of one manifold per step are added again, each manifold in turn.
  const std::size_t added_again = used > 0 ? turn_++ % used : 0;
  lost_load_Ns_ = 0;
  for (const Old& had : old_) lost_load_Ns_ += had.point.m_appliedImpulse;
  std::vector<Old>::iterator old = old_.begin();
  for (std::size_t m = 0; m < manifolds_.size(); ++m) {
    btPersistentManifold& manifold = *manifolds_[m];
    const std::size_t first = m * kPerManifold;
    const int count = first < contacts.size()
                          ? static_cast<int>(std::min<std::size_t>(kPerManifold, contacts.size() - first))
                          : 0;
    manifold.setNumContacts(0);
    for (int i = 0; i < count; ++i) {
      manifold.setNumContacts(i + 1);
      const Candidate& c = contacts[first + static_cast<std::size_t>(i)];
      btManifoldPoint& point = manifold.getContactPoint(i);
      point = makePoint(c, material, bodies, motion);
      while (old != old_.end() && old->key < c.key()) ++old;  // both lists are ascending by key
      bool is_kept = false;
      if (old != old_.end() && old->key == c.key()) {
        copyImpulses(point, old->point);
        lost_load_Ns_ -= point.m_appliedImpulse;
        is_kept = m != added_again && (old->point.m_contactPointFlags & kWasAdded) != 0;
        if (is_custom && is_kept) keepMaterial(point, old->point);
        old->point.m_userPersistentData = nullptr;
      }
      if (is_custom && !is_kept) callAdded(point, bodies);
      point.m_contactPointFlags |= kWasAdded;
      if (!std::exchange(has_started_, true) && gContactStartedCallback) gContactStartedCallback(&manifold);
    }
  }
  for (Old& gone : old_)
    if (gone.point.m_userPersistentData && gContactDestroyedCallback)
      gContactDestroyedCallback(gone.point.m_userPersistentData);
  if (contacts.empty()) end();
  callProcessed();
}

void ManifoldWriter::callAdded(btManifoldPoint& point,
                               const btCollisionObjectWrapper* const (&bodies)[2]) const {
  const btVector3 normal = point.m_normalWorldOnB;
  const btVector3 directions[2] = {point.m_lateralFrictionDir1, point.m_lateralFrictionDir2};
  const btScalar friction = point.m_combinedFriction;
  gContactAddedCallback(point, bodies[0], point.m_partId0, point.m_index0, bodies[1], point.m_partId1,
                        point.m_index1);
  if (point.m_normalWorldOnB != normal) point.m_contactPointFlags |= kOwnNormal;
  if (point.m_lateralFrictionDir1 != directions[0] || point.m_lateralFrictionDir2 != directions[1])
    point.m_contactPointFlags |= kOwnDirections;
  if (point.m_combinedFriction != friction) point.m_contactPointFlags |= kOwnFriction;
}

void ManifoldWriter::callProcessed() const {
  if (!gContactProcessedCallback) return;
  for (btPersistentManifold* manifold : manifolds_)
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      gContactProcessedCallback(manifold->getContactPoint(i), const_cast<btCollisionObject*>(objects_[0]),
                                const_cast<btCollisionObject*>(objects_[1]));
}

void ManifoldWriter::end() {
  if (std::exchange(has_started_, false) && gContactEndedCallback && !manifolds_.empty())
    gContactEndedCallback(manifolds_.front());
}

btManifoldPoint* ManifoldWriter::put(const Candidate& contact,
                                     const btCollisionObjectWrapper* const (&bodies)[2],
                                     const RelativeMotion& motion) {
  const PairMaterial material(bodies, friction_model_);
  if (btManifoldPoint* had = find(contact.key())) {
    const btManifoldPoint old = *had;
    *had = makePoint(contact, material, bodies, motion);
    copyImpulses(*had, old);
    return had;
  }
  const auto free = std::find_if(manifolds_.begin(), manifolds_.end(), [](const btPersistentManifold* m) {
    return m->getNumContacts() < kPerManifold;
  });
  if (free == manifolds_.end()) return nullptr;
  const int i = (*free)->getNumContacts();
  (*free)->setNumContacts(i + 1);
  return &((*free)->getContactPoint(i) = makePoint(contact, material, bodies, motion));
}

btManifoldPoint* ManifoldWriter::find(std::uint64_t key, std::size_t place) const {
  if (const std::size_t m = place / kPerManifold; m < manifolds_.size()) {
    const int i = static_cast<int>(place % kPerManifold);
    if (i < manifolds_[m]->getNumContacts() && keyOf(manifolds_[m]->getContactPoint(i)) == key)
      return &manifolds_[m]->getContactPoint(i);
  }
  for (btPersistentManifold* manifold : manifolds_)
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      if (keyOf(manifold->getContactPoint(i)) == key) return &manifold->getContactPoint(i);
  return nullptr;
}

void reportContacts(std::span<const Candidate> contacts, const btCollisionObjectWrapper* const (&bodies)[2],
                    btManifoldResult& result) {
  // Bullet's query results read the order of the bodies from a manifold, and a query has none of its own.
  btPersistentManifold order(bodies[0]->getCollisionObject(), bodies[1]->getCollisionObject(), 0,
                             BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  btPersistentManifold* before = result.getPersistentManifold();
  result.setPersistentManifold(&order);
  for (const Candidate& c : contacts) {
    Vec3 on0, on1;
    positions(c, on0, on1);
    result.setShapeIdentifiersA(c.surface[0], indexOn(c, 0));
    result.setShapeIdentifiersB(c.surface[1], indexOn(c, 1));
    result.addContactPoint(toBt(c.n_W), toBt(on1), toBt(c.distance_m));
  }
  result.setPersistentManifold(before);
}

}  // namespace vps::bullet

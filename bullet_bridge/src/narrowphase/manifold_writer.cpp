// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/manifold_writer.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <utility>

#include "narrowphase/pair_material.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {

namespace {

constexpr int kPerManifold = MANIFOLD_CACHE_SIZE;

// Bits of m_contactPointFlags far above Bullet's own: the point was given to gContactAddedCallback, which set
// friction directions, or a normal, of its own.
constexpr int kWasAdded = 1 << 25, kOwnDirections = 1 << 26, kOwnNormal = 1 << 27;

// Positions on both bodies: the shell point on its own side, its foot on the other's surface.
void positions(const Candidate& c, Vec3& on0, Vec3& on1) {
  on0 = c.side == 0 ? c.p_W : Vec3(c.p_W + c.distance_m * c.n_W);
  on1 = c.side == 1 ? c.p_W : Vec3(c.p_W - c.distance_m * c.n_W);
}

// Index of the shell point on its own side; at a crossing, of the edge on either side.
int indexOn(const Candidate& c, int side) {
  if (c.isCrossing() && side == 1) return static_cast<int>(c.crossed - 1);
  return c.side == side ? static_cast<int>(c.id) : -1;
}

// Along the slip, so that the solver's friction pyramid is exact for a sliding part; for a part at rest,
// along a direction that depends on the normal only, so that it does not turn with noise.
void setFrictionDirections(btManifoldPoint& point, const Vec3& n, const Vec3& velocity) {
  const Vec3 slip = velocity - n * n.dot(velocity);
  Vec3 t1;
  if (slip.norm() > kSliding_m_s) {
    t1 = slip.normalized();
  } else {
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    t1 = n.cross(Vec3(Vec3::Unit(least))).normalized();
  }
  point.m_lateralFrictionDir1 = toBt(t1);
  point.m_lateralFrictionDir2 = toBt(Vec3(n.cross(t1)));
  point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
}

bool hasAnisotropicFriction(const btCollisionObject& a, const btCollisionObject& b) {
  return a.hasAnisotropicFriction() || b.hasAnisotropicFriction();
}

// Sets what btManifoldResult::addContactPoint would set from the bodies.
void setMaterial(btManifoldPoint& point, const Candidate& c, const PairMaterial& material,
                 const btCollisionObject* a, const btCollisionObject* b) {
  point.m_combinedFriction = toBt(material.friction(c));
  point.m_combinedRestitution = toBt(material.restitution(c));
  point.m_combinedRollingFriction = btManifoldResult::calculateCombinedRollingFriction(a, b);
  point.m_combinedSpinningFriction = btManifoldResult::calculateCombinedSpinningFriction(a, b);
  const int flags = a->getCollisionFlags() | b->getCollisionFlags();
  if (flags & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) {
    point.m_combinedContactDamping1 = btManifoldResult::calculateCombinedContactDamping(a, b);
    point.m_combinedContactStiffness1 = btManifoldResult::calculateCombinedContactStiffness(a, b);
    point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  }
  if (flags & btCollisionObject::CF_HAS_FRICTION_ANCHOR)
    point.m_contactPointFlags |= BT_CONTACT_FLAG_FRICTION_ANCHOR;
}

btManifoldPoint makePoint(const Candidate& c, const PairMaterial& material,
                          const btCollisionObjectWrapper* const (&bodies)[2], const RelativeMotion& motion) {
  Vec3 on0, on1;
  positions(c, on0, on1);
  const btVector3 p0 = toBt(on0), p1 = toBt(on1);
  btManifoldPoint point(bodies[0]->getCollisionObject()->getWorldTransform().invXform(p0),
                        bodies[1]->getCollisionObject()->getWorldTransform().invXform(p1), toBt(c.n_W),
                        toBt(c.distance_m));
  point.m_positionWorldOnA = p0;
  point.m_positionWorldOnB = p1;
  point.m_index0 = indexOn(c, 0);
  point.m_index1 = indexOn(c, 1);
  point.m_partId0 = c.surface[0];
  point.m_partId1 = c.surface[1];
  setMaterial(point, c, material, bodies[0]->getCollisionObject(), bodies[1]->getCollisionObject());
  if (c.rest_m > 0) setRestGap(point, c.rest_m);
  if (c.bounces) setBounces(point);
  setFrictionDirections(point, c.n_W, motion.velocityAt(c.p_W));
  // Bullet's solver scales the directions by the bodies' factors, but only those that it chooses itself.
  if (hasAnisotropicFriction(*bodies[0]->getCollisionObject(), *bodies[1]->getCollisionObject()))
    point.m_contactPointFlags &= ~BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
  return point;
}

// Last step's impulses, in the new friction directions.
void copyImpulses(btManifoldPoint& point, const btManifoldPoint& old) {
  point.m_appliedImpulse = old.m_appliedImpulse;
  const btVector3 lateral = old.m_lateralFrictionDir1 * old.m_appliedImpulseLateral1 +
                            old.m_lateralFrictionDir2 * old.m_appliedImpulseLateral2;
  point.m_appliedImpulseLateral1 = lateral.dot(point.m_lateralFrictionDir1);
  point.m_appliedImpulseLateral2 = lateral.dot(point.m_lateralFrictionDir2);
  point.m_lifeTime = old.m_lifeTime + 1;
  point.m_userPersistentData = old.m_userPersistentData;
}

// A point that is not added again keeps what the user's callback has set.
void keepMaterial(btManifoldPoint& point, const btManifoldPoint& old) {
  constexpr int kSoft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                        BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  if ((old.m_contactPointFlags & kSoft) != 0) {
    point.m_contactPointFlags = old.m_contactPointFlags;
    point.m_contactCFM = old.m_contactCFM;
    point.m_contactERP = old.m_contactERP;
  } else {
    point.m_contactPointFlags |=
        old.m_contactPointFlags & (kOwnDirections | kOwnNormal | BT_CONTACT_FLAG_FRICTION_ANCHOR);
  }
  point.m_frictionCFM = old.m_frictionCFM;
  point.m_combinedFriction = old.m_combinedFriction;
  point.m_combinedRollingFriction = old.m_combinedRollingFriction;
  point.m_combinedSpinningFriction = old.m_combinedSpinningFriction;
  point.m_combinedRestitution = old.m_combinedRestitution;
  point.m_contactMotion1 = old.m_contactMotion1;
  point.m_contactMotion2 = old.m_contactMotion2;
  if ((old.m_contactPointFlags & kOwnNormal) != 0) point.m_normalWorldOnB = old.m_normalWorldOnB;
  if ((old.m_contactPointFlags & kOwnDirections) == 0) return;
  point.m_lateralFrictionDir1 = old.m_lateralFrictionDir1;
  point.m_lateralFrictionDir2 = old.m_lateralFrictionDir2;
  point.m_appliedImpulseLateral1 = old.m_appliedImpulseLateral1;
  point.m_appliedImpulseLateral2 = old.m_appliedImpulseLateral2;
}

bool wantsAdded(const btCollisionObject* a, const btCollisionObject* b) {
  const int flags = a->getCollisionFlags() | b->getCollisionFlags();
  return gContactAddedCallback && (flags & btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK) != 0;
}

}  // namespace

ManifoldWriter::ManifoldWriter(btDispatcher& dispatcher, const btCollisionObject* object0,
                               const btCollisionObject* object1)
    : dispatcher_(dispatcher), objects_{object0, object1} {}

ManifoldWriter::~ManifoldWriter() {
  // Bullet would report the end of contact for each manifold.
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
  // Without a valid id they match no candidate, and the next write() returns their user data.
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
  // They were usually written in this order, and sorting them is expensive.
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
  // assumed: a pair with many contacts lacks some of its many neighbours
  const std::size_t manifold_count = keeps_spare ? used + 4 + used / 2 : used;
  while (manifolds_.size() < manifold_count) {
    btPersistentManifold* manifold = dispatcher_.getNewManifold(objects_[0], objects_[1]);
    if (!manifold) break;  // the pool is full and may not grow
    manifolds_.push_back(manifold);
  }
  const bool is_custom = wantsAdded(objects_[0], objects_[1]);
  const PairMaterial material(bodies);
  // Bullet's own algorithms add up to four points again in each step, and keep what others have: so do we,
  // one manifold after the other.
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
      while (old != old_.end() && old->key < c.key()) ++old;  // both are ascending by key
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
  gContactAddedCallback(point, bodies[0], point.m_partId0, point.m_index0, bodies[1], point.m_partId1,
                        point.m_index1);
  if (point.m_normalWorldOnB != normal) point.m_contactPointFlags |= kOwnNormal;
  if (point.m_lateralFrictionDir1 != directions[0] || point.m_lateralFrictionDir2 != directions[1])
    point.m_contactPointFlags |= kOwnDirections;
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
  const PairMaterial material(bodies);
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

}  // namespace vps::bullet::inline v0

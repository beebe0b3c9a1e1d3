// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/install.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>

#include "install/context.h"
#include "native_shapes/native_shape_algorithm.h"
#include "native_shapes/primitive.h"
#include "vps_bullet/algorithm.h"

namespace vps::bullet {

namespace {

constexpr int kVps = FAST_CONCAVE_MESH_PROXYTYPE;

// A dispatcher's tables, which it fills by public calls and lets only its heirs read.
struct Tables : btCollisionDispatcher {
  using Table =
      btCollisionAlgorithmCreateFunc* [MAX_BROADPHASE_COLLISION_TYPES][MAX_BROADPHASE_COLLISION_TYPES];
  static const Table& contact(const btCollisionDispatcher& d) {
    return d.*(&Tables::m_doubleDispatchContactPoints);
  }
  static const Table& closest(const btCollisionDispatcher& d) {
    return d.*(&Tables::m_doubleDispatchClosestPoints);
  }
};

const Shape* vpsOf(const btCollisionObjectWrapper& body) {
  return dynamic_cast<const Shape*>(body.getCollisionShape());
}

bool hasSurface(const Shape& shape) {
  return shape.models().map || !shape.models().surfaces.empty();
}

// One side's points, the other's surface. Without either a pair would do nothing in silence.
void requireContact(bool is_possible) {
  if (!is_possible)
    throw std::invalid_argument(
        "a Shape's models cannot touch what it met: one side needs a shell, the other a map or surfaces");
}

template <typename Algorithm, typename... Arguments>
btCollisionAlgorithm* make(btCollisionAlgorithmConstructionInfo& info, Arguments&&... arguments) {
  void* room = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
  try {
    return new (room) Algorithm(info, std::forward<Arguments>(arguments)...);
  } catch (...) {
    info.m_dispatcher1->freeCollisionAlgorithm(room);
    throw;
  }
}

// For every pair of a Shape with anything but a compound, whose parts Bullet hands in one by one.
struct VpsCreate : btCollisionAlgorithmCreateFunc {
  std::shared_ptr<Context> context;

  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    const btCollisionObjectWrapper* const bodies[] = {body0, body1};
    for (const btCollisionObjectWrapper* body : bodies)
      if (vpsOf(*body)) hintAtSleep(*body->getCollisionObject());
    try {
      for (const int side : {0, 1})
        if (!vpsOf(*bodies[side])) return withNativeShape(info, bodies, side);
      const Shape &a = *vpsOf(*body0), &b = *vpsOf(*body1);
      requireContact((a.models().shell && hasSurface(b)) || (b.models().shell && hasSurface(a)));
      return make<Algorithm>(info, body0, body1, context);
    } catch (const std::exception& why) {  // Bullet's dispatch is no place to throw through
      say(why.what());
      return make<btEmptyAlgorithm>(info);
    }
  }

 private:
  btCollisionAlgorithm* withNativeShape(btCollisionAlgorithmConstructionInfo& info,
                                        const btCollisionObjectWrapper* const (&bodies)[2], int side) {
    const btCollisionShape& shape = *bodies[side]->getCollisionShape();
    const Shape* vps = vpsOf(*bodies[1 - side]);
    if (!vps)
      throw std::invalid_argument(std::string(shape.getName()) +
                                  " has the shape type of Shape, which is taken; it does not collide");
    const bool is_smooth = isPrimitive(shape) && !hasCorners(shape);
    requireContact(vps->models().shell || (!is_smooth && hasSurface(*vps)));
    if (is_smooth) return make<Algorithm>(info, bodies[0], bodies[1], context);
    return make<NativeShapeAlgorithm>(info, bodies[0], bodies[1], context, side);
  }

  // A sleeping threshold of 0.8 m/s stops what slides; see tuneBody.
  void hintAtSleep(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    constexpr double kFast_m_s = 0.1;  // a part that is pushed by hand
    if (!body || body->isStaticOrKinematicObject() || body->getActivationState() == DISABLE_DEACTIVATION ||
        !(body->getLinearSleepingThreshold() > kFast_m_s))
      return;
    say("a body may fall asleep while it slides at " + std::to_string(body->getLinearSleepingThreshold()) +
        " m/s; call tuneWorld when all bodies are added, or tuneBody");
  }

  // Each thing once; pairs come and go.
  void say(const std::string& words) {
    const std::lock_guard lock(mutex_);
    if (said_.insert(words).second) std::fprintf(stderr, "vps: %s\n", words.c_str());
  }
  std::mutex mutex_;
  std::set<std::string> said_;
};

struct Installation {
  std::shared_ptr<Context> context = std::make_shared<Context>();
  VpsCreate create;
  /// What was registered before, contact and closest, by type, in both orders.
  std::map<std::pair<int, int>, std::pair<btCollisionAlgorithmCreateFunc*, btCollisionAlgorithmCreateFunc*>>
      before;
};

// The dispatcher's tables have no room for an owner, so installations are kept here.
std::mutex g_mutex;
std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>>& installations() {
  static std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>> all;
  return all;
}

// A dispatcher that died without uninstall leaves an entry that says nothing about one that has come to
// lie at its place.
Installation* find(const btCollisionDispatcher& dispatcher) {
  const auto it = installations().find(&dispatcher);
  const bool is_there =
      it != installations().end() && Tables::contact(dispatcher)[kVps][kVps] == &it->second->create;
  return is_there ? it->second.get() : nullptr;
}

template <typename Visit>
void forEachPair(const Visit& visit) {
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    // An empty shape means nothing, compounds are taken apart by Bullet, soft bodies have Bullet's own.
    if (type == EMPTY_SHAPE_PROXYTYPE || type == COMPOUND_SHAPE_PROXYTYPE || type == SOFTBODY_SHAPE_PROXYTYPE)
      continue;
    visit(kVps, type);
    if (type != kVps) visit(type, kVps);
  }
}

void registerBoth(btCollisionDispatcher& dispatcher, int a, int b, btCollisionAlgorithmCreateFunc* contact,
                  btCollisionAlgorithmCreateFunc* closest) {
  dispatcher.registerCollisionCreateFunc(a, b, contact);
  dispatcher.registerClosestPointsCreateFunc(a, b, closest);
}

void requireUsable(const Settings& s) {
  if (s.contact_limit < 4) throw std::invalid_argument("install: contact_limit must be at least 4");
  if (s.candidate_limit != 0 && s.candidate_limit < s.contact_limit)
    throw std::invalid_argument("install: candidate_limit must be 0 (all) or at least contact_limit");
  if (!(s.stiffness_N_per_m3 > 0) || !std::isfinite(s.stiffness_N_per_m3))
    throw std::invalid_argument("install: stiffness_N_per_m3 must be positive and finite");
  if (!(s.contact_margin_m > 0) || !(s.contact_margin_m < 1e-2))
    throw std::invalid_argument("install: contact_margin_m must be positive and below 10 mm");
}

}  // namespace

void install(btCollisionDispatcher& dispatcher, const Settings& settings) {
  requireUsable(settings);
  const std::lock_guard lock(g_mutex);
  Installation* installation = find(dispatcher);
  if (!installation) {
    auto fresh = std::make_unique<Installation>();
    fresh->create.context = fresh->context;
    installation = fresh.get();
    installations()[&dispatcher] = std::move(fresh);
  }
  installation->context->settings = settings;
  btCollisionAlgorithmCreateFunc* create = &installation->create;
  forEachPair([&](int a, int b) {
    auto* contact = Tables::contact(dispatcher)[a][b];
    auto* closest = Tables::closest(dispatcher)[a][b];
    if (contact != create) installation->before[{a, b}] = {contact, closest};
    registerBoth(dispatcher, a, b, create, create);
  });
}

void uninstall(btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  Installation* installation = find(dispatcher);
  constexpr long kOurs = 2;  // the installation's and its create function's; all others are pairs'
  if (installation && installation->context.use_count() > kOurs)
    std::fprintf(stderr,
                 "vps: uninstalled while pairs of bodies with VpsShapes exist; they keep VPS contact\n");
  if (installation)
    for (const auto& [types, functions] : installation->before)
      if (Tables::contact(dispatcher)[types.first][types.second] == &installation->create)
        registerBoth(dispatcher, types.first, types.second, functions.first, functions.second);
  installations().erase(&dispatcher);
}

bool isInstalled(const btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  return find(dispatcher) != nullptr;
}

std::shared_ptr<Context> contextOf(const btDispatcher* dispatcher) {
  const std::lock_guard lock(g_mutex);
  if (!dispatcher) return nullptr;
  const Installation* installation = find(*static_cast<const btCollisionDispatcher*>(dispatcher));
  return installation ? installation->context : nullptr;
}

Stats stats(const btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  Stats stats;
  const Installation* installation = find(dispatcher);
  if (!installation) return stats;
  const Context& c = *installation->context;
  stats.pair_updates = c.pair_updates;
  stats.points_tested = c.points_tested;
  stats.candidates = c.candidates;
  stats.contacts = c.contacts;
  stats.left_out = c.left_out;
  stats.overlapping_starts = c.overlapping_starts;
  stats.deepest_start_m = c.deepest_start_m;
  return stats;
}

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// install(): the create function that Bullet calls for each new pair with a Shape.
//
// Installations are kept in a map by dispatcher, behind a mutex. A dispatcher neither owns the create
// functions in its table nor has a user pointer, and install(), uninstall() and stats() have no other
// argument. No step reads the map: pairs share their Context, and the solver finds the create function in the
// dispatcher's table (contact_stores.h).
#include "vps_bullet/install.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btPoolAllocator.h>
#include <LinearMath/btThreads.h>
#include <string>
#include "log/report.h"
#include "narrowphase/pair/pair_algorithm.h"
#include "narrowphase/pair/pair_state.h"
#include "native_shapes/native_shape.h"
#include "native_shapes/native_shape_adapter.h"
#include "solver/contact_stores.h"
#include "solver/rigid/step_check.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

namespace {

const Shape* shapeOf(const btCollisionObjectWrapper& body) {
  return dynamic_cast<const Shape*>(body.getCollisionShape());
}

bool hasSurface(const Shape& shape) {
  return shape.models().map || !shape.models().surfaces.empty();
}

// Contact needs the points of one side and the surface of the other. A pair without such points or surface
// would silently have no contact.
void requireContact(bool is_possible) {
  if (!is_possible)
    throw std::invalid_argument(
        "a Shape's models allow no contact with this shape: one side needs a shell, the other a map or "
        "surfaces");
}

template <typename Made, typename... Arguments>
btCollisionAlgorithm* make(btCollisionAlgorithmConstructionInfo& info, Arguments&&... arguments) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Made));
  try {
    return new (memory) Made(info, std::forward<Arguments>(arguments)...);
  } catch (...) {
    info.m_dispatcher1->freeCollisionAlgorithm(memory);
    throw;
  }
}

// Called for every pair of a Shape with another shape.
struct CreateFunction : ContactCreateFunction {
  std::shared_ptr<Context> context;
  btNearCallback next_near_callback = &btCollisionDispatcher::defaultNearCallback;

  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    const btCollisionObjectWrapper* const bodies[] = {body0, body1};
    for (const btCollisionObjectWrapper* body : bodies)
      if (shapeOf(*body)) warnOfSleep(*body->getCollisionObject());
    for (const btCollisionObjectWrapper* body : bodies) {
      if (body->getCollisionShape()->isCompound()) return make<CompoundPair>(info, body0, body1, context);
      if (body->getCollisionShape()->getShapeType() == EMPTY_SHAPE_PROXYTYPE)
        return make<EmptyPair>(info, body0, body1);
    }
    try {
      for (const int side : {0, 1})
        if (!shapeOf(*bodies[side])) return withNativeShape(info, bodies, side);
      const Shape &a = *shapeOf(*body0), &b = *shapeOf(*body1);
      requireContact((a.models().shell && hasSurface(b)) || (b.models().shell && hasSurface(a)));
      return make<ContactAlgorithm>(info, body0, body1, context);
    } catch (const std::exception& error) {  // Bullet's dispatch is not exception-safe
      warnOnce(error.what());
      return make<EmptyPair>(info, body0, body1);
    }
  }

 private:
  btCollisionAlgorithm* withNativeShape(btCollisionAlgorithmConstructionInfo& info,
                                        const btCollisionObjectWrapper* const (&bodies)[2], int side) {
    const btCollisionShape& shape = *bodies[side]->getCollisionShape();
    const Shape* vps = shapeOf(*bodies[1 - side]);
    if (!vps)
      throw std::invalid_argument(
          "a shape named " + std::string(shape.getName()) +
          " uses the shape type of bullet::Shape, which is reserved; it does not collide");
    const bool is_smooth = isPrimitive(shape) && !hasCorners(shape);
    requireContact(vps->models().shell || (!is_smooth && hasSurface(*vps)));
    if (is_smooth) return make<ContactAlgorithm>(info, bodies[0], bodies[1], context);
    return make<NativeShapeAlgorithm>(info, bodies[0], bodies[1], context, side);
  }

  // Warns of Bullet's default sleeping threshold of 0.8 m/s, which stops sliding parts; see tuneBody().
  void warnOfSleep(const btCollisionObject& object) {
    const btRigidBody* body = btRigidBody::upcast(&object);
    constexpr double kFast_m_s = 0.1;  // speed of a part that is pushed by hand
    if (!body || body->isStaticOrKinematicObject() || body->getActivationState() == DISABLE_DEACTIVATION ||
        !(body->getLinearSleepingThreshold() > kFast_m_s))
      return;
    warnOnce("a body may fall asleep while it slides at " +
             std::to_string(body->getLinearSleepingThreshold()) +
             " m/s; call tuneWorld when all bodies are added, or tuneBody");
  }

  // Reports each message once, since pairs are created and destroyed often.
  void warnOnce(const std::string& message) {
    const std::lock_guard lock(mutex_);
    if (reported_.insert(message).second) report(LogLevel::Warning, message);
  }
  std::mutex mutex_;
  std::set<std::string> reported_;
};

// Called for every pair of a compound with another shape that is not a Shape. If neither of the two shapes
// contains a Shape, the function that was registered before is called.
struct CompoundCreateFunction : btCollisionAlgorithmCreateFunc {
  const CreateFunction* ours = nullptr;
  btCollisionAlgorithmCreateFunc* before = nullptr;

  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    if (containsShape(*body0->getCollisionShape()) || containsShape(*body1->getCollisionShape()))
      return make<CompoundPair>(info, body0, body1, ours->context);
    return before->CreateCollisionAlgorithm(info, body0, body1);
  }
};

// Bullet calls the near callback for each pair of near bodies in each step.
void nearCallback(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
  renewIfSwapped(pair, dispatcher);
  const auto* ours = dynamic_cast<const CreateFunction*>(contactFunctionOf(&dispatcher));
  (ours ? ours->next_near_callback : &btCollisionDispatcher::defaultNearCallback)(pair, dispatcher, info);
}

struct Installation {
  std::shared_ptr<Context> context = std::make_shared<Context>();
  CreateFunction create;
  /// Functions for contact and for closest points that were registered before install(), by type, in both
  /// orders.
  std::map<std::pair<int, int>, std::pair<btCollisionAlgorithmCreateFunc*, btCollisionAlgorithmCreateFunc*>>
      before;
  /// Functions for pairs of a compound, for contact and for closest points, by type.
  std::map<std::pair<int, int>, std::array<CompoundCreateFunction, 2>> of_compound;

  Installation() {
    context->native_shapes = std::make_shared<NativeShapeCache>();
    context->penalty_contacts = create.penalty_contacts = std::make_shared<PenaltyContacts>();
    context->step_checks = create.step_checks = std::make_shared<StepChecks>();
    context->turn_reports = create.turn_reports = std::make_shared<TurnReports>();
    create.context = context;
  }
};

std::mutex g_mutex;
std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>>& installations() {
  static std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>> all;
  return all;
}

// Finds the installation of a dispatcher. A dispatcher that was destroyed without uninstall() leaves an entry
// that must not apply to another dispatcher at the same address, so the dispatcher's table decides.
Installation* find(const btCollisionDispatcher& dispatcher) {
  const auto it = installations().find(&dispatcher);
  const bool is_there = it != installations().end() &&
                        DispatchTable::contact(dispatcher)[kShapeType][kShapeType] == &it->second->create;
  return is_there ? it->second.get() : nullptr;
}

template <typename Visit>
void forEachPair(int mine, const Visit& visit) {
  for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
    if (type == SOFTBODY_SHAPE_PROXYTYPE) continue;  // soft bodies keep Bullet's own algorithm
    visit(mine, type);
    if (type != mine) visit(type, mine);
  }
}

// Visits the types that a compound can be paired with. GImpact has its own algorithms for compounds.
template <typename Visit>
void forEachCompoundPair(const Visit& visit) {
  forEachPair(COMPOUND_SHAPE_PROXYTYPE, [&](int a, int b) {
    const auto has = [&](int type) { return a == type || b == type; };
    if (!has(kShapeType) && !has(GIMPACT_SHAPE_PROXYTYPE)) visit(a, b);
  });
}

void registerBoth(btCollisionDispatcher& dispatcher, int a, int b, btCollisionAlgorithmCreateFunc* contact,
                  btCollisionAlgorithmCreateFunc* closest) {
  dispatcher.registerCollisionCreateFunc(a, b, contact);
  dispatcher.registerClosestPointsCreateFunc(a, b, closest);
}

void registerForCompounds(btCollisionDispatcher& dispatcher, Installation& installation) {
  forEachCompoundPair([&](int a, int b) {
    auto& functions = installation.of_compound[{a, b}];
    btCollisionAlgorithmCreateFunc* const current[] = {DispatchTable::contact(dispatcher)[a][b],
                                                       DispatchTable::closest(dispatcher)[a][b]};
    for (const int i : {0, 1}) {
      functions[i].ours = &installation.create;
      if (current[i] != &functions[i]) functions[i].before = current[i];
    }
    registerBoth(dispatcher, a, b, &functions[0], &functions[1]);
  });
}

void restoreForCompounds(btCollisionDispatcher& dispatcher, const Installation& installation) {
  for (const auto& [types, functions] : installation.of_compound) {
    const auto [a, b] = types;
    if (DispatchTable::contact(dispatcher)[a][b] == &functions[0])
      dispatcher.registerCollisionCreateFunc(a, b, functions[0].before);
    if (DispatchTable::closest(dispatcher)[a][b] == &functions[1])
      dispatcher.registerClosestPointsCreateFunc(a, b, functions[1].before);
  }
}

// Size of a manifold in Bullet's compiled library. Neither the configuration nor its pool has a member whose
// size depends on the precision, so that this call is safe in either precision.
int manifoldBytesOfLibrary() {
  btDefaultCollisionConstructionInfo small;
  small.m_defaultMaxPersistentManifoldPoolSize = 1;
  small.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  btDefaultCollisionConfiguration configuration(small);
  return configuration.getPersistentManifoldPool()->getElementSize();
}

[[noreturn]] void refuse(const char* whose, int theirs) {
  const bool is_double = VPS_BULLET_SCALAR_BYTES == 8;
  std::string words = "install: ";
  words.append(whose)
      .append(" a manifold of ")
      .append(std::to_string(theirs))
      .append(" bytes, and a manifold of this package has ");
  words.append(std::to_string(sizeof(btPersistentManifold)));
  words.append(": Bullet was compiled in another precision. vps::bullet was built for ")
      .append(is_double ? "double" : "single");
  words.append(
      is_double
          ? " precision; link LinearMath-float64, BulletCollision-float64 and BulletDynamics-float64 and no "
            "other of Bullet's libraries, or build vps with VPS_BULLET_DOUBLE=OFF"
          : " precision; link Bullet's libraries without -float64, or build vps with VPS_BULLET_DOUBLE=ON");
  throw std::invalid_argument(words);
}

/// Throws std::invalid_argument if Bullet's library, or the code that made the dispatcher, was compiled in
/// another precision than this library, in which all of Bullet's types have another size.
void requireSamePrecision(const btCollisionDispatcher& dispatcher) {
  constexpr int kOurs = static_cast<int>(sizeof(btPersistentManifold));
  static const int library = manifoldBytesOfLibrary();
  if (library != kOurs) refuse("Bullet's library has", library);
  // A host may provide its own pool, with larger elements.
  const int pool = dispatcher.getInternalManifoldPool()->getElementSize();
  if (pool < kOurs) refuse("the dispatcher's pool has", pool);
}

/// Throws std::invalid_argument for a btCollisionDispatcherMt with a task scheduler of several threads, since
/// the order of its manifolds differs from run to run.
void requireOneThread(const btCollisionDispatcher& dispatcher) {
  const btITaskScheduler* scheduler = btGetTaskScheduler();
  if (!dynamic_cast<const btCollisionDispatcherMt*>(&dispatcher) || !scheduler ||
      scheduler->getNumThreads() < 2)
    return;
  throw std::invalid_argument(
      "install: btCollisionDispatcherMt with several threads gives manifolds in another order in each run, "
      "so that "
      "no two runs would have the same bits. Use vps::bullet::Dispatcher (vps_bullet/dispatcher.h), which "
      "finds the "
      "contacts of VPS parts in parallel with the bits of one thread, or set a task scheduler of one thread");
}

void requireUsable(const Settings& s) {
  if (s.contact_limit < 4) throw std::invalid_argument("install: contact_limit must be at least 4");
  if (s.candidate_limit != 0 && s.candidate_limit < s.contact_limit)
    throw std::invalid_argument("install: candidate_limit must be 0 (all) or at least contact_limit");
  if (!(s.stiffness_N_per_m3 > 0) || !std::isfinite(s.stiffness_N_per_m3))
    throw std::invalid_argument("install: stiffness_N_per_m3 must be positive and finite");
  if (!(s.contact_margin_m > 0) || !(s.contact_margin_m < 1e-2))
    throw std::invalid_argument("install: contact_margin_m must be positive and below 10 mm");
  for (const double slip_m_s : {0.0, 1e-3, 1.0}) {
    const double mu = s.friction_model.coefficient ? s.friction_model.coefficient(0.1, slip_m_s) : 0.1;
    if (!(mu >= 0) || !std::isfinite(mu))
      throw std::invalid_argument(
          "install: friction_model gives a coefficient of " + std::to_string(mu) + " at a slip of " +
          std::to_string(slip_m_s) +
          " m/s where the bodies' friction is 0.1; the coefficient must be 0 or more and finite");
  }
}

}  // namespace

void install(btCollisionDispatcher& dispatcher, const Settings& settings) {
  requireUsable(settings);
  requireSamePrecision(dispatcher);
  requireOneThread(dispatcher);
  setContactInstalled();
  const std::lock_guard lock(g_mutex);
  Installation* installation = find(dispatcher);
  if (!installation) {
    auto fresh = std::make_unique<Installation>();
    installation = fresh.get();
    installations()[&dispatcher] = std::move(fresh);
  }
  installation->context->settings = settings;
  installation->context->turn_reports->is_on = settings.warns_of_turns;
  if (dispatcher.getNearCallback() != &nearCallback)
    installation->create.next_near_callback = dispatcher.getNearCallback();
  dispatcher.setNearCallback(&nearCallback);
  btCollisionAlgorithmCreateFunc* create = &installation->create;
  forEachPair(kShapeType, [&](int a, int b) {
    auto* contact = DispatchTable::contact(dispatcher)[a][b];
    auto* closest = DispatchTable::closest(dispatcher)[a][b];
    if (contact != create) installation->before[{a, b}] = {contact, closest};
    registerBoth(dispatcher, a, b, create, create);
  });
  registerForCompounds(dispatcher, *installation);
}

void uninstall(btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  Installation* installation = find(dispatcher);
  constexpr long kOurs =
      2;  // references held by the installation and its create function; all others belong to pairs
  if (installation && installation->context.use_count() > kOurs)
    report(LogLevel::Warning,
           "uninstall() was called while pairs of bodies with a bullet::Shape exist; these pairs keep VPS "
           "contact");
  if (installation && dispatcher.getNearCallback() == &nearCallback)
    dispatcher.setNearCallback(installation->create.next_near_callback);
  if (installation)
    for (const auto& [types, functions] : installation->before)
      if (DispatchTable::contact(dispatcher)[types.first][types.second] == &installation->create)
        registerBoth(dispatcher, types.first, types.second, functions.first, functions.second);
  if (installation) restoreForCompounds(dispatcher, *installation);
  installations().erase(&dispatcher);
}

bool isInstalled(const btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  return find(dispatcher) != nullptr;
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

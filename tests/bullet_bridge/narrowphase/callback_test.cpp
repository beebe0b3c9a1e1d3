// SPDX-License-Identifier: BSD-3-Clause
// Bullet's contact callbacks are called for a part as for one of Bullet's boxes; both are compared.
#include <gtest/gtest.h>

#include <set>
#include <typeinfo>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

const Built& fineCube() {
  static const Built built = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.5e-3, 0.5e-3);
  return built;
}

/// Counts the calls of each callback, and records their order.
struct Calls {
  int added = 0, processed = 0, started = 0, ended = 0, destroyed = 0, given = 0;
  std::string order;  ///< first letters of the callbacks, repeated calls once
  btScalar friction = -1;
  bool kept_data = true;

  void note(char letter) {
    if (order.empty() || order.back() != letter) order += letter;
  }
};
Calls* g_calls = nullptr;

bool onAdded(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
             const btCollisionObjectWrapper*, int, int) {
  ++g_calls->added;
  g_calls->note('a');
  if (!point.m_userPersistentData) {
    point.m_userPersistentData = g_calls;
    ++g_calls->given;
  }
  if (g_calls->friction >= 0) point.m_combinedFriction = g_calls->friction;
  return true;
}
bool onProcessed(btManifoldPoint& point, void*, void*) {
  ++g_calls->processed;
  g_calls->note('p');
  g_calls->kept_data = g_calls->kept_data && point.m_userPersistentData == g_calls;
  return true;
}
void onStarted(btPersistentManifold* const& manifold) {
  ++g_calls->started;
  EXPECT_GT(manifold->getNumContacts(), 0);
  g_calls->note('s');
}
void onEnded(btPersistentManifold* const&) {
  ++g_calls->ended;
  g_calls->note('e');
}
bool onDestroyed(void* data) {
  ++g_calls->destroyed;
  EXPECT_EQ(data, g_calls);
  g_calls->note('d');
  return true;
}

class Callbacks : public testing::Test {
 protected:
  Callbacks() {
    g_calls = &calls_;
    gContactAddedCallback = onAdded;
    gContactProcessedCallback = onProcessed;
    gContactStartedCallback = onStarted;
    gContactEndedCallback = onEnded;
    gContactDestroyedCallback = onDestroyed;
  }
  ~Callbacks() override {
    gContactAddedCallback = nullptr;
    gContactProcessedCallback = nullptr;
    gContactStartedCallback = nullptr;
    gContactEndedCallback = nullptr;
    gContactDestroyedCallback = nullptr;
  }
  /// A cube rests on another cube for some steps and is then lifted or removed. Both bodies are
  /// parts, or both are Bullet's boxes.
  Calls rest(bool is_part, int steps, bool is_lifted) {
    calls_ = {};
    World world;
    btBoxShape box(btVector3(toBt(0.005), toBt(0.005), toBt(0.005)));
    const double mass_kg = fineCube().frame.mass_kg;
    if (is_part)
      world.add(fineCube(), Pose(), true);
    else
      world.addShape(box, 0, Vec3::Zero(), Pose());
    btRigidBody& body = is_part ? world.add(fineCube(), Pose::translation(Vec3(0, 0, 0.01)))
                                : world.addShape(box, mass_kg, fineCube().frame.inertia_kg_m2,
                                                 Pose::translation(Vec3(0, 0, 0.01)));
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    world.step(steps);
    if (is_lifted) {
      world.world->setGravity(btVector3(0, 0, 0));
      body.setGravity(btVector3(0, 0, 0));
      body.setLinearVelocity(btVector3(0, 0, 1));  // 10 mm in ten steps: the cubes are still near
      world.step(10);
      body.setWorldTransform(toBt(Pose::translation(Vec3(0, 0, 0.1))));
      world.step(30);
    } else {
      world.world->removeRigidBody(&body);
    }
    const Calls calls = calls_;
    if (!is_lifted) world.world->addRigidBody(&body);  // the world's destructor removes the body
    return calls;
  }
  Calls calls_;
};

TEST_F(Callbacks, AreCalledForAPartAsForABox) {
  constexpr int kSteps = 100;
  for (const bool is_lifted : {false, true}) {
    const Calls box = rest(false, kSteps, is_lifted), part = rest(true, kSteps, is_lifted);
    EXPECT_EQ(box.started, 1);
    EXPECT_EQ(part.started, box.started);
    EXPECT_EQ(box.ended, 1);
    EXPECT_EQ(part.ended, box.ended);
    // A part has up to 64 contacts where a box has four: each of these contacts is added once, and then four
    // contacts are added in each step.
    EXPECT_GE(box.added, 3 * kSteps);
    EXPECT_GE(part.added, 3 * kSteps);
    EXPECT_LE(part.added, box.added + 3 * 64);
    EXPECT_GE(box.processed, 3 * kSteps);
    EXPECT_GE(part.processed, box.processed);
    EXPECT_LE(part.processed, 64 * (kSteps + 40));
    EXPECT_EQ(box.destroyed, box.given);
    EXPECT_EQ(part.destroyed, part.given) << "data that was given comes back";
    EXPECT_TRUE(part.kept_data);
    EXPECT_EQ(box.order.substr(0, 5), "asapa") << box.order;
    EXPECT_EQ(part.order.substr(0, 5), "asapa") << part.order;
    EXPECT_EQ(box.order.substr(box.order.size() - 2), "de") << box.order;
    EXPECT_EQ(part.order.substr(part.order.size() - 2), "de") << part.order;
  }
}

TEST_F(Callbacks, ACallbacksFrictionStaysWithItsPoint) {
  // Gravity is tilted by 34 degrees, too little to tip the cube. Without the callback's friction of 2 the
  // cube would slide.
  for (const btScalar friction : {btScalar(2), btScalar(0)}) {
    calls_ = {};
    calls_.friction = friction;
    World world;
    world.world->setGravity(btVector3(toBt(4), 0, toBt(-6)));
    world.add(fineCube(), Pose(), true);
    btRigidBody& body = world.add(fineCube(), Pose::translation(Vec3(0, 0, 0.01)));
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    world.step(30);
    // In free motion the body would move by a dt^2 n (n + 1) / 2 in n steps. Bullet's solver in single
    // precision lets the cube slip for a step.
    const double x_m = body.getWorldTransform().getOrigin().x();
    if (friction > 0)
      EXPECT_LT(x_m, 12e-6);  // two steps
    else
      EXPECT_NEAR(x_m, 1.86e-3, 0.05e-3);
  }
}

/// A result type of a host, as the host's near callback may pass it.
struct OwnResult : btManifoldResult {
  using btManifoldResult::btManifoldResult;
};
void ownNearCallback(btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                     const btDispatcherInfo& info) {
  auto* a = static_cast<btCollisionObject*>(pair.m_pProxy0->m_clientObject);
  auto* b = static_cast<btCollisionObject*>(pair.m_pProxy1->m_clientObject);
  if (!dispatcher.needsCollision(a, b)) return;
  const btCollisionObjectWrapper body0(nullptr, a->getCollisionShape(), a, a->getWorldTransform(), -1, -1),
      body1(nullptr, b->getCollisionShape(), b, b->getWorldTransform(), -1, -1);
  if (!pair.m_algorithm)
    pair.m_algorithm = dispatcher.findAlgorithm(&body0, &body1, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  OwnResult result(&body0, &body1);
  if (pair.m_algorithm) pair.m_algorithm->processCollision(&body0, &body1, info, &result);
}

TEST(NearCallback, AHostsOwnResultIsAStepAndNoQuery) {
  for (const bool is_set_first : {false, true}) {
    World world;
    if (is_set_first) {
      uninstall(world.dispatcher);
      world.dispatcher.setNearCallback(ownNearCallback);
      install(world.dispatcher);
    } else {
      world.dispatcher.setNearCallback(ownNearCallback);
    }
    world.add(fineCube(), Pose(), true);
    btRigidBody& body = world.add(fineCube(), Pose::translation(Vec3(0, 0, 0.0101)));
    world.step(200);
    EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 0.010, 5e-6);
  }
}

TEST(NearCallback, UninstallRestoresTheHosts) {
  World world;
  uninstall(world.dispatcher);
  world.dispatcher.setNearCallback(ownNearCallback);
  install(world.dispatcher);
  install(world.dispatcher);
  uninstall(world.dispatcher);
  EXPECT_EQ(world.dispatcher.getNearCallback(), &ownNearCallback);
}

}  // namespace
}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
// Bullet's contact callbacks with a part: when contact starts and ends, and the force that it carries.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>

#include <cmath>
#include <cstdio>

using vps::bullet::toBt;

namespace {

int g_started = 0, g_ended = 0;

void onStarted(btPersistentManifold* const& manifold) {
  ++g_started;
  const btVector3& p = manifold->getContactPoint(0).getPositionWorldOnA();
  std::printf("contact starts near (%.1f, %.1f, %.1f) mm\n", 1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z());
}
void onEnded(btPersistentManifold* const&) {
  ++g_ended;
  std::printf("contact ends\n");
}

/// Contact force on a body: the sum over all its manifolds. A pair has as many manifolds as its contacts
/// need, with up to four contacts in each.
double forceOn(const btCollisionObject& body, btCollisionDispatcher& dispatcher, double dt_s) {
  double impulse_Ns = 0;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    if (manifold.getBody0() != &body && manifold.getBody1() != &body) continue;
    for (int i = 0; i < manifold.getNumContacts(); ++i)
      impulse_Ns += manifold.getContactPoint(i).getAppliedImpulse();
  }
  return impulse_Ns / dt_s;
}

}  // namespace

int main() {
  // An ordinary Bullet world, and VPS contact in its dispatcher.
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));
  vps::bullet::install(dispatcher);
  // Bullet calls these functions once for each pair of bodies: when contact starts, and when it ends.
  gContactStartedCallback = onStarted;
  gContactEndedCallback = onEnded;

  // A steel ring, 0.5 mm above a plane. tuneWorld() sets Bullet's parameters for small parts.
  vps::bullet::BodySettings settings;
  settings.X_WP = vps::Pose::translation({0, 0, 0.0055});
  const vps::bullet::Body ring = vps::bullet::makeBody(vps::makeTube(0.012, 0.006, 0.01, 64), settings);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody ground(0, nullptr, &plane);
  world.addRigidBody(&ground);
  world.addRigidBody(ring.rigid.get());
  vps::bullet::tuneWorld(world);

  // The ring falls and comes to rest in 0.3 s: the plane then carries its weight.
  for (int i = 0; i < 300; ++i) world.stepSimulation(toBt(1e-3), 0);
  const double force_N = forceOn(*ring.rigid, dispatcher, 1e-3), weight_N = 9.81 * ring.frame.mass_kg;
  std::printf("the plane carries %.4f N of %.4f N\n", force_N, weight_N);
  // A push upwards ends the contact. A body may sleep, so it is activated first.
  ring.rigid->activate();
  ring.rigid->setLinearVelocity(btVector3(0, 0, 1));
  for (int i = 0; i < 50; ++i) world.stepSimulation(toBt(1e-3), 0);

  // Bodies leave the world before they are destroyed. The callbacks are global, so they are reset.
  world.removeRigidBody(ring.rigid.get());
  world.removeRigidBody(&ground);
  gContactStartedCallback = nullptr;
  gContactEndedCallback = nullptr;
  vps::bullet::uninstall(dispatcher);
  return g_started == 1 && g_ended == 1 && std::abs(force_N - weight_N) < 0.01 * weight_N ? 0 : 1;
}

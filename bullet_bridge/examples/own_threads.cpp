// SPDX-License-Identifier: BSD-3-Clause
// A host with threads of its own: each thread builds its parts and steps a world. The worlds share shapes,
// which no step changes. Results do not depend on the number of threads.
#include <btBulletDynamicsCommon.h>
#include <tbb/task_arena.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/dispatcher.h>
#include <vps_bullet/install.h>

#include <cstdio>
#include <thread>
#include <vector>

using vps::bullet::toBt;

namespace {

/// Lets a ring fall on the shared plate in a world of its own. Returns where the ring comes to rest.
btTransform drop(vps::bullet::Shape& plate, double tilt_rad, int threads) {
  btDefaultCollisionConfiguration config;
  // A drop-in dispatcher that searches contacts with `threads` threads.
  vps::bullet::Dispatcher dispatcher(&config, threads);  // 1: all work stays in the calling thread
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));
  vps::bullet::install(dispatcher);
  // The plate's shape is shared by all worlds; the rigid body belongs to this one.
  btRigidBody ground(0, nullptr, &plate);
  vps::bullet::BodySettings settings;
  settings.X_WP = vps::Pose(vps::rotationFromVector({tilt_rad, 0, 0}), {0, 0, 0.02});
  // Models are built by TBB, with as many threads as the arena allows: here one, the host's.
  vps::bullet::Body ring;
  tbb::task_arena(1).execute(
      [&] { ring = vps::bullet::makeBody(vps::makeTube(0.012, 0.006, 0.01, 48), settings); });
  world.addRigidBody(&ground);
  world.addRigidBody(ring.rigid.get());
  vps::bullet::tuneWorld(world);
  for (int i = 0; i < 200; ++i) world.stepSimulation(toBt(1e-3), 0);
  const btTransform end = ring.rigid->getWorldTransform();
  world.removeRigidBody(ring.rigid.get());
  world.removeRigidBody(&ground);
  vps::bullet::uninstall(dispatcher);
  return end;
}

}  // namespace

int main() {
  // The plate is built once, as a fixed body, which has no mass.
  vps::bullet::BodySettings fixed;
  fixed.is_fixed = true;
  const vps::bullet::Body plate = vps::bullet::makeBody(vps::makeBox({0.06, 0.06, 0.01}), fixed);

  // Four worlds at the same time, each in a thread of the host and without threads of its own.
  constexpr int kWorlds = 4;
  std::vector<btTransform> together(kWorlds);
  std::vector<std::thread> pool;  // represents the host's own threads
  for (int i = 0; i < kWorlds; ++i)
    pool.emplace_back([&, i] { together[i] = drop(*plate.shape, 0.1 * i, 1); });
  for (std::thread& thread : pool) thread.join();

  // The same worlds one after the other, each with two threads: every pose must have the same bits.
  int same = 0;
  for (int i = 0; i < kWorlds; ++i) same += together[i] == drop(*plate.shape, 0.1 * i, 2) ? 1 : 0;
  std::printf("%d of %d worlds end with the same bits in both runs\n", same, kWorlds);
  return same == kWorlds ? 0 : 1;
}

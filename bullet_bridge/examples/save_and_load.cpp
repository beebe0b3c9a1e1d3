// SPDX-License-Identifier: BSD-3-Clause
// Saves a world with a part in Bullet's own format, loads it again, and continues the simulation.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>
#include <vps_bullet/world_importer.h>

#include <cmath>
#include <cstdio>
#include <vector>

using vps::bullet::toBt;

namespace {

struct World {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher{&config};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &config};
  World() {
    world.setGravity(btVector3(0, 0, toBt(-9.81)));
    vps::bullet::install(dispatcher);
  }
  ~World() { vps::bullet::uninstall(dispatcher); }
  void step(int count) {
    for (int i = 0; i < count; ++i) world.stepSimulation(toBt(1e-3), 0);
  }
};

/// A world in which a tilted ring has fallen for 20 ms, as the bytes of a .bullet file.
std::vector<char> saved() {
  World first;
  vps::bullet::BodySettings settings;
  settings.X_WP = vps::Pose(vps::rotationFromVector({0.1, 0.05, 0.2}), {0, 0, 0.012});
  const vps::bullet::Body ring = vps::bullet::makeBody(vps::makeTube(0.012, 0.006, 0.01, 48), settings);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody ground(0, nullptr, &plane);
  first.world.addRigidBody(&ground);
  first.world.addRigidBody(ring.rigid.get());
  vps::bullet::tuneWorld(first.world);
  first.step(20);
  btDefaultSerializer serializer;
  first.world.serialize(&serializer);
  const auto* bytes = reinterpret_cast<const char*>(serializer.getBufferPointer());
  first.world.removeRigidBody(ring.rigid.get());
  first.world.removeRigidBody(&ground);
  return {bytes, bytes + serializer.getCurrentBufferSize()};
}

}  // namespace

int main() {
  std::vector<char> file = saved();
  // Loads the bytes into a second world: WorldImporter makes the parts' shapes again.
  World second;
  vps::bullet::WorldImporter importer(&second.world);  // in place of btBulletWorldImporter
  if (!importer.loadFileFromMemory(file.data(), static_cast<int>(file.size()))) return 1;
  vps::bullet::tuneWorld(second.world);
  const btRigidBody& ring = *btRigidBody::upcast(importer.getRigidBodyByIndex(1));
  std::printf("loaded %zu bytes: %d bodies, the ring at %.3f mm", file.size(), importer.getNumRigidBodies(),
              1e3 * ring.getWorldTransform().getOrigin().z());
  // The ring continues to fall and comes to rest on the plane.
  second.step(500);
  const double z_m = ring.getWorldTransform().getOrigin().z();
  std::printf(", later at %.3f mm: half its height\n", 1e3 * z_m);
  while (second.world.getNumCollisionObjects() > 0)
    second.world.removeCollisionObject(second.world.getCollisionObjectArray()[0]);
  importer.deleteAllData();
  return std::abs(z_m - 0.005) < 5e-6 ? 0 : 1;
}

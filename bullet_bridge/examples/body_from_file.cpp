// SPDX-License-Identifier: BSD-3-Clause
// Makes a body from a CAD or mesh file (STEP, STL, OBJ, glTF, ...) and lets it fall on a plane.
// Files are read by vps::scenes, since this library and the plugin depend on no reader:
// find_package(vps COMPONENTS bullet scenes). A host with a reader of its own passes its triangles to
// makeBody().
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>
#include <vps_scenes/cad/import.h>

#include <cstdio>
#include <exception>

using vps::bullet::toBt;

namespace {

void run(const char* file, const char* unit) {
  // Reads the file. The first part of the file becomes the body.
  vps::scenes::ImportSettings reading;
  reading.unit_m = vps::scenes::unitFromText(unit);  // STL, OBJ and PLY do not state their unit
  const vps::scenes::ImportedPart part = vps::scenes::importCad(file, reading).parts.at(0);
  vps::bullet::BodySettings settings;
  settings.name = part.name;
  settings.X_WP =
      vps::Pose::translation({0, 0, 1e-3 - vps::bounds(part.mesh).min.z()});  // 1 mm above the plane
  const vps::bullet::Body body = vps::bullet::makeBody(part.mesh, settings);

  // An ordinary Bullet world with VPS contact, and a plane as the ground.
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, toBt(-9.81)));
  vps::bullet::install(dispatcher);
  btStaticPlaneShape plane(btVector3(0, 0, 1), 0);
  btRigidBody ground(0, nullptr, &plane);
  world.addRigidBody(&ground);
  world.addRigidBody(body.rigid.get());
  vps::bullet::tuneWorld(world);
  // Half a second in steps of one millisecond; then the lowest point of the mesh lies on the plane.
  for (int i = 0; i < 500; ++i) world.stepSimulation(toBt(1e-3), 0);
  const double lowest_m = vps::bounds(vps::transformed(part.mesh, body.X_WP())).min.z();
  std::printf("%s of %.1f g lies %.3f um above the plane\n", part.name.c_str(), 1e3 * body.frame.mass_kg,
              1e6 * lowest_m);
  world.removeRigidBody(body.rigid.get());
  world.removeRigidBody(&ground);
  vps::bullet::uninstall(dispatcher);
  if (!(lowest_m > -5e-6 && lowest_m < 5e-6)) throw std::runtime_error("the part does not lie on the plane");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "part.stl", argc > 2 ? argv[2] : "mm");
    return 0;
  } catch (const std::exception& error) {  // for example: the file cannot be read
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

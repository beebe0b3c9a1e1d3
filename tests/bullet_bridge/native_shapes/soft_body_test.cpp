// SPDX-License-Identifier: BSD-3-Clause
// Parts and Bullet's soft bodies: Bullet's own contact, in both directions.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "vps_bullet/body.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/install.h"

namespace vps::bullet {
namespace {

/// Of the soft bodies.
constexpr double kMargin_m = 0.01;

struct SoftWorld {
  btSoftBodyRigidBodyCollisionConfiguration config;
  btCollisionDispatcher dispatcher{&config};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &config};
  std::vector<std::unique_ptr<btSoftBody>> soft;

  SoftWorld() {
    install(dispatcher);
    world.setGravity(btVector3(0, 0, toBt(-9.81)));
    btSoftBodyWorldInfo& info = world.getWorldInfo();
    info.m_gravity = world.getGravity();
    info.m_broadphase = &broadphase;
    info.m_dispatcher = &dispatcher;
    info.m_sparsesdf.Initialize();
  }
  ~SoftWorld() {
    for (auto& body : soft) world.removeSoftBody(body.get());
    uninstall(dispatcher);
  }
  btSoftBody& add(btSoftBody* body, double mass_kg) {
    soft.emplace_back(body);
    body->getCollisionShape()->setMargin(toBt(kMargin_m));
    body->m_cfg.piterations = 10;
    body->setTotalMass(toBt(mass_kg), false);  // with `true`, fixed corners would get a mass
    world.addSoftBody(body);
    return *body;
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) world.stepSimulation(toBt(1.0 / 240), 0);
  }
};

double lowest_m(const btSoftBody& body) {
  double z_m = 1e30;
  for (int i = 0; i < body.m_nodes.size(); ++i) z_m = std::min<double>(z_m, body.m_nodes[i].m_x.z());
  return z_m;
}

TEST(SoftBody, ABallOfClothFallsOnAPartAndStaysOnIt) {
  SoftWorld soft;
  BodySettings settings;
  settings.is_fixed = true;
  settings.X_WP = Pose::translation(Vec3(0, 0, -0.05));  // its top is at 0
  const Body plate = makeBody(makeBox(Vec3(0.6, 0.6, 0.1)), settings);
  soft.world.addRigidBody(plate.rigid.get());
  btSoftBody& ball =
      soft.add(btSoftBodyHelpers::CreateEllipsoid(soft.world.getWorldInfo(), toBt(Vec3(0, 0, 0.2)),
                                                  toBt(Vec3(0.1, 0.1, 0.1)), 128),
               0.5);
  soft.step(480);
  EXPECT_GT(lowest_m(ball), -kMargin_m);
  EXPECT_LT(lowest_m(ball), 3 * kMargin_m) << "it has come down";
  soft.world.removeRigidBody(plate.rigid.get());
}

TEST(SoftBody, APartFallsOnAClothThatCarriesIt) {
  for (const bool falls_beside : {false, true}) {
    SoftWorld soft;
    const double half = 0.3;
    btSoftBody& cloth =
        soft.add(btSoftBodyHelpers::CreatePatch(soft.world.getWorldInfo(), toBt(Vec3(-half, -half, 0)),
                                                toBt(Vec3(half, -half, 0)), toBt(Vec3(-half, half, 0)),
                                                toBt(Vec3(half, half, 0)), 31, 31, 1 + 2 + 4 + 8, true),
                 0.5);
    cloth.m_cfg.kDF = 1;
    BodySettings settings;
    settings.material.density_kg_m3 = 500;
    settings.X_WP = Pose::translation(Vec3(falls_beside ? 0.5 : 0, 0, 0.1));
    const Body part = makeBody(makeBox(Vec3(0.1, 0.1, 0.05)), settings);
    soft.world.addRigidBody(part.rigid.get());
    soft.step(240);
    if (falls_beside)
      EXPECT_LT(part.X_WP().p.z(), -3);
    else
      EXPECT_GT(part.X_WP().p.z(), -0.3) << "the cloth sags, and holds";
    soft.world.removeRigidBody(part.rigid.get());
  }
}

}  // namespace
}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include <cmath>

#include "dynamics/world.h"
#include "rivals.h"
#include "vps_bullet/convert.h"

namespace vps::bench {

namespace {

struct GimpactShape {
  btTriangleMesh triangles;
  std::unique_ptr<btGImpactMeshShape> shape;

  GimpactShape(const Mesh& mesh, double margin_m) {
    for (const Vec3& p : mesh.vertices) triangles.findOrAddVertex(bullet::toBt(p), false);
    for (const auto& t : mesh.triangles)
      triangles.addTriangleIndices(static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2]));
    shape = std::make_unique<btGImpactMeshShape>(&triangles);
    shape->setMargin(bullet::toBt(margin_m));
    shape->updateBound();
  }
};

}  // namespace

dynamics::Engine gimpactEngine(double margin_m) {
  dynamics::Engine engine;
  engine.name = "GImpact";
  engine.install = [](btCollisionDispatcher& d, dynamics::Mode) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&d);
  };
  engine.uninstall = [](btCollisionDispatcher&) {};
  engine.makeShape = [margin_m](const dynamics::PartMesh& part, bool) {
    auto shape = std::make_shared<GimpactShape>(bodyMesh(part), margin_m);
    return dynamics::ShapeHandle(shape, shape->shape.get());
  };
  return engine;
}

PairQuery bulletQuery(const dynamics::Engine& engine, const dynamics::PartMesh& a,
                      const dynamics::PartMesh& b) {
  auto world =
      std::make_shared<dynamics::World>(dynamics::SceneSettings{dynamics::Mode::Constraint, true, engine});
  const auto body_a = world->add(a, Pose(), true);
  const auto body_b = world->add(b, Pose(), false);
  btDispatcher& dispatcher = *world->bullet().getDispatcher();
  const btCollisionObjectWrapper none_a(nullptr, body_a.body->getCollisionShape(), body_a.body,
                                        body_a.body->getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper none_b(nullptr, body_b.body->getCollisionShape(), body_b.body,
                                        body_b.body->getWorldTransform(), -1, -1);
  btCollisionAlgorithm* algorithm =
      dispatcher.findAlgorithm(&none_a, &none_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  const std::shared_ptr<btCollisionAlgorithm> kept(algorithm, [world](btCollisionAlgorithm* dead) {
    dead->~btCollisionAlgorithm();
    world->bullet().getDispatcher()->freeCollisionAlgorithm(dead);
  });
  return {engine.name, [world, body_a, body_b, kept](const Pose& X_AB) {
            body_b.body->setWorldTransform(bullet::toBt(X_AB * body_b.part.frame.X_PB));
            const btCollisionObjectWrapper wrapped_a(nullptr, body_a.body->getCollisionShape(), body_a.body,
                                                     body_a.body->getWorldTransform(), -1, -1);
            const btCollisionObjectWrapper wrapped_b(nullptr, body_b.body->getCollisionShape(), body_b.body,
                                                     body_b.body->getWorldTransform(), -1, -1);
            btDispatcherInfo info;
            info.m_timeStep = btScalar(dynamics::World::kStep_s);
            btManifoldResult result(&wrapped_a, &wrapped_b);
            kept->processCollision(&wrapped_a, &wrapped_b, info, &result);
            btManifoldArray manifolds;
            kept->getAllContactManifolds(manifolds);
            PairQuery::Answer answer;
            for (int m = 0; m < manifolds.size(); ++m)
              for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) {
                ++answer.contacts;
                answer.deepest_m =
                    std::max<double>(answer.deepest_m, -manifolds[m]->getContactPoint(i).getDistance());
              }
            return answer;
          }};
}

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
#include <btBulletDynamicsCommon.h>

#include "rivals.h"
#include "vps_bullet/convert.h"

namespace vps::bench {

namespace {

struct StaticMesh {
  btTriangleMesh triangles;
  std::unique_ptr<btBvhTriangleMeshShape> shape;

  explicit StaticMesh(const Mesh& mesh) {
    for (const Vec3& p : mesh.vertices) triangles.findOrAddVertex(bullet::toBt(p), false);
    for (const auto& t : mesh.triangles)
      triangles.addTriangleIndices(static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2]));
    shape = std::make_unique<btBvhTriangleMeshShape>(&triangles, true);
    shape->setMargin(0);
  }
};

dynamics::ShapeHandle hullOf(const dynamics::PartMesh& part) {
  auto hull = std::make_shared<btConvexHullShape>();
  for (const Vec3& p : bodyMesh(part).vertices) hull->addPoint(bullet::toBt(p), false);
  hull->setMargin(0);
  hull->recalcLocalAabb();
  return hull;
}

dynamics::Engine engineOf(const char* name,
                          std::function<dynamics::ShapeHandle(const dynamics::PartMesh&, bool)> makeShape) {
  dynamics::Engine engine;
  engine.name = name;
  engine.install = [](btCollisionDispatcher&, dynamics::Mode) {};
  engine.uninstall = [](btCollisionDispatcher&) {};
  engine.makeShape = std::move(makeShape);
  return engine;
}

}  // namespace

dynamics::Engine hullEngine() {
  return engineOf("hulls", [](const dynamics::PartMesh& part, bool) { return hullOf(part); });
}

dynamics::Engine bvhEngine() {
  return engineOf("btBvh", [](const dynamics::PartMesh& part, bool is_fixed) {
    if (!is_fixed) return hullOf(part);
    auto mesh = std::make_shared<StaticMesh>(bodyMesh(part));
    return dynamics::ShapeHandle(mesh, mesh->shape.get());
  });
}

}  // namespace vps::bench

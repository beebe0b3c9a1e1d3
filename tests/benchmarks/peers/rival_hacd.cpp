// SPDX-License-Identifier: BSD-3-Clause
#include "rivals.h"

#ifdef VPS_HAS_HACD
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <hacdHACD.h>

#include <map>

#include "vps_bullet/convert.h"
#endif

namespace vps::bench {

#ifdef VPS_HAS_HACD
namespace {

struct Hulls {
  std::vector<std::unique_ptr<btConvexHullShape>> hulls;
  btCompoundShape compound;
};

// HACD expects a mesh scaled to a size of 1000.
constexpr double kScale = 1000;

std::shared_ptr<Hulls> cut(const Mesh& mesh, double concavity_m) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  for (const Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<HACD::Vec3<long>> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const Vec3 size = bounds(mesh).size();
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(0.1);
  hacd.SetVolumeWeight(0);
  hacd.SetNClusters(2);
  hacd.SetNVerticesPerCH(100);
  hacd.SetScaleFactor(kScale);
  hacd.SetConcavity(concavity_m * kScale / size.norm());
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.Compute();
  auto shape = std::make_shared<Hulls>();
  for (std::size_t k = 0; k < hacd.GetNClusters(); ++k) {
    std::vector<HACD::Vec3<HACD::Real>> hull_points(hacd.GetNPointsCH(k));
    std::vector<HACD::Vec3<long>> hull_triangles(hacd.GetNTrianglesCH(k));
    hacd.GetCH(k, hull_points.data(), hull_triangles.data());
    auto hull = std::make_unique<btConvexHullShape>();
    for (const auto& p : hull_points) hull->addPoint(bullet::toBt(Vec3(p.X(), p.Y(), p.Z())), false);
    hull->setMargin(0);
    hull->recalcLocalAabb();
    shape->compound.addChildShape(btTransform::getIdentity(), hull.get());
    shape->hulls.push_back(std::move(hull));
  }
  return shape;
}

}  // namespace

std::optional<dynamics::Engine> hacdEngine(double concavity_m) {
  const auto kept = std::make_shared<std::map<std::shared_ptr<const Solid>, std::shared_ptr<Hulls>>>();
  dynamics::Engine engine;
  engine.name = "HACD";
  engine.install = [](btCollisionDispatcher&, dynamics::Mode) {};
  engine.uninstall = [](btCollisionDispatcher&) {};
  engine.makeShape = [kept, concavity_m](const dynamics::PartMesh& part, bool) {
    auto& hulls = (*kept)[part.exact];
    if (!hulls) hulls = cut(bodyMesh(part), concavity_m);
    return dynamics::ShapeHandle(hulls, &hulls->compound);
  };
  return engine;
}
#else
std::optional<dynamics::Engine> hacdEngine(double) {
  return std::nullopt;
}
#endif

}  // namespace vps::bench

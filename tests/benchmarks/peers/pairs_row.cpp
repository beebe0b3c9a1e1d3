// SPDX-License-Identifier: BSD-3-Clause
// The cost of single pairs: queries of Bullet's own shapes, and a step in which many pairs are new.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "dynamics/scenes.h"
#include "rows.h"
#include "support/random_draw.h"
#include "vps_bullet/body.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/install.h"

namespace vps::bench {

namespace {

struct FoundPoints : btCollisionWorld::ContactResultCallback {
  int count = 0;
  double least_m = 1e30;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    ++count;
    least_m = std::min<double>(least_m, point.m_distance1);
    return 0;
  }
};

/// Median of contactPairTest of a part and one of Bullet's shapes; the first query, which reads the shape, is
/// excluded.
/// @param reach_m  range of the query; 0: contact only
Row queryOf(const char* name, const Mesh& mesh, btCollisionShape& native, const Vec3& p_WN, double reach_m,
            double bound_s) {
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  btCollisionWorld world(&dispatcher, &broadphase, &config);
  bullet::install(dispatcher);
  const bullet::Body part = bullet::makeBody(mesh);
  btCollisionObject other;
  other.setCollisionShape(&native);
  other.setWorldTransform(bullet::toBt(Pose::translation(p_WN)));
  std::vector<double> times_s;
  FoundPoints found;
  for (int i = 0; i < 20; ++i) {
    found = {};
    found.m_closestDistanceThreshold = bullet::toBt(reach_m);
    const double start_s = dynamics::threadTime_s();
    world.contactPairTest(part.rigid.get(), &other, found);
    if (i > 0) times_s.push_back(dynamics::threadTime_s() - start_s);
  }
  std::sort(times_s.begin(), times_s.end());
  bullet::uninstall(dispatcher);
  return {reach_m > 0 ? "query of a distance" : "query of a pair",
          name,
          {atMost("median", times_s[times_s.size() / 2], bound_s, 1e3, "ms"),
           reported("contacts", found.count, 1, ""), reported("least distance", found.least_m, 1e3, "mm"),
           reported("points of the part", static_cast<double>(part.model->shell->size()), 1, "")},
          ""};
}

}  // namespace

void pairQueryRow(const Options&, Table& table) {
  const Mesh sphere = makeSphere(0.05, 6);
  btTriangleMesh triangles;
  for (const auto& t : sphere.triangles)
    triangles.addTriangle(bullet::toBt(sphere.vertices[t[0]]), bullet::toBt(sphere.vertices[t[1]]),
                          bullet::toBt(sphere.vertices[t[2]]));
  btBvhTriangleMeshShape mesh(&triangles, true);
  // A ring of 20 mm that sits 0.77 mm deep on a ball of 82,000 triangles.
  const char* mesh_name = "btBvhTriangleMeshShape of 81,920 triangles";
  const Mesh ring = makeTube(0.02, 0.01, 0.02, 96);
  table.add(queryOf(mesh_name, ring, mesh, {0, 0, -0.0582}, 0, 5e-3));
  table.add(queryOf(mesh_name, ring, mesh, {0, 0, -0.06408}, 10e-3, 5e-3));  // 5 mm apart
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  btConvexHullShape hull;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = test::drawnVector(normal, random);
    hull.addPoint(bullet::toBt(Vec3(0.02 * p.normalized())));
  }
  hull.setMargin(0);
  const char* hull_name = "btConvexHullShape of 200 points";
  const Mesh plate = makeBox({0.1, 0.1, 0.02});
  table.add(queryOf(hull_name, plate, hull, {0.01, 0.004, 0.0295}, 0, 1e-3));
  table.add(queryOf(hull_name, plate, hull, {0.01, 0.004, 0.035}, 10e-3, 1e-3));  // 5 mm apart
}

// Twenty gears of 23,000 points in a bin; all their pairs are new in the first step.
void firstStepRow(const Options&, Table& table) {
  const dynamics::PartMesh part = dynamics::makeHeapGear();
  dynamics::World world({dynamics::Mode::Constraint, true, dynamics::vpsEngine({0.2e-3, 0.36e-3})});
  const auto addWall = [&](const Vec3& half_m, const Vec3& center) {
    world.addShape(std::make_shared<btBoxShape>(bullet::toBt(half_m)), {}, Pose::translation(center));
  };
  addWall({0.1, 0.1, 0.01}, {0, 0, -0.01});
  for (const double side : {-1.0, 1.0}) {
    addWall({0.01, 0.1, 0.2}, {side * 0.055, 0, 0.1});
    addWall({0.1, 0.01, 0.2}, {0, side * 0.055, 0.1});
  }
  double points = 0;
  for (int i = 0; i < 20; ++i) {
    const double angle_rad = 2.399963 * i;
    const Vec3 turn = Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.3) * (0.2 + 0.11 * i);
    const Vec3 at(i & 1 ? 0.018 : -0.018, i & 2 ? 0.018 : -0.018, 0.022 + 0.03 * (i / 4));
    const dynamics::Placed placed = world.add(part, Pose(rotationFromVector(turn), at), false, 0.3);
    const auto* shape = dynamic_cast<const bullet::Shape*>(placed.body->getCollisionShape());
    points = static_cast<double>(shape->models().shell->size());
  }
  const auto stepTime_s = [&] {
    const double start_s = dynamics::threadTime_s();
    world.step();
    return dynamics::threadTime_s() - start_s;
  };
  const double first_s = stepTime_s(), second_s = stepTime_s();
  table.add({"20 gears in a bin",
             "constraint",
             {atMost("first step", first_s, 10e-3, 1e3, "ms"), reported("second", second_s, 1e3, "ms"),
              reported("points of each", points, 1, "")},
             ""});
}

}  // namespace vps::bench

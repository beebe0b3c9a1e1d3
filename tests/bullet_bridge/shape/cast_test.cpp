// SPDX-License-Identifier: BSD-3-Clause
// Rays and sweeps hit a part at the same place as Bullet's mesh shape with the same triangles, and as fast.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "bullet_bridge/world.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

using test::World;

constexpr int kCasts = 300;
constexpr double kSphere_m = 0.03, kBall_m = 0.002;
const Vec3 kCenter(0.01, 0, 0);

struct Targets {
  Mesh mesh = makeSphere(kSphere_m, 6);  // 81,920 triangles
  btTriangleMesh triangles;
  std::unique_ptr<btBvhTriangleMeshShape> bvh;
  std::unique_ptr<Shape> part;

  Targets() {
    for (const auto& t : mesh.triangles)
      triangles.addTriangle(toBt(mesh.vertices[t[0]]), toBt(mesh.vertices[t[1]]), toBt(mesh.vertices[t[2]]));
    bvh = std::make_unique<btBvhTriangleMeshShape>(&triangles, true);
    bvh->setMargin(0);  // a part has no margin
    ShapeModels models;
    models.mesh = std::make_shared<Mesh>(mesh);
    part = std::make_unique<Shape>(std::move(models));
  }
};

/// Hit fractions of casts at a shape, and the time of one cast.
struct Hits {
  std::vector<double> fractions, exact;  ///< `exact`: for a sphere instead of its facets
  double cast_us = 0;
};

/// Share of the path after which a ball touches the sphere; 1 if it never does.
double touches(const Vec3& from, const Vec3& to, double ball_m) {
  const Vec3 way = to - from, r = from - kCenter;
  const double a = way.squaredNorm(), b = r.dot(way);
  const double c = r.squaredNorm() - (kSphere_m + ball_m) * (kSphere_m + ball_m);
  return b * b < a * c ? 1 : std::min(1.0, (-b - std::sqrt(b * b - a * c)) / a);
}

template <typename Cast>
Hits castAll(btCollisionShape& shape, double ball_m, const Cast& cast) {
  World world;
  world.addShape(shape, 0, Vec3::Zero(), Pose::translation(kCenter));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> in(-0.05, 0.05);
  Hits hits;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kCasts; ++i) {
    const Vec3 from = Vec3(0, 0, 0.1) + test::drawnVector(in, random),
               to = Vec3(0, 0, -0.1) + test::drawnVector(in, random);
    hits.exact.push_back(touches(from, to, ball_m));
    hits.fractions.push_back(cast(*world.world, from, to));
  }
  hits.cast_us =
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / kCasts;
  return hits;
}

double ray(btCollisionWorld& world, const Vec3& from, const Vec3& to) {
  btCollisionWorld::ClosestRayResultCallback result(toBt(from), toBt(to));
  world.rayTest(toBt(from), toBt(to), result);
  return result.m_closestHitFraction;
}
double sweep(btCollisionWorld& world, const Vec3& from, const Vec3& to) {
  static btSphereShape ball(toBt(kBall_m));
  btCollisionWorld::ClosestConvexResultCallback result(toBt(from), toBt(to));
  world.convexSweepTest(&ball, toBt(Pose::translation(from)), toBt(Pose::translation(to)), result);
  return result.m_closestHitFraction;
}

template <typename Cast>
void expectSame(const char* what, double ball_m, const Cast& cast) {
  Targets targets;
  double best = 1e30;
  for (int repetition = 0; repetition < 5; ++repetition) {
    const Hits bvh = castAll(*targets.bvh, ball_m, cast), part = castAll(*targets.part, ball_m, cast);
    int met = 0;
    for (int i = 0; i < kCasts; ++i) {
      met += bvh.fractions[i] < 1 ? 1 : 0;
      // Bullet ends a sweep up to 10 mm before it touches (its squared tolerance is 1e-4 m2), at triangles
      // that the ball may never reach. A sweep at a part ends early at fewer triangles, and never later than
      // at the surface: facets lie up to 2 um inside of the sphere.
      ASSERT_GE(part.fractions[i], bvh.fractions[i] - 1e-6) << what << ' ' << i;
      ASSERT_LE(part.fractions[i], part.exact[i] + 1e-3) << what << ' ' << i;
      if (ball_m == 0) {
        ASSERT_NEAR(part.fractions[i], bvh.fractions[i], 1e-6) << i;
      }
    }
    EXPECT_GT(met, kCasts / 4);
    EXPECT_LT(met, kCasts);
    best = std::min(best, part.cast_us / bvh.cast_us);
    if (repetition == 0)
      std::printf("%s: %.1f us, btBvhTriangleMeshShape %.1f us\n", what, part.cast_us, bvh.cast_us);
  }
  testing::Test::RecordProperty("ratio_percent", static_cast<int>(100 * best));
  EXPECT_LT(best, 1.5) << what << ": as fast as Bullet's mesh";
}

TEST(Cast, RaysMeetAPartAsTheyMeetBulletsMesh) {
  expectSame("ray", 0, ray);
}

TEST(Cast, SweepsMeetAPartAsTheyMeetBulletsMesh) {
  expectSame("sweep", kBall_m, sweep);
}

}  // namespace
}  // namespace vps::bullet

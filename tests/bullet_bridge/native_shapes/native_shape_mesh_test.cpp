// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bullet_bridge/native_shapes.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

using test::at;
using test::kRounding_m;

TEST(NativeShapeMesh, ABoxHasEightCornersAndACylindersRimIsWithinAMicrometre) {
  const btBoxShape box(at(0.01, 0.02, 0.03));
  EXPECT_EQ(nativeShapeMesh(box).mesh.vertices.size(), 8u);
  EXPECT_LE((bounds(nativeShapeMesh(box).mesh).max - Vec3(0.01, 0.02, 0.03)).norm(), kRounding_m);
  const btCylinderShapeX cylinder(at(0.03, 0.01, 0.01));
  const NativeShapeMesh rim = nativeShapeMesh(cylinder);
  EXPECT_NEAR(bounds(rim.mesh).max.x(), 0.03, kRounding_m);
  for (const auto& t : rim.mesh.triangles) {
    const Vec3 middle = 0.5 * (rim.mesh.vertices[t[0]] + rim.mesh.vertices[t[1]]);
    const double radius_m = std::hypot(middle.y(), middle.z());
    if (std::abs(rim.mesh.vertices[t[0]].x()) > 0.029 && radius_m > 0.009) {
      EXPECT_GE(radius_m, 0.01 - 1.01e-6);
    }
  }
}

// Lower bound: the maximum of n.p - h(n) over the vertices n of a fine sphere.
double distanceBySupport(const btConvexShape& shape, const Vec3& p) {
  static const std::vector<Vec3> directions = makeSphere(1, 6).vertices;
  double best = -1e30;
  for (const Vec3& n : directions)
    best = std::max(best, n.dot(p - fromBt(shape.localGetSupportingVertex(toBt(n)))));
  return best;
}

TEST(Primitive, DistanceToAMultiSphereIsThatOfItsSupportFunction) {
  const btVector3 centers[4] = {at(0, 0, 0), at(0.02, 0, 0), at(0, 0.03, 0), at(0.005, 0.005, 0.02)};
  const btScalar radii[4] = {toBt(0.005), toBt(0.008), toBt(0.002), toBt(0.004)};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.02, 0.05);
  for (int count = 1; count <= 4; ++count) {
    btMultiSphereShape shape(centers, radii, count);
    ASSERT_TRUE(isPrimitive(shape));
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = test::drawnVector(coordinate, random);
      const SurfaceDistance d = primitiveDistance(shape, p);
      // Error of the lower bound with 40,962 directions: 0.6 degrees times the distance to the support, 0.07
      // m, where two spheres meet. Upper bound: the foot must lie on the hull.
      EXPECT_NEAR(d.distance_m, distanceBySupport(shape, p), 0.07 * std::sin(0.6 / 57.3)) << p.transpose();
      EXPECT_GE(d.distance_m, distanceBySupport(shape, p) - kRounding_m);
      EXPECT_NEAR(d.n.norm(), 1, 1e-12);
      EXPECT_NEAR(primitiveDistance(shape, p - d.distance_m * d.n).distance_m, 0, 1e-9);
    }
  }
}

TEST(Primitive, DistanceToAConeIsThatToItsMesh) {
  const btConeShape cone(toBt(0.01), toBt(0.03));
  const MeshDistance mesh(nativeShapeMesh(cone).mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.025, 0.025);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = test::drawnVector(coordinate, random);
    // The mesh's chords are within 1 um of the cone's circles.
    EXPECT_NEAR(primitiveDistance(cone, p).distance_m, mesh.signedDistance(p), 1e-6 + kRounding_m)
        << p.transpose();
  }
}

}  // namespace
}  // namespace vps::bullet

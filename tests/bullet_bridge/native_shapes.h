// SPDX-License-Identifier: BSD-3-Clause
// Shapes of Bullet for tests of contact with a bullet::Shape, a cube to put on them, and queries.
#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_bridge/world.h"

namespace vps::test {

// Rounding of Bullet's arithmetic on coordinates of centimetres: 4 nm in floats, and a few of those add up.
inline constexpr double kRounding_m = kIsDouble ? 1e-9 : 5e-8;
inline constexpr double kSpacing_m = 1e-3;
inline constexpr double kHalf_m = 0.005;

inline btVector3 at(double x, double y, double z) {
  return {bullet::toBt(x), bullet::toBt(y), bullet::toBt(z)};
}

/// A shape with a level top at z = 0 around the origin, together with the objects that it refers to.
struct Ground {
  btCollisionShape* shape = nullptr;
  Pose X_WB;
  double tolerance_m = 0;  ///< error of the height, in addition to rounding
  std::vector<std::shared_ptr<void>> kept;

  template <typename T, typename... A>
  T& keep(A&&... a) {
    // Bullet's shapes need aligned memory, which their operator new provides.
    std::shared_ptr<T> made(new T(std::forward<A>(a)...));
    kept.push_back(made);
    return *made;
  }
};

inline constexpr double kWide_m = 0.04;

inline std::vector<btVector3> slabCorners(double wide_m, double low_m, double high_m) {
  std::vector<btVector3> corners;
  for (int c = 0; c < 8; ++c)
    corners.push_back(at(c & 1 ? wide_m : -wide_m, c & 2 ? wide_m : -wide_m, c & 4 ? high_m : low_m));
  return corners;
}

inline btTriangleMesh& slabMesh(Ground& ground, double scale = 1) {
  btTriangleMesh& mesh = ground.keep<btTriangleMesh>();
  const Mesh box = makeBox(Vec3(2 * kWide_m, 2 * kWide_m, 0.02) * scale);
  for (const auto& t : box.triangles) {
    btVector3 p[3];
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = bullet::toBt(Vec3(box.vertices[t[k]] - Vec3(0, 0, 0.01 * scale)));
    mesh.addTriangle(p[0], p[1], p[2]);
  }
  return mesh;
}

inline btTriangleMesh& floorMesh(Ground& ground) {
  btTriangleMesh& mesh = ground.keep<btTriangleMesh>();
  mesh.addTriangle(at(-kWide_m, -kWide_m, 0), at(kWide_m, -kWide_m, 0), at(kWide_m, kWide_m, 0));
  mesh.addTriangle(at(-kWide_m, -kWide_m, 0), at(kWide_m, kWide_m, 0), at(-kWide_m, kWide_m, 0));
  return mesh;
}

inline btConvexHullShape& slabHull(Ground& ground, double scale = 1) {
  auto& hull = ground.keep<btConvexHullShape>();
  for (const btVector3& p : slabCorners(kWide_m * scale, -0.02 * scale, 0)) hull.addPoint(p);
  return hull;
}

/// All points that a query reports; `first` is the query's first body.
struct Points : btCollisionWorld::ContactResultCallback {
  std::vector<btManifoldPoint> points;
  explicit Points(double threshold_m = 0) { m_closestDistanceThreshold = bullet::toBt(threshold_m); }
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    points.push_back(point);
    first = a->getCollisionObject();
    return 0;
  }
  const btCollisionObject* first = nullptr;
  [[nodiscard]] double least_m() const {
    double least = 1e30;
    for (const btManifoldPoint& p : points) least = std::min<double>(least, p.getDistance());
    return least;
  }
};

// User-defined shape types.
struct UserConvex : btConvexInternalShape {
  btVector3 half;
  explicit UserConvex(const btVector3& half_m) : half(half_m) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    setMargin(0);
  }
  [[nodiscard]] btVector3 localGetSupportingVertexWithoutMargin(const btVector3& v) const override {
    return {v.x() < 0 ? -half.x() : half.x(), v.y() < 0 ? -half.y() : half.y(),
            v.z() < 0 ? -half.z() : half.z()};
  }
  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* v, btVector3* out,
                                                         int n) const override {
    for (int i = 0; i < n; ++i) out[i] = localGetSupportingVertexWithoutMargin(v[i]);
  }
  void calculateLocalInertia(btScalar, btVector3&) const override {}
  const char* getName() const override { return "UserConvex"; }
};
struct UserPolyhedron : btConvexHullShape {
  UserPolyhedron() { m_shapeType = CUSTOM_POLYHEDRAL_SHAPE_TYPE; }
};
struct UserConcave : btConcaveShape {
  const btConcaveShape* other = nullptr;  // the shape whose triangles this one reports
  btVector3 one{1, 1, 1};
  UserConcave() { m_shapeType = CUSTOM_CONCAVE_SHAPE_TYPE; }
  void getAabb(const btTransform& X, btVector3& low, btVector3& high) const override {
    other->getAabb(X, low, high);
  }
  void processAllTriangles(btTriangleCallback* visit, const btVector3& low,
                           const btVector3& high) const override {
    other->processAllTriangles(visit, low, high);
  }
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return one; }
  void calculateLocalInertia(btScalar, btVector3&) const override {}
  const char* getName() const override { return "UserConcave"; }
};

}  // namespace vps::test

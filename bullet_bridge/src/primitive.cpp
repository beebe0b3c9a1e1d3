// SPDX-License-Identifier: BSD-3-Clause
#include "primitive.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"

namespace vps {

namespace {

// Around a point: the distance to it less the radius.
SurfaceDistance aroundPoint(const Vec3& p_from_center, double radius_m) {
  const double r = p_from_center.norm();
  return {r - radius_m, r > 0 ? Vec3(p_from_center / r) : Vec3::UnitZ().eval()};
}

// A product of intervals: q are the distances to each pair of faces, n_i the faces' normals.
// Outside, the faces that are passed add up as in Pythagoras; inside, the nearest face counts.
template <int N>
SurfaceDistance productDistance(const double (&q)[N], const Vec3 (&normals)[N]) {
  Vec3 outside = Vec3::Zero();
  int nearest = 0, passed = 0;
  for (int i = 0; i < N; ++i) {
    if (q[i] > 0) {
      outside += q[i] * normals[i];
      ++passed;
    }
    if (q[i] > q[nearest]) nearest = i;
  }
  if (q[nearest] <= 0) return {q[nearest], normals[nearest]};
  const double d = outside.norm();
  return {d, outside / d, passed > 1};
}

Vec3 signedAxis(int axis, double coordinate) {
  return (coordinate < 0 ? -1.0 : 1.0) * Vec3(Vec3::Unit(axis));
}

SurfaceDistance boxDistance(const Vec3& half, const Vec3& p) {
  const double q[3] = {std::abs(p.x()) - half.x(), std::abs(p.y()) - half.y(), std::abs(p.z()) - half.z()};
  const Vec3 normals[3] = {signedAxis(0, p.x()), signedAxis(1, p.y()), signedAxis(2, p.z())};
  return productDistance(q, normals);
}

SurfaceDistance cylinderDistance(int axis, double radius_m, double half_m, const Vec3& p) {
  Vec3 radial = p;
  radial[axis] = 0;
  const double r = radial.norm();
  const double q[2] = {r - radius_m, std::abs(p[axis]) - half_m};
  const Vec3 normals[2] = {r > 0 ? Vec3(radial / r) : Vec3(Vec3::Unit((axis + 1) % 3)),
                           signedAxis(axis, p[axis])};
  return productDistance(q, normals);
}

}  // namespace

bool isPrimitive(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
    case BOX_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
    case CYLINDER_SHAPE_PROXYTYPE:
      return true;
    default:
      return false;
  }
}

SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE: {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      const Vec3 n = fromBt(plane.getPlaneNormal());
      return {n.dot(p) - plane.getPlaneConstant(), n};
    }
    case BOX_SHAPE_PROXYTYPE:
      return boxDistance(fromBt(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()), p);
    case SPHERE_SHAPE_PROXYTYPE:
      return aroundPoint(p, static_cast<const btSphereShape&>(shape).getRadius());
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      const int axis = capsule.getUpAxis();
      const double half_m = capsule.getHalfHeight();
      Vec3 p_from_segment = p;
      p_from_segment[axis] -= std::clamp(p[axis], -half_m, half_m);
      return aroundPoint(p_from_segment, capsule.getRadius());
    }
    default: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const int axis = cylinder.getUpAxis();
      return cylinderDistance(axis, cylinder.getRadius(), cylinder.getHalfExtentsWithMargin()[axis], p);
    }
  }
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>

#include <algorithm>
#include <cmath>

#include "native_shapes/native_shape_adapter.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// Distance to a sphere about a point.
SurfaceDistance aroundPoint(const Vec3& p_from_center, double radius_m) {
  const double r = p_from_center.norm();
  return {r - radius_m, r > 0 ? Vec3(p_from_center / r) : Vec3::UnitZ().eval()};
}

// Distance to a product of intervals. q holds the distance to each pair of faces, with their normals.
// Outside, the positive values are components of the distance; inside, the nearest face counts.
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

struct Point2 {
  double x, y;
};

// Parameter from 0 (a) to 1 (b) of the point of segment ab nearest to p.
double nearestShare(const Point2& p, const Point2& a, const Point2& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
}

// In the half plane of axis (y) and radius (x), the section of a cone is the triangle of rim, apex and centre
// of the base.
//
//   apex
//    |  .      inside: below the side and above the base
//    |    .
//   base---rim
SurfaceDistance coneDistance(int axis, double radius_m, double height_m, const Vec3& p) {
  Vec3 radial = p;
  radial[axis] = 0;
  const double r = radial.norm();
  const Vec3 out = r > 0 ? Vec3(radial / r) : Vec3(Vec3::Unit((axis + 1) % 3));
  const Point2 at{r, p[axis]}, rim{radius_m, -height_m / 2}, apex{0, height_m / 2}, base{0, -height_m / 2};
  const double slant_m = std::hypot(radius_m, height_m);
  const Point2 side_n{height_m / slant_m, radius_m / slant_m};
  const double above_side_m = (at.x - rim.x) * side_n.x + (at.y - rim.y) * side_n.y;
  const double below_base_m = base.y - at.y;
  const Vec3 side_normal = side_n.x * out + side_n.y * Vec3(Vec3::Unit(axis));
  const Vec3 base_normal = -Vec3(Vec3::Unit(axis));
  if (above_side_m <= 0 && below_base_m <= 0)
    return above_side_m > below_base_m ? SurfaceDistance{above_side_m, side_normal}
                                       : SurfaceDistance{below_base_m, base_normal};
  SurfaceDistance nearest{1e300, base_normal};
  for (const Point2& start : {apex, base}) {
    const double share = nearestShare(at, start, rim);
    const Point2 q{start.x + share * (rim.x - start.x), start.y + share * (rim.y - start.y)};
    const double dx = at.x - q.x, dy = at.y - q.y, d = std::hypot(dx, dy);
    if (d >= nearest.distance_m) continue;
    const bool is_corner = share == 1 || (share == 0 && start.y > 0);
    const Vec3& face_normal = start.y > 0 ? side_normal : base_normal;
    nearest = {d, d > 0 ? Vec3(dx / d * out + dy / d * Vec3(Vec3::Unit(axis))) : face_normal, is_corner};
  }
  return nearest;
}

constexpr int kMaxSpheres = 12;

struct Sphere {
  Vec3 center;
  double radius_m;
};

// The signed distance of a convex solid is the maximum over unit vectors n of n.p - h(n), with its support
// function h. For the hull of spheres h(n) = max n.c_i + r_i, so d = max over n of g(n), with g(n) = min over
// i of n.(p - c_i) - r_i. At a maximum of g on the unit sphere the minimum is attained by one, two or three
// spheres: all such n are tried.
class SphereHull {
 public:
  SphereHull(const Sphere* spheres, int count, const Vec3& p) : spheres_(spheres), count_(count), p_(p) {
    for (int i = 0; i < count_; ++i) {
      consider(from(i).normalized());
      for (int j = i + 1; j < count_; ++j) {
        considerPair(i, j);
        for (int k = j + 1; k < count_; ++k) considerTriple(i, j, k);
      }
    }
  }
  [[nodiscard]] const SurfaceDistance& best() const { return best_; }

 private:
  [[nodiscard]] Vec3 from(int i) const { return p_ - spheres_[i].center; }

  void consider(const Vec3& n) {
    if (!(n.squaredNorm() > 0.5)) return;  // a point at a sphere's centre has no direction
    double least = 1e300;
    for (int i = 0; i < count_; ++i) least = std::min(least, n.dot(from(i)) - spheres_[i].radius_m);
    if (least > best_.distance_m) best_ = {least, n};
  }
  // Directions with equal values for two spheres: n.u = a along the axis u between them, and otherwise
  // towards p.
  void considerPair(int i, int j) {
    const Vec3 between = spheres_[j].center - spheres_[i].center;
    const double length = between.norm(), a = (spheres_[i].radius_m - spheres_[j].radius_m) / length;
    if (!(std::abs(a) < 1)) return;  // one sphere contains the other
    const Vec3 u = between / length;
    Vec3 w = from(i) - u * u.dot(from(i));
    if (!(w.norm() > 1e-12 * length)) w = u.unitOrthogonal();  // on the axis all directions are equal
    consider(a * u + std::sqrt(1 - a * a) * w.normalized());
  }
  // Directions with equal values for three spheres: n = s + t m, with s in their plane and m the plane's
  // normal.
  void considerTriple(int i, int j, int k) {
    const Vec3 u = spheres_[j].center - spheres_[i].center, v = spheres_[k].center - spheres_[i].center;
    const Vec3 m = u.cross(v);
    const double m2 = m.squaredNorm();
    if (!(m2 > 1e-18 * u.squaredNorm() * v.squaredNorm())) return;  // collinear: covered by pairs
    const double au = spheres_[i].radius_m - spheres_[j].radius_m;
    const double av = spheres_[i].radius_m - spheres_[k].radius_m;
    const Vec3 s = (au * v.cross(m) + av * m.cross(u)) / m2;
    if (!(s.squaredNorm() < 1)) return;
    const Vec3 t = std::sqrt((1 - s.squaredNorm()) / m2) * m;
    consider(s + t);
    consider(s - t);
  }

  const Sphere* spheres_;
  int count_;
  Vec3 p_;
  SurfaceDistance best_{-1e300, Vec3::UnitZ()};
};

bool isEven(const btVector3& scale) {
  return scale.x() > 0 && scale.x() == scale.y() && scale.y() == scale.z();
}

SurfaceDistance multiSphereDistance(const btMultiSphereShape& shape, const Vec3& p) {
  Sphere spheres[kMaxSpheres];
  const double scale = shape.getLocalScaling().x();
  for (int i = 0; i < shape.getSphereCount(); ++i)
    spheres[i] = {scale * fromBt(shape.getSpherePosition(i)), scale * shape.getSphereRadius(i)};
  return SphereHull(spheres, shape.getSphereCount(), p).best();
}

SurfaceDistance scaledDistance(const btUniformScalingShape& shape, const Vec3& p) {
  const double scale = shape.getUniformScalingFactor();
  SurfaceDistance at = primitiveDistance(*shape.getChildShape(), p / scale);
  at.distance_m *= scale;
  return at;
}

}  // namespace

bool isPrimitive(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case STATIC_PLANE_PROXYTYPE:
    case BOX_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
    case CYLINDER_SHAPE_PROXYTYPE:
    case CONE_SHAPE_PROXYTYPE:
      return true;
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return static_cast<const btMultiSphereShape&>(shape).getSphereCount() <= kMaxSpheres &&
             isEven(shape.getLocalScaling());
    case UNIFORM_SCALING_SHAPE_PROXYTYPE: {
      const auto& scaled = static_cast<const btUniformScalingShape&>(shape);
      return scaled.getUniformScalingFactor() > 0 && isPrimitive(*scaled.getChildShape());
    }
    default:
      return primitiveOf(shape) != nullptr;
  }
}

bool hasCorners(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
    case CYLINDER_SHAPE_PROXYTYPE:
    case CONE_SHAPE_PROXYTYPE:
      return true;
    case UNIFORM_SCALING_SHAPE_PROXYTYPE:
      return hasCorners(*static_cast<const btUniformScalingShape&>(shape).getChildShape());
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
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      return coneDistance(cone.getConeUpIndex(), cone.getRadius(), cone.getHeight(), p);
    }
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return multiSphereDistance(static_cast<const btMultiSphereShape&>(shape), p);
    case UNIFORM_SCALING_SHAPE_PROXYTYPE:
      return scaledDistance(static_cast<const btUniformScalingShape&>(shape), p);
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const int axis = cylinder.getUpAxis();
      return cylinderDistance(axis, cylinder.getRadius(), cylinder.getHalfExtentsWithMargin()[axis], p);
    }
    default:
      return primitiveDistance(*primitiveOf(shape), p);
  }
}

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/refinement/curved_contact.h"

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "native_shapes/native_shape.h"
#include "shape/sheet_border.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

using Point = std::optional<Vec3>;

// The extreme point in a direction on the circle of radius r about the axis at height h. Returns no point for
// a direction along the axis.
Point onCircle(int axis, double radius_m, double height_m, const Vec3& direction) {
  Vec3 radial = direction;
  radial[axis] = 0;
  if (!(radial.norm() > kSinGrazing)) return {};
  return Vec3(radius_m * radial.normalized() + height_m * Vec3(Vec3::Unit(axis)));
}

Point onCylinder(const btCylinderShape& shape, const SurfaceDistance& at, const Vec3& p, const Vec3& inward) {
  const int axis = shape.getUpAxis();
  if (at.is_edge || std::abs(at.n[axis]) > 0.5) return {};  // at a rim or an end
  return onCircle(axis, shape.getRadius(), p[axis], inward);
}

Point onCone(const btConeShape& shape, const SurfaceDistance& at, const Vec3& p, const Vec3& inward) {
  const int axis = shape.getConeUpIndex();
  if (at.is_edge || at.n[axis] < 0) return {};
  const double height_m = (p - at.distance_m * at.n)[axis];
  const double radius_m = shape.getRadius() * (0.5 - height_m / shape.getHeight());
  return onCircle(axis, std::max(radius_m, 0.0), height_m, inward);
}

// The extreme point on the part of the hull nearest to p: one sphere, or the cone between two spheres. Where
// three spheres are active the hull is flat.
Point onMultiSphere(const btMultiSphereShape& shape, const SurfaceDistance& at, const Vec3& p,
                    const Vec3& inward) {
  const double scale = shape.getLocalScaling().x();
  Vec3 centers[2];
  double radii_m[2] = {0, 0};
  int active = 0;
  for (int i = 0; i < shape.getSphereCount(); ++i) {
    const Vec3 center = scale * fromBt(shape.getSpherePosition(i));
    const double radius_m = scale * shape.getSphereRadius(i);
    if (at.n.dot(p - center) - radius_m > at.distance_m + kRounding_m) continue;
    if (active == 2) return {};
    centers[active] = center;
    radii_m[active++] = radius_m;
  }
  if (active == 0) return {};
  double share = 0;
  if (active == 2) {
    const Vec3 a = centers[0] + radii_m[0] * at.n, b = centers[1] + radii_m[1] * at.n;
    share = std::clamp((p - at.distance_m * at.n - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  }
  const double radius_m = radii_m[0] + share * (radii_m[1] - radii_m[0]);
  return Vec3(centers[0] + share * (centers[1] - centers[0]) + radius_m * inward);
}

// A point of the solid, near the surface point nearest to p, that is extreme in the direction of a face's
// inward normal; in the shape's frame.
Point farthestPoint(const btCollisionShape& shape, const SurfaceDistance& at, const Vec3& p,
                    const Vec3& inward) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return Vec3(static_cast<const btSphereShape&>(shape).getRadius() * inward);
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      const int axis = capsule.getUpAxis();
      Vec3 center = Vec3::Zero();
      const double half_m = capsule.getHalfHeight();
      center[axis] = std::clamp(p[axis], -half_m, half_m);
      return Vec3(center + capsule.getRadius() * inward);
    }
    case CYLINDER_SHAPE_PROXYTYPE:
      return onCylinder(static_cast<const btCylinderShape&>(shape), at, p, inward);
    case CONE_SHAPE_PROXYTYPE:
      return onCone(static_cast<const btConeShape&>(shape), at, p, inward);
    case MULTI_SPHERE_SHAPE_PROXYTYPE:
      return onMultiSphere(static_cast<const btMultiSphereShape&>(shape), at, p, inward);
    case UNIFORM_SCALING_SHAPE_PROXYTYPE: {
      const auto& scaled = static_cast<const btUniformScalingShape&>(shape);
      const double scale = scaled.getUniformScalingFactor();
      const SurfaceDistance child_at{at.distance_m / scale, at.n, at.is_edge};
      const Point x = farthestPoint(*scaled.getChildShape(), child_at, p / scale, inward);
      return x ? Point(scale * *x) : x;
    }
    default:
      return {};
  }
}

double leastRadius_m(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return static_cast<const btSphereShape&>(shape).getRadius();
    case CAPSULE_SHAPE_PROXYTYPE:
      return static_cast<const btCapsuleShape&>(shape).getRadius();
    case CYLINDER_SHAPE_PROXYTYPE:
      return static_cast<const btCylinderShape&>(shape).getRadius();
    case CONE_SHAPE_PROXYTYPE:
      return 0;  // at the tip of the cone
    case MULTI_SPHERE_SHAPE_PROXYTYPE: {
      const auto& spheres = static_cast<const btMultiSphereShape&>(shape);
      double least_m = 1e30;
      for (int i = 0; i < spheres.getSphereCount(); ++i)
        least_m = std::min<double>(least_m, spheres.getLocalScaling().x() * spheres.getSphereRadius(i));
      return least_m;
    }
    case UNIFORM_SCALING_SHAPE_PROXYTYPE: {
      const auto& scaled = static_cast<const btUniformScalingShape&>(shape);
      return scaled.getUniformScalingFactor() * leastRadius_m(*scaled.getChildShape());
    }
    default:
      return 1e30;
  }
}

/// The nearest point of the part's exact surface to x, in the models' frame.
struct OwnFoot {
  double distance_m = 1e30;  ///< distance of x, negative inside the part or behind a sheet
  Vec3 q = Vec3::Zero(), outward = Vec3::Zero();
};

// A sheet is taken as seen by a point with this inward normal.
OwnFoot footOnOwn(const ShapeModels& models, const Vec3& x_M, const Vec3& inward_M, double max_m) {
  OwnFoot nearest;
  for (const Surface& surface : models.surfaces) {
    const Vec3 x = surface.X_MP.inverse() * x_M;
    const MeshDistance::Closest closest = surface.distance->closest(x, max_m);
    if (!closest.found) continue;
    Vec3 n = closest.normal;
    if (surface.sheet)
      n = surface.sheet->seenFrom(x, -(surface.X_MP.R.transpose() * inward_M), closest).normal;
    const double d = n.dot(x - closest.q) < 0 ? -closest.distance_m : closest.distance_m;
    if (d < nearest.distance_m) nearest = {d, surface.X_MP * closest.q, surface.X_MP.R * n};
  }
  return nearest;
}

}  // namespace

double roundReach_m(const btCollisionShape& primitive, double spacing_m) {
  const double radius_m = leastRadius_m(primitive);
  return std::min(spacing_m, spacing_m * spacing_m / (2 * std::max(radius_m, 1e-12)));
}

bool refineOnRound(Candidate& c, const SideView& side, const SideView& other,
                   const btCollisionShape& primitive) {
  const ShapeModels& models = side.shape->models();
  if (models.surfaces.empty() || side.shape->isEdgePoint(c.id)) return false;
  const Pose X_SM = other.X_WM.inverse() * side.X_WM;
  const Vec3 &p_M = models.shell->points[c.id], &inward_M = models.shell->inward[c.id];
  const Vec3 p = X_SM * p_M, inward = X_SM.R * inward_M;
  const SurfaceDistance at = primitiveDistance(primitive, p);
  if (at.n.dot(inward) < kSinGrazing) return false;
  const Point x = farthestPoint(primitive, at, p, inward);
  // A face in a socket of nearly the same radius touches at its shell point; no surface query is needed.
  if (!x || at.distance_m - (p - *x).dot(inward) < kSameGap_m) return false;
  const Vec3 x_M = X_SM.inverse() * *x;
  const OwnFoot foot =
      footOnOwn(models, x_M, inward_M, 1.001 * (x_M - p_M).norm());  // p itself is on the surface
  if (!(foot.distance_m < at.distance_m)) return false;
  const Vec3 n_M =
      std::abs(foot.distance_m) > kRounding_m ? Vec3((foot.q - x_M) / foot.distance_m) : Vec3(-foot.outward);
  c.p_W = side.X_WM * foot.q;
  c.n_W = (side.side == 0 ? 1 : -1) * (side.X_WM.R * n_M);
  c.distance_m = foot.distance_m;
  return true;
}

}  // namespace vps::bullet

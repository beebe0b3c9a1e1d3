// SPDX-License-Identifier: BSD-3-Clause
#include "shape/triangle_tree.h"

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <algorithm>

#include "vps_bullet/convert.h"

namespace vps::bullet {

/// A box of half extents `half` that moves from `from` by `way`.
struct Shape::TriangleTree::Path {
  Vec3 from, way, half;

  /// True if the moving box meets `box` within this share of its path.
  [[nodiscard]] bool meets(const Box& box, double share) const {
    double enter = 0, leave = share;
    for (int k = 0; k < 3; ++k) {
      const double low = box.min[k] - half[k] - from[k], high = box.max[k] + half[k] - from[k];
      if (way[k] == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const double a = low / way[k], b = high / way[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
  }
};

Shape::TriangleTree::TriangleTree(const Mesh& mesh, const Pose& X_SM)
    : mesh_(transformed(mesh, X_SM)), tree_(triangleBoxes(mesh_), 4, BoxTree::Axis::OfBoxes) {}

void Shape::TriangleTree::visit(const Box& box, btTriangleCallback& callback) const {
  tree_.forEach([&box](const Box& of_node) { return overlap(of_node, box); },
                [&](std::uint32_t triangle) {
                  if (overlap(boxOf(triangle), box)) report(triangle, callback);
                });
}

bool Shape::TriangleTree::visitCast(const Box& box, btTriangleCallback& callback) const {
  // Bullet adds a margin for rounding to the box of the path. The margin is more than 1e-6 of the box's size.
  const double rounding_m = 1e-6 * box.size().norm();
  if (auto* ray = dynamic_cast<btTriangleRaycastCallback*>(&callback)) {
    const Vec3 from = fromBt(ray->m_from);
    visitPath({from, fromBt(ray->m_to) - from, Vec3(Vec3::Constant(rounding_m))}, ray->m_hitFraction,
              callback);
    return true;
  }
  const auto* cast = dynamic_cast<btTriangleConvexcastCallback*>(&callback);
  if (!cast) return false;
  // A turning shape may need more room on its path than at both ends; the caller then uses Bullet's box.
  if (!(cast->m_convexShapeFrom.getBasis() == cast->m_convexShapeTo.getBasis())) return false;
  const btTransform to_shape = cast->m_triangleToWorld.inverse();
  const btTransform start = to_shape * cast->m_convexShapeFrom;
  btVector3 low, high;
  cast->m_convexShape->getAabb(start, low, high);
  const Vec3 from = 0.5 * (fromBt(low) + fromBt(high)), half = 0.5 * (fromBt(high) - fromBt(low));
  const Vec3 way = fromBt((to_shape * cast->m_convexShapeTo).getOrigin() - start.getOrigin());
  const Vec3 margin = Vec3::Constant(rounding_m + cast->m_triangleCollisionMargin);
  visitPath({from, way, half + margin}, cast->m_hitFraction, callback);
  return true;
}

void Shape::TriangleTree::visitPath(const Path& path, const btScalar& share,
                                    btTriangleCallback& callback) const {
  tree_.forEach([&](const Box& of_node) { return path.meets(of_node, share); },
                [&](std::uint32_t triangle) {
                  if (path.meets(boxOf(triangle), share)) report(triangle, callback);
                });
}

Box Shape::TriangleTree::boxOf(std::uint32_t triangle) const {
  Box box;
  for (const std::uint32_t v : mesh_.triangles[triangle]) box.add(mesh_.vertices[v]);
  return box;
}

void Shape::TriangleTree::report(std::uint32_t triangle, btTriangleCallback& callback) const {
  btVector3 corners[3];
  for (std::size_t v = 0; v < 3; ++v) corners[v] = toBt(mesh_.vertices[mesh_.triangles[triangle][v]]);
  callback.processTriangle(corners, 0, static_cast<int>(triangle));
}

}  // namespace vps::bullet

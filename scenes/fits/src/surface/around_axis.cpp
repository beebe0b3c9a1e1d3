// SPDX-License-Identifier: BSD-3-Clause
#include "surface/around_axis.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

void AxisExtent::add(const AxisExtent& other) {
  from_m = std::min(from_m, other.from_m);
  to_m = std::max(to_m, other.to_m);
  nearest_m = std::min(nearest_m, other.nearest_m);
  farthest_m = std::max(farthest_m, other.farthest_m);
}

namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Distance of the origin from a triangle. The triangle may be degenerate, since facets may be seen edge-on.
double distanceToOrigin(const std::array<Vec2, 3>& t) {
  double turns[3], nearest = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 &a = t[i], &b = t[(i + 1) % 3], along = b - a;
    turns[i] = cross(a, b);
    const double length2 = along.squaredNorm();
    const double fraction = length2 > 0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (a + fraction * along).norm());
  }
  const bool is_within =
      (turns[0] > 0 && turns[1] > 0 && turns[2] > 0) || (turns[0] < 0 && turns[1] < 0 && turns[2] < 0);
  return is_within ? 0 : nearest;
}

}  // namespace

AxisExtent axisExtent(const Triangle& t, const Vec3& center, const Vec3& axis, const Vec3& u, const Vec3& v) {
  AxisExtent extent;
  std::array<Vec2, 3> seen;  // corners projected along the axis
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 r = t[k] - center;
    const double along_m = axis.dot(r);
    extent.from_m = std::min(extent.from_m, along_m);
    extent.to_m = std::max(extent.to_m, along_m);
    seen[k] = {u.dot(r), v.dot(r)};
    extent.farthest_m = std::max(extent.farthest_m, seen[k].norm());
  }
  extent.nearest_m = distanceToOrigin(seen);
  return extent;
}

AxisExtents::AxisExtents(const PartSurface& part, const Vec3& axis, const Vec3& center)
    : nodes(part.tree().nodes().size()), triangles(part.mesh().triangles.size()) {
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  StridedPoll poll;
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    poll(), triangles[i] = axisExtent(part.triangle(i), center, axis, u, v);
  const auto& tree = part.tree().nodes();
  for (std::size_t n = tree.size(); n-- > 0;) {  // child nodes follow their parents
    if (!tree[n].isLeaf()) {
      nodes[n].add(nodes[n + 1]);
      nodes[n].add(nodes[tree[n].right]);
      continue;
    }
    for (std::uint32_t i = tree[n].first; i < tree[n].end; ++i)
      nodes[n].add(triangles[part.tree().order()[i]]);
  }
}

}  // namespace vps::scenes

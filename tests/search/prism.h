// SPDX-License-Identifier: BSD-3-Clause
// Polygons and prisms: closed, outward meshes with sharp edges.
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "vps/mesh.h"

namespace vps::search {

using Vec2 = Eigen::Vector2d;
/// A simple polygon, counter-clockwise.
using Polygon = std::vector<Vec2>;

Polygon rectangle(const Vec2& low, const Vec2& high);
/// A regular polygon around the origin; `inner_m` is the radius of its inscribed circle.
Polygon regularPolygon(int sides, double inner_m);
/// The polygon with every side moved outwards by the distance, which is the clearance between a solid and a
/// hole of the enlarged polygon. No side may vanish.
Polygon enlarged(const Polygon& polygon, double by_m);

/// Thrown for a polygon whose sides cross or touch, or are too near to each other for rounding.
struct NotSimple : std::invalid_argument {
  NotSimple() : std::invalid_argument("the polygon is not simple") {}
};

/// The prism over the outline without the holes, from z = low_m to z = high_m. Throws NotSimple.
Mesh makePrism(const Polygon& outline, const std::vector<Polygon>& holes, double low_m, double high_m);
/// The prism rotated so that its polygon is in the (y, z) plane and its axis along x.
Mesh alongX(const Mesh& prism);

/// The tetrahedron of four corners in any order: closed, facing outwards.
Mesh makeTetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace vps::search

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
/// Regular, around the origin; `inner_m` is the radius of the circle within.
Polygon regularPolygon(int sides, double inner_m);
/// Every side moved outwards by the distance, so that a solid and a hole of the enlarged polygon have that
/// much air between parallel sides. Sides must stay.
Polygon enlarged(const Polygon& polygon, double by_m);

/// A polygon whose sides cross or touch, or come too near for rounding.
struct NotSimple : std::invalid_argument {
  NotSimple() : std::invalid_argument("the polygon is not simple") {}
};

/// The polygon without its holes, from z = low to z = high. Throws NotSimple.
Mesh makePrism(const Polygon& outline, const std::vector<Polygon>& holes, double low_m, double high_m);
/// The prism with its polygon in the (y, z) plane, along x.
Mesh alongX(const Mesh& prism);

/// Four random corners. Closed, outward.
Mesh makeTetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace vps::search

// SPDX-License-Identifier: BSD-3-Clause
// Measures around an axis: how far facets are from it, and the facets in a slab across it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "surface/part_surface.h"
#include "surface/placed_surface.h"
#include "surface/surface_piece.h"

namespace vps::scenes {

/// Ranges along and around an axis of rotation; a rotation about the axis changes neither.
struct AxisExtent {
  double from_m = 1e300, to_m = -1e300;      ///< range along the axis, from the centre of rotation
  double nearest_m = 1e300, farthest_m = 0;  ///< range of the distance from the axis

  void add(const AxisExtent& other);
  /// Whether an extent that turns about the axis, and advances along it by a distance between along_m[0] and
  /// along_m[1], can come within within_m of the other extent.
  [[nodiscard]] bool reaches(const AxisExtent& other, double within_m,
                             const std::array<double, 2>& along_m = {}) const {
    return from_m + along_m[0] <= other.to_m + within_m && other.from_m <= to_m + along_m[1] + within_m &&
           nearest_m <= other.farthest_m + within_m && other.nearest_m <= farthest_m + within_m;
  }
};

/// The extent of a triangle around an axis.
/// @param u, v unit vectors perpendicular to the axis
AxisExtent axisExtent(const Triangle& t, const Vec3& center, const Vec3& axis, const Vec3& u, const Vec3& v);

/// The extents of all nodes and triangles of a part around an axis in the part's frame. O(n).
struct AxisExtents {
  std::vector<AxisExtent> nodes, triangles;
  AxisExtents(const PartSurface& part, const Vec3& axis, const Vec3& center);
};

/// The facets of a part, clipped to a slab across an axis.
class NearAxis {
 public:
  /// @param of the part, which must outlive the object
  /// @param axis_W unit vector
  /// @param half_length_m half the thickness of the slab around at_W
  NearAxis(const Vec3& axis_W, const Vec3& at_W, const PlacedSurface& of, double half_length_m)
      : of_(of),
        axis_(axis_W),
        at_(at_W),
        u_(axis_.unitOrthogonal()),
        v_(axis_.cross(u_)),
        half_m_(half_length_m) {}

  /// The clipped facet, in coordinates along u, v and the axis. The polygon has fewer than three corners if
  /// the facet is outside the slab.
  [[nodiscard]] std::vector<Vec3> clippedFacet(std::uint32_t i) const {
    return clipped(of_.surface->triangle(i));
  }

  /// Calls visit(least distance from the axis, greatest distance, radial part of the normal, facet) for each
  /// facet in the slab.
  template <class Visit>
  void forEachFacet(Visit visit) const {
    for (std::uint32_t i = 0; i < of_.surface->mesh().triangles.size(); ++i) {
      const std::vector<Vec3> polygon = clipped(of_.surface->triangle(i));
      if (polygon.size() < 3) continue;
      double least_m = std::numeric_limits<double>::max(), most_m = 0;
      Vec3 middle = Vec3::Zero();
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        least_m = std::min(least_m, toAxis(polygon[k], polygon[(k + 1) % polygon.size()]));
        most_m = std::max(most_m, polygon[k].head<2>().norm());
        middle += polygon[k] / static_cast<double>(polygon.size());
      }
      const Vec3 n = of_.X_WP.R * of_.surface->normal(i);
      const Vec3 out = (middle.x() * u_ + middle.y() * v_).normalized();
      visit(least_m, most_m, n.dot(out), i);
    }
  }

 private:
  /// Clips a triangle to the slab; the result is in coordinates along u, v and the axis.
  [[nodiscard]] std::vector<Vec3> clipped(const Triangle& t) const {
    SurfacePiece polygon;
    for (const Vec3& p : t) {
      const Vec3 r = of_.X_WP * p - at_;
      polygon.emplace_back(u_.dot(r), v_.dot(r), axis_.dot(r));
    }
    return below(below(polygon, Vec3::UnitZ(), half_m_), -Vec3::UnitZ(), half_m_);
  }

  static double toAxis(const Vec3& a, const Vec3& b) {
    const Eigen::Vector2d from = a.head<2>(), along = b.head<2>() - from;
    const double t =
        along.squaredNorm() > 0 ? std::clamp(-from.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
    return (from + t * along).norm();
  }

  const PlacedSurface& of_;
  Vec3 axis_, at_, u_, v_;
  double half_m_;
};

}  // namespace vps::scenes

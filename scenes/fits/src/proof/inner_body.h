// SPDX-License-Identifier: BSD-3-Clause
// Bodies inside a solid that bound how far a moving point may be from leaving the solid.
#pragma once

#include <cstddef>

#include "surface/part_surface.h"

namespace vps::scenes {

/// A linear upper bound of a point's gap to a solid: as long as the point moves by w with |w| <= the stated
/// distance, it lies deeper in the solid than -(most_m + n . w) if that number is positive.
struct GapBound {
  double most_m = 0;       ///< infinite if no bound was found
  Vec3 n = Vec3::UnitZ();  ///< unit direction out of the solid
};

/// A point near a solid's surface, with the direction out of the solid there.
class PointAtSolid {
 public:
  /// @param p in the solid's frame, as all points and directions of this class
  PointAtSolid(const PartSurface& solid, const Vec3& p);

  /// Signed distance from the surface, negative inside.
  [[nodiscard]] double distance_m() const { return distance_m_; }
  [[nodiscard]] const Vec3& n() const { return n_; }
  /// Bounds the gap for displacements up to moved_m, and for depths up to `beyond_m` more than the bound, by
  /// the best of two kinds of bodies inside the solid:
  /// - balls that touch the surface at the nearest point. |p + w - c| is at most
  ///   |p - c| + n . w + |w|^2 / (2 (|p - c| - |w|)).
  /// - a cylinder below the surface, with its axis along n, so wide and deep that the point stays within its
  ///   width: the solid contains it, since no facet reaches into it and its middle is inside. There the gap
  ///   is linear.
  /// Adds the number of distance queries to `work`, each of about a microsecond.
  [[nodiscard]] GapBound bound(double moved_m, double beyond_m, std::size_t& work) const;

 private:
  [[nodiscard]] double byBalls(double moved_m, std::size_t& work) const;
  [[nodiscard]] double byCylinder(double moved_m, double beyond_m, std::size_t& work) const;

  const PartSurface& solid_;
  Vec3 p_, q_, n_;
  double distance_m_ = 0;
};

}  // namespace vps::scenes

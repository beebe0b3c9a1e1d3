// SPDX-License-Identifier: BSD-3-Clause
// Balls in what two solids share.
#pragma once

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Balls in both of two placed solids, in the frame of the first. Both must outlive it.
class SharedBalls {
 public:
  SharedBalls(const PlacedSurface& a, const PlacedSurface& b);

  /// Radius of the greatest ball around a point that is in both solids; negative outside of one of them, by
  /// the distance from it. 1-Lipschitz.
  [[nodiscard]] double radiusAt(const Vec3& p_A) const;
  /// The surface that limits that ball, which is the nearer one.
  struct Limit {
    double radius_m;
    bool is_of_b;
    Vec3 out, q;  ///< unit, out of that solid; the nearest point of its surface
  };
  [[nodiscard]] Limit limitAt(const Vec3& p_A) const;
  /// A ball that no small displacement makes larger; its radius is depth_m.
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, double step_m) const;
  /// The largest that is found from the points of a grid; there may be a larger one. Radius 0: none.
  [[nodiscard]] Overlap greatest() const;

 private:
  [[nodiscard]] Overlap grownFrom(const Vec3& p_A, Vec3 step_A) const;
  const PartSurface &a_, &b_;
  Pose X_WA_, X_BA_;
  Box both_A_;
};

}  // namespace vps::scenes

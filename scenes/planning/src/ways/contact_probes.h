// SPDX-License-Identifier: BSD-3-Clause
// A fast test that proves that one part stops another one immediately.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Points on the surfaces of two parts where they touch. If such a point, moved a little, is deeper in the
/// other part than allowed, the motion is stopped. The converse does not hold: if no point is that deep, a
/// motion search has to decide. A query of 64 points takes 0.2 ms, a search along flush curved faces 10 to
/// 100 ms.
class ContactProbes {
 public:
  ContactProbes() = default;
  ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m);
  /// Whether a is stopped immediately when it moves along d.
  [[nodiscard]] bool areStopped(const Vec3& d_W) const;

 private:
  struct Side {
    const PlacedSurface* other = nullptr;
    std::vector<Vec3> points_W;  ///< on the surface of the part that is not `other`
    double sign = 1;             ///< sign of the motion
  };
  static std::vector<Vec3> touching(const PlacedSurface& of, const PlacedSurface& other, double within_m);

  std::vector<Side> sides_;
  double allowed_m_ = 0;
};

}  // namespace vps::scenes

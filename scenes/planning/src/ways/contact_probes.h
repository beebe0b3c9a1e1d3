// SPDX-License-Identifier: BSD-3-Clause
// Proves quickly that one part stops another at once.
#pragma once

#include <vector>

#include "surface/placed_surface.h"

namespace vps::scenes {

/// Points on the surfaces of two parts where they touch. Where such a point, moved a little, is deeper in the
/// other part than is allowed, the motion is stopped. It proves no more: where no point is, a search has to
/// tell. A query of 64 points takes 0.2 ms, a search along flush curved faces 10 to 100 ms.
class ContactProbes {
 public:
  ContactProbes() = default;
  ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m);
  /// Whether a is stopped at once when it moves along d.
  [[nodiscard]] bool areStopped(const Vec3& d_W) const;

 private:
  struct Side {
    const PlacedSurface* other = nullptr;
    std::vector<Vec3> points_W;  ///< on the surface of the one that is not `other`
    double sign = 1;             ///< of the motion
  };
  static std::vector<Vec3> touching(const PlacedSurface& of, const PlacedSurface& other, double within_m);

  std::vector<Side> sides_;
  double allowed_m_ = 0;
};

}  // namespace vps::scenes

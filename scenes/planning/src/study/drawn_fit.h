// SPDX-License-Identifier: BSD-3-Clause
// Whether parts of given sizes and places can be together at all, by geometry alone.
#pragma once

#include <string>
#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Why a part that a step moves cannot be where it belongs, by exact distance; empty: nothing is in its way.
struct DrawnMisfit {
  std::string part, other, reason;
  [[nodiscard]] bool isFound() const { return !reason.empty(); }
};

/// Looks for misfits in variants of one scene, of which it has prepared the parts.
class DrawnFit {
 public:
  explicit DrawnFit(const Scene& scene);

  /// A misfit is an overlap beyond its error, or a shaft that is larger than its bore, measured on the
  /// cylinders that the meshes stand for. What the scene allows or declares is none.
  [[nodiscard]] DrawnMisfit findMisfit(const Scene& variant) const;

  /// The variant, with the parts that are as they were taken as prepared.
  [[nodiscard]] CheckResult check(const Scene& variant, const CheckSettings& settings) const;

 private:
  std::vector<DrawnPart> parts_;
  std::vector<PlacedSurface> placed_;  // points to the parts
};

}  // namespace vps::scenes

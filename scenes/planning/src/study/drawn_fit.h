// SPDX-License-Identifier: BSD-3-Clause
// Tests by geometry alone whether parts of given sizes and placements fit together.
#pragma once

#include <string>
#include <vector>

#include "surface/placed_surface.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Reason why a moved part cannot be at its target, by exact distance; empty: nothing blocks it.
struct DrawnMisfit {
  std::string part, other, reason;
  [[nodiscard]] bool isFound() const { return !reason.empty(); }
};

/// Finds misfits in variants of one scene. The parts of that scene are prepared once.
class DrawnFit {
 public:
  explicit DrawnFit(const Scene& scene);

  /// A misfit is an overlap beyond its error, or a shaft that is larger than its bore, measured on the
  /// cylinders that the meshes approximate. Overlaps that the scene allows or declares are not misfits.
  [[nodiscard]] DrawnMisfit findMisfit(const Scene& variant) const;

  /// Checks the variant; parts that equal those of the prepared scene are not prepared again.
  [[nodiscard]] CheckResult check(const Scene& variant, const CheckSettings& settings) const;

 private:
  std::vector<DrawnPart> parts_;
  std::vector<PlacedSurface> placed_;  // refers to parts_
};

}  // namespace vps::scenes

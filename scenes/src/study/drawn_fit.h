// SPDX-License-Identifier: BSD-3-Clause
// Whether parts of given sizes and places can be together at all, by geometry alone.
#pragma once

#include <string>

#include "vps_scenes/scene.h"

namespace vps::scenes::inline v0 {

/// Why a part that a step moves cannot be where it belongs, by exact distance; empty: nothing is in its way.
struct DrawnMisfit {
  std::string part, other, reason;
  [[nodiscard]] bool isFound() const { return !reason.empty(); }
};

/// A misfit is an overlap beyond its error, or a shaft that is larger than its bore, measured on the
/// cylinders that the meshes stand for. What the scene allows or declares is none.
DrawnMisfit findDrawnMisfit(const Scene& scene);

}  // namespace vps::scenes::inline v0

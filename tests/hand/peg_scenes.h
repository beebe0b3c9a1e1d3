// SPDX-License-Identifier: BSD-3-Clause
// Pegs and blind holes with a known clearance, as scenes for the virtual operator.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps_scenes/scene.h"

namespace vps::hand {

struct PegScene {
  const char* name;
  const char* description;
  scenes::Scene (*make)(std::uint64_t seed);
};

/// round: 8 mm, 20 um of diametral clearance, 0.5 mm chamfers at 45 degrees, 10 mm deep.
/// rectangular: 4 mm square, 50 um of clearance on each side, sharp edges, 8 mm deep.
const std::vector<PegScene>& pegScenes();

}  // namespace vps::hand

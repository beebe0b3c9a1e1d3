// SPDX-License-Identifier: BSD-3-Clause
// A long level rod that goes through the holes of two walls, as a scene for the virtual operator.
#pragma once

#include <cstdint>

#include "peg_scenes.h"

namespace vps::hand {

/// A rod of 10 mm and 200 mm, and two walls 10 mm thick and 150 mm apart with one hole each, all sharp. The
/// hand holds the rod in its middle, so that a lean of what the holes leave moves the hand by a tenth of a
/// millimetre and more.
/// @param clearance_m  diametral; negative: the rod is too thick
scenes::Scene levelRod(double clearance_m, std::uint64_t seed);

/// level_rod: 50 um of clearance.
const std::vector<PegScene>& rodScenes();

}  // namespace vps::hand

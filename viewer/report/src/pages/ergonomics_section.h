// SPDX-License-Identifier: BSD-3-Clause
// Reach and joint comfort of persons at a bench, as a section of the report.
#pragma once

#include <string>

#include "vps_scenes/uses/ergonomics.h"

namespace vps::viewer {

/// A table, and a side view for each posture with the path, both persons' arms at the path's farthest place
/// and what they reach. Empty where nothing was measured.
std::string ergonomicsSection(const scenes::Scene& scene, const scenes::AssembleResult& result);

}  // namespace vps::viewer

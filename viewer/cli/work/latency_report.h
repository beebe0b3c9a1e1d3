// SPDX-License-Identifier: BSD-3-Clause
// vps view --measure-latency: the measurement, and its table.
#pragma once

#include <string>

#include "input/scene_arguments.h"
#include "vps_viewer/window/latency.h"

namespace vps::viewer {

/// Returns the exit status: kBad where picture, sound and force are farther apart than kApart_s.
/// @param json  file to write; empty: none
int reportLatency(const SceneArguments& scene, const LatencySettings& settings, const std::string& json);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The report's sections with a source of their own: the three-dimensional view of the run, and ergonomics.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"
#include "vps_scenes/uses/ergonomics.h"

namespace vps::viewer {

struct RunView {
  std::string html;     ///< empty if it could not be made
  std::string missing;  ///< why, with the remedy
};

/// A view that turns under the mouse or a finger, and plays and scrubs the run. It needs nothing beside the
/// page: three.js is written into it, so it opens by mail, in any browser with WebGL; elsewhere it says that
/// the browser has none. Parts are drawn with at most kRunViewTriangles in all, and kRunViewRate_hz places a
/// second. Without three.js on this machine there is no view. O(triangles log triangles + rows).
RunView runView(const scenes::Scene& scene, const scenes::AssembleResult& result);

inline constexpr std::size_t kRunViewTriangles = 150000;
inline constexpr double kRunViewRate_hz = 25;

extern const char* const kRunViewScript;

/// A table, and a side view for each posture with the path, both persons' arms at the path's farthest place
/// and what they reach. Empty where nothing was measured.
std::string ergonomicsSection(const scenes::Scene& scene, const scenes::AssembleResult& result);

/// The first row of every period 1 / rate_hz.
std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz);

}  // namespace vps::viewer

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
  std::string html;     ///< empty if the view could not be made
  std::string missing;  ///< reason why there is no view, with a remedy
};

/// A view that turns under the mouse or a finger, and plays and scrubs the run. The page embeds three.js and
/// needs no other file, so the page works when sent by mail, in any browser with WebGL; other browsers show a
/// message. All parts together have at most kRunViewTriangles, and the view has kRunViewRate_hz poses a
/// second. Without three.js on this machine there is no view. O(triangles log triangles + rows).
RunView runView(const scenes::Scene& scene, const scenes::AssembleResult& result);

inline constexpr std::size_t kRunViewTriangles = 150000;
inline constexpr double kRunViewRate_hz = 25;

extern const char* const kRunViewScript;

/// Reach and joint comfort of persons at a bench: a table, and a side view for each posture with the path,
/// both persons' arms at the path's farthest place and their reach. Empty if nothing was measured.
std::string ergonomicsSection(const scenes::Scene& scene, const scenes::AssembleResult& result);

/// The time series at a lower rate: the first row of every period 1 / rate_hz.
std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz);

}  // namespace vps::viewer

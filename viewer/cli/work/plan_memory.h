// SPDX-License-Identifier: BSD-3-Clause
// What plans leave in files for later runs: what a stopped one had found, and the clearances of one that is
// done.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "vps_scenes/planning/plan.h"

namespace vps::viewer {

/// A number that differs where the parts, their places or what is asked for differ.
std::string planKey(const scenes::Scene& scene, const scenes::PlanSettings& settings);

std::string findingsText(const std::string& key, const scenes::PlanFindings& found);
/// What the file holds; empty if there is none. Throws LoadError for a file that is damaged or of other
/// parts.
std::optional<scenes::PlanFindings> readFindings(const std::string& file, const std::string& key);

/// The clearances of the ways of a scene file, by part, from the plan.json beside it; empty where there is
/// none, or where it has no assembly of that name. Those of more than kNearWay_m are that.
std::map<std::string, double> plannedClearances(const std::string& scene_file);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Output of `vps plan`: tables and sentences.
#pragma once

#include <string>

#include "vps_scenes/planning/plan.h"

namespace vps::viewer {

/// A line for each different fastener with the names of the parts; empty if there are none.
std::string fastenerText(const std::vector<scenes::Fastener>& fasteners);
/// The steps of all assemblies, and what cannot be taken apart.
std::string planTables(const scenes::PlanResult& plan);
/// The answer in a sentence.
std::string planHeadline(const scenes::PlanResult& plan);
/// "the way of 'peg' leads through 'wall', 3.20 mm deep at (1.0, 2.0, 3.0) mm (0.01 mm allowed)"
std::string inWords(const scenes::WayFault& fault);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The pictures of pages: of the steps of a run, and of the clearance between parts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_viewer/report/report.h"

namespace vps::viewer {

/// File names relative to the report; empty where there is no picture.
struct StepPictures {
  std::string start, contact, end;
};
struct ReportPictures {
  std::string overview, section;
  std::vector<StepPictures> steps;
  std::string failure_reason;  ///< set when no picture could be made
};

ReportPictures drawPictures(const scenes::Scene& scene, const scenes::AssembleResult& result,
                            const std::string& dir, const ReportOptions& options);

/// sRGB, 0 to 1: magenta for an overlap, then from red over yellow and green to blue, by the logarithm of the
/// distance from a thousandth of near_m to near_m; light grey from there on.
std::array<double, 3> clearanceColor(double distance_m, double near_m);

/// A section of a page: each part from two sides, with the legend. Says what is missing where OpenGL is.
std::string clearancePictures(const scenes::CheckResult& result);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The pictures of pages: of the steps of a run, and of the clearance between parts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_viewer/report/report.h"

namespace vps::viewer {

/// Direction to the viewer: from the front, right and above, as in assembly drawings.
inline const Vec3 kToViewer(0.75, -1.25, 0.85);

/// File names relative to the report; empty for a missing picture.
struct StepPictures {
  std::string start, contact, end;
};
struct ReportPictures {
  std::string overview, section;
  std::vector<StepPictures> steps;
  std::string failure_reason;  ///< set when no picture could be made
};

/// Draws the pictures of a run into dir/pictures. Does not throw for a missing OpenGL,
/// but any exception of options.progress.
ReportPictures drawPictures(const scenes::Scene& scene, const scenes::AssembleResult& result,
                            const std::string& dir, const ReportOptions& options);

/// sRGB, 0 to 1: magenta for an overlap; from red over yellow and green to blue for distances from near_m /
/// 1000 to near_m, on a logarithmic scale; light grey beyond near_m.
std::array<double, 3> clearanceColor(double distance_m, double near_m);

/// A section of the page of a check: each part from two sides, with colours of clearance and a legend.
/// Without OpenGL the section has a note instead.
/// @param progress  may be empty; called before each part. Its exceptions end the drawing.
std::string clearancePictures(const scenes::CheckResult& result, const Progress& progress);

}  // namespace vps::viewer

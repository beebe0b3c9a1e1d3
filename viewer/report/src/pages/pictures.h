// SPDX-License-Identifier: BSD-3-Clause
// The pictures of a report.
#pragma once

#include <string>
#include <vector>

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

}  // namespace vps::viewer

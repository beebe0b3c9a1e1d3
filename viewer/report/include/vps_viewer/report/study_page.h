// SPDX-License-Identifier: BSD-3-Clause
// A study as HTML.
#pragma once

#include <string>

#include "vps_scenes/planning/study.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A page with the yield first, then what each tolerance costs and a histogram of each deviation.
VPS_VIEWER_API std::string studyPage(const scenes::StudyResult& result);

/// A deviation with its unit: "-3.20 µm", "0.150 mrad", "0.020".
VPS_VIEWER_API std::string deviationText(const scenes::StudyVariable& variable, double value);

}  // namespace vps::viewer

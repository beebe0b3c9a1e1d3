// SPDX-License-Identifier: BSD-3-Clause
// The results of a check as HTML.
#pragma once

#include <string>

#include "vps_scenes/fits/check_types.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Tables of pairs, fits and press fits, without pictures, for the report of a run.
VPS_VIEWER_API std::string checkTablesOfRun(const scenes::CheckResult& result);
/// Tables of pairs, fits and play, for a page that has other sections.
VPS_VIEWER_API std::string checkSection(const scenes::CheckResult& result);
/// A page of its own, with the answer first.
VPS_VIEWER_API std::string checkPage(const scenes::CheckResult& result);

}  // namespace vps::viewer

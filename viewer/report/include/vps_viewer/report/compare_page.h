// SPDX-License-Identifier: BSD-3-Clause
// A trainee's run against an expert's as HTML with pictures.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/uses/compare.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Writes compare.html, and for each step plots/path_N and plots/force_N (PNG and SVG), into dir, which
/// exists. Returns notes on what could not be drawn. Throws LoadError when dir cannot be written.
VPS_VIEWER_API std::vector<std::string> writeComparePage(const scenes::RunComparison& result,
                                                         const std::string& dir);

}  // namespace vps::viewer

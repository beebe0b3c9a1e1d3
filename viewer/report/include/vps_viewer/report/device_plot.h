// SPDX-License-Identifier: BSD-3-Clause
// Figure 5 of the paper, of the dual arm that this program has: the vertical force of left arm, right arm and
// pair.
#pragma once

#include <string>
#include <vector>

#include "vps_device/dual_arm/character.h"
#include "vps_viewer/export.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {

/// Left: the least force over each column of the workspace, as surfaces over x and y. Right: the least over x
/// and z, along y, with the paper's 5 N and 12 N. Writes file + ".png" and file + ".svg"; the same input
/// gives the same bytes.
VPS_VIEWER_API PlotOutcome plotVerticalForces(const std::vector<device::VerticalForceAt>& forces,
                                              const std::string& file);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Figure 5 of the paper for the simulated dual arm: the vertical force of the left arm, the right arm and
// both.
#pragma once

#include <string>
#include <vector>

#include "vps_device/dual_arm_character.h"
#include "vps_viewer/export.h"
#include "vps_viewer/plot.h"

namespace vps::viewer {

/// Plots the least force along z as surfaces over x and y (left), and the least force over x and z along y
/// with the paper's 5 N and 12 N (right). Writes file + ".png" and file + ".svg"; the same input gives the
/// same bytes.
VPS_VIEWER_API PlotOutcome plotVerticalForces(const std::vector<device::VerticalForceAt>& forces,
                                              const std::string& file);

}  // namespace vps::viewer

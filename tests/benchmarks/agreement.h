// SPDX-License-Identifier: BSD-3-Clause
// Checks that both sides give the same answers before anything is timed.
#pragma once

#include <string>

#include "scene.h"
#include "subject.h"

namespace vps::bench {

/// Walks `steps` steps of a motion with our engine and with OpenVDB reading the same values (the map, saved
/// as a .vdb file). Throws std::runtime_error that names the first difference: touching points, least
/// distance or wrench. meshToVolume's own field is not a reference: its error is up to half a voxel near
/// edges.
void requireAgreement(const std::string& name, const VoxMap& map, const PointShell& shell,
                      const SubjectOptions& options, const Motion& motion, int steps);

}  // namespace vps::bench

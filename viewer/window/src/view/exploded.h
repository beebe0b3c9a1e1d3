// SPDX-License-Identifier: BSD-3-Clause
// The exploded view: parts moved apart against the direction in which they are mounted.
#pragma once

#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Moves each part that a step mounts back along the last leg of its path, farther for later steps: by
/// `share` of the assembly's size for the last one. Contacts and target are left out. A share of 0 changes
/// nothing.
/// @param size_m  of the assembly
[[nodiscard]] VPS_VIEWER_API scenes::Snapshot exploded(const scenes::Scene& scene, scenes::Snapshot snapshot,
                                                       double share, double size_m);

}  // namespace vps::viewer

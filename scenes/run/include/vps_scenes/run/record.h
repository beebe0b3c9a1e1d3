// SPDX-License-Identifier: BSD-3-Clause
// Runs an assembly procedure and records it, so that it can be replayed.
#pragma once

#include <string>

#include "vps_scenes/export.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Runs assemble() and records it to `file` (format: vps_device/recording.h), scene and meshes included, so
/// that replay() runs it again from this file alone. A run that is stopped or fails leaves the unfinished
/// recording next to it, and names it through options.warn. Throws as assemble(), LoadError where the file
/// cannot be written, and LoadError for options.has_local_contact, whose runs cannot be replayed bit for bit.
VPS_SCENES_API AssembleResult assembleAndRecord(Scene& scene, const std::string& file,
                                                const AssembleOptions& options = {});

}  // namespace vps::scenes

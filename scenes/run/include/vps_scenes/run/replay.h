// SPDX-License-Identifier: BSD-3-Clause
// Records a run, and repeats a recorded run from its recording alone.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "vps_device/recording.h"
#include "vps_scenes/export.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Runs assemble() and records the run to `file` (format: vps_device/recording.h), scene and meshes included,
/// so that replay() repeats the run from this file alone. A run that is stopped or fails leaves the
/// unfinished recording next to `file`, and reports its name through options.warn. Throws as assemble(),
/// LoadError where the file cannot be written, and LoadError for options.has_local_contact, whose runs cannot
/// be replayed bit for bit.
VPS_SCENES_API AssembleResult assembleAndRecord(Scene& scene, const std::string& file,
                                                const AssembleOptions& options = {});

struct ReplayOptions : ModelOptions {
  const std::atomic<bool>* stop = nullptr;  ///< see AssembleOptions::stop
  SnapshotTap* tap = nullptr;               ///< see AssembleOptions::tap
  /// See AssembleOptions::on_device_event.
  std::function<void(const device::DeviceEvent&)> on_device_event;
  /// Called with the scene before its models are built. The reference stays valid until replay() returns. An
  /// empty function is not called.
  std::function<void(const Scene&)> on_scene;
};

struct ReplayResult {
  Scene scene;  ///< the recorded scene
  AssembleResult result;
  std::string
      departure;  ///< first difference; empty: all wrenches, events and traced poses are equal to the bit
  std::string other_version;  ///< "was recorded by ..., this is ..."; empty: recorded by this version
  std::size_t equal = 0;      ///< number of log entries that agree with the recording
};

/// The scene of a recorded run. Throws LoadError if the recording has no scene, such as the recording of a
/// device alone.
VPS_SCENES_API Scene recordedScene(const device::RecordedRun& run);

/// Takes the device's samples from the recording, computes everything else again and compares the results
/// with the recording. After a difference the run continues to its end. If the recording is incomplete, the
/// run ends where the recording ends. Throws as recordedScene() and assemble().
VPS_SCENES_API ReplayResult replay(const device::RecordedRun& run, const ReplayOptions& options = {});

}  // namespace vps::scenes

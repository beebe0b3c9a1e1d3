// SPDX-License-Identifier: BSD-3-Clause
// Runs a recorded run again, from its recording alone.
#pragma once

#include <atomic>

#include "vps_device/recording.h"
#include "vps_scenes/export.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/result.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

struct ReplayOptions : ModelOptions {
  const std::atomic<bool>* stop = nullptr;  ///< as in AssembleOptions
};

struct ReplayResult {
  Scene scene;  ///< as recorded
  AssembleResult result;
  std::string departure;  ///< empty: every wrench, event and traced pose is the recorded one to the bit
  std::string
      other_version;      ///< empty: recorded by this very program; else "was recorded by ..., this is ..."
  std::size_t equal = 0;  ///< entries that agree
};

/// The scene of a recorded run. Throws LoadError where the recording has none (of a device alone, say).
VPS_SCENES_API Scene recordedScene(const device::RecordedRun& run);

/// The device is the recording, the rest is run anew and compared as it goes. A run that departs goes on to
/// its end all the same, to show where it leads. A cut recording ends the run where it ends. Throws as
/// recordedScene() and assemble().
VPS_SCENES_API ReplayResult replay(const device::RecordedRun& run, const ReplayOptions& options = {});

}  // namespace vps::scenes

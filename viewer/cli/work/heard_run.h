// SPDX-License-Identifier: BSD-3-Clause
// The sound of a run, from every physics step of it.
#pragma once

#include <optional>
#include <string>

#include "vps_scenes/run/assemble.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {

class HeardRun {
 public:
  HeardRun();
  HeardRun(const HeardRun&) = delete;
  HeardRun& operator=(const HeardRun&) = delete;

  /// The scene that is run, before its first step; it outlives the run.
  void hear(const scenes::Scene& scene) { sound_.emplace(scene); }
  /// Of AssembleOptions or ReplayOptions.
  template <class Options>
  void listenTo(Options& options) {
    options.tap = &tap_;
    options.on_device_event = [this](const device::DeviceEvent& event) {
      if (sound_) sound_->beep(device::beepOf(event.kind));
    };
  }
  /// The bytes of a WAV file; says on stdout how loud it is.
  [[nodiscard]] std::string wav();

 private:
  std::optional<RunSound> sound_;
  scenes::SnapshotTap tap_;
};

}  // namespace vps::viewer

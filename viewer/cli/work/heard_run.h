// SPDX-License-Identifier: BSD-3-Clause
// The sound of a run, computed from every physics step.
#pragma once

#include <cmath>
#include <cstdio>
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

  /// Sets the scene before its first step. The scene must outlive the run.
  void hear(const scenes::Scene& scene) { sound_.emplace(scene); }
  /// Connects this object to a run, by AssembleOptions or ReplayOptions.
  template <class Options>
  void listenTo(Options& options) {
    options.tap = &tap_;
    options.on_device_event = [this](const device::DeviceEvent& event) {
      if (sound_) sound_->beep(device::beepOf(event.kind));
    };
  }
  /// The sound as the bytes of a WAV file. Prints the loudness of the sound on stdout.
  [[nodiscard]] std::string wav();

 private:
  std::optional<RunSound> sound_;
  scenes::SnapshotTap tap_;
};

inline HeardRun::HeardRun() {
  tap_.is_wanted = true;
  tap_.give = [this](scenes::Snapshot&& shot) {
    if (sound_) sound_->hear(shot);
    tap_.is_wanted = true;
  };
}

inline std::string HeardRun::wav() {
  double full_scale_Pa = 0;
  const RunSound::Samples samples = sound_ ? sound_->take() : RunSound::Samples();
  std::string bytes = wavBytes(samples, sound_ ? sound_->rate_hz() : SoundSettings().rate_hz, &full_scale_Pa);
  // Sound pressure level: in decibels above 20 uPa.
  if (full_scale_Pa > 0)
    std::printf("sound: at most %.0f dB at half a metre\n", 20 * std::log10(0.708 * full_scale_Pa / 20e-6));
  else
    std::printf("sound: none, because no parts touched\n");
  return bytes;
}

}  // namespace vps::viewer

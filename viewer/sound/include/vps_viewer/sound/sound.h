// SPDX-License-Identifier: BSD-3-Clause
// The sound of a run: parts ring when they are struck or rubbed, and the device's warnings beep.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps_device/device.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct SoundSettings {
  int rate_hz = 48000;
  double distance_m = 0.5;  ///< distance of the listener; assumed: arm's length from a bench
  bool has_rings = true;    ///< false: only clicks, rubbing and beeps, so that no modes are computed
};

/// Modal synthesis of contact sound. A contact force that rises within a physics step strikes both parts with
/// its impulse; a slipping contact rubs them, and a rolling contact rubs them less. Each part responds with
/// its modes (src/modes/modes.h), which are computed at its first impact, and with the click of its
/// acceleration, which is the only sound of a part too small to ring. Deterministic: the same snapshots give
/// the same samples. Used by one thread.
class VPS_VIEWER_API RunSound {
 public:
  /// The scene must outlive the RunSound.
  explicit RunSound(const scenes::Scene& scene, const SoundSettings& settings = {});
  ~RunSound();
  RunSound(RunSound&&) noexcept;
  RunSound& operator=(RunSound&&) noexcept;

  /// Computes the modes of a part before its first impact.
  void prepare(std::size_t part);
  /// Adds the samples up to the snapshot's time. Call hear() with the snapshot of each physics step.
  void hear(const scenes::Snapshot& shot);
  /// Adds a beep that begins at the current time.
  void beep(device::Beep beep);

  /// Sound pressure at the listener [Pa], and the beeps, from -1 to 1.
  struct Samples {
    std::vector<float> pressure_Pa, beeps;
  };
  /// The samples since the last call.
  [[nodiscard]] Samples take();
  [[nodiscard]] int rate_hz() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The bytes of a WAV file, mono, 16 bits. The pressure is scaled to a peak of -3 dB, and the beeps are at
/// -20 dB. Silence stays silent.
/// @param full_scale_Pa  if given, receives the pressure of the largest 16-bit number
VPS_VIEWER_API std::string wavBytes(const RunSound::Samples& samples, int rate_hz,
                                    double* full_scale_Pa = nullptr);

}  // namespace vps::viewer

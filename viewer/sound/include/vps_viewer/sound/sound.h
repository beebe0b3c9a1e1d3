// SPDX-License-Identifier: BSD-3-Clause
// What a run sounds like: the parts ring where they are struck and rub, and the device beeps where it warns.
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
  double distance_m = 0.5;  ///< of the listener; assumed: arm's length from a bench
  bool has_rings = true;    ///< false: no part rings, which needs no modes; only clicks, rubbing and beeps
};

/// Modal synthesis of the contacts. A contact force that rises within a physics step strikes its two parts
/// with its impulse; one that slips rubs them, and one that rolls rubs them less. Each part answers with its
/// modes (src/sound/modes.h), which are found where it is first struck, and with the click of its
/// acceleration, which is all of a part too small to ring. Deterministic: the same snapshots give the same
/// samples. Use it on one thread.
class VPS_VIEWER_API RunSound {
 public:
  /// The scene outlives it.
  explicit RunSound(const scenes::Scene& scene, const SoundSettings& settings = {});
  ~RunSound();
  RunSound(RunSound&&) noexcept;
  RunSound& operator=(RunSound&&) noexcept;

  /// Finds the modes of a part before it is struck.
  void prepare(std::size_t part);
  /// Adds the samples up to the snapshot's time. Give one for each physics step.
  void hear(const scenes::Snapshot& shot);
  /// From now on.
  void beep(device::Beep beep);

  /// Of what has been heard since the last call: sound pressure at the listener [Pa], and the beeps, -1 to 1.
  struct Samples {
    std::vector<float> pressure_Pa, beeps;
  };
  [[nodiscard]] Samples take();
  [[nodiscard]] int rate_hz() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The bytes of a WAV file, mono, 16 bits: the pressure so that its greatest value is at -3 dB, and the beeps
/// at -20 dB. Silence stays silence.
/// @param full_scale_Pa  if given, receives the pressure that the largest number stands for
VPS_VIEWER_API std::string wavBytes(const RunSound::Samples& samples, int rate_hz,
                                    double* full_scale_Pa = nullptr);

}  // namespace vps::viewer

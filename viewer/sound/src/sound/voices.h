// SPDX-License-Identifier: BSD-3-Clause
// The voices of a run: a part rings by its modes and clicks by its acceleration; the device beeps.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "modes/modes.h"
#include "vps_device/device.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {

/// Drive of each mode by a force of 1 N, at the place and in the direction of a contact on the part.
struct Touch {
  std::vector<double> drive;  ///< [1/sqrt(kg)], by mode
};

/// Sound of one part, sample by sample.
class VPS_VIEWER_API PartVoice {
 public:
  /// @param volume_m3, mass_kg  volume and mass of the part, for the click
  PartVoice(BodyModes modes, double volume_m3, double mass_kg, int rate_hz, double distance_m);

  [[nodiscard]] const BodyModes& modes() const { return modes_; }
  [[nodiscard]] double mass_kg() const { return mass_kg_; }
  [[nodiscard]] Touch touch(const Vec3& p_P, const Vec3& n_P) const;

  /// Adds a force that acts during the current sample. Call push() before next().
  void push(const Touch& touch, double force_N);
  /// The current sample: pressure at the listener [Pa]. Advances to the next sample.
  double next();
  /// Whether the part has stopped ringing.
  [[nodiscard]] bool isQuiet() const { return quiet_samples_ > quiet_after_; }

 private:
  struct Resonator {
    double a1 = 0, a2 = 0, b = 0;  ///< q = a1 q_1 - a2 q_2 + b f
    double gain = 0;               ///< pressure per modal velocity
    double q1 = 0, q2 = 0;
    double force = 0;
  };

  BodyModes modes_;
  std::vector<Resonator> resonators_;
  double mass_kg_, rate_hz_;
  double click_Pa_s_per_N_ = 0;
  double force_N_ = 0, force_before_N_ = 0;
  long quiet_samples_ = 0, quiet_after_ = 0;
};

/// The voice of a part of a scene. Computes the part's modes, which takes up to a second, unless
/// settings.has_rings is false.
PartVoice partVoice(const scenes::ScenePart& part, const SoundSettings& settings);

/// Contact modulus of two bodies of the same material: E / (2 (1 - nu^2)).
double planeStrain_Pa(const scenes::ScenePart& part);

/// Duration of the contact in an impact: 2.94 (15/16)^(2/5) (m^2 / (R E^2 v))^(1/5). Source: Hertz, in
/// Johnson, "Contact Mechanics", 1985, section 11.4.
double impactDuration_s(double mass_kg, double plane_strain_Pa, double speed_m_s);

/// An impact on a part: an impulse, applied as a force over some samples.
struct Impact {
  Touch touch;
  double impulse_Ns = 0;
  long start = 0;     ///< first sample
  double length = 1;  ///< number of samples, at least 1

  /// Force during a sample: half a sine wave whose integral is the impulse.
  [[nodiscard]] double force_N(long sample, double rate_hz) const;
  [[nodiscard]] bool isOver(long sample) const { return static_cast<double>(sample - start) >= length; }
};

/// Beeps of device warnings, one after the other. assumed: people can count beeps of 90 ms with pauses of 60
/// ms.
class Beeper {
 public:
  explicit Beeper(int rate_hz) : rate_hz_(rate_hz) {}

  /// Queues a warning's beeps. A warning that already waits or sounds is not queued again, and at most six
  /// beeps wait.
  void add(device::Beep beep);
  /// The next sample, -1 to 1.
  double next();

 private:
  int rate_hz_;
  std::deque<double> pitches_hz_;  ///< queued beeps; the first one sounds
  long at_ = 0;                    ///< samples since the first beep began
};

}  // namespace vps::viewer

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

/// Where and in which direction a part is struck or rubbed, as the drive of each of its modes by 1 N.
struct Touch {
  std::vector<double> drive;  ///< [1/sqrt(kg)], by mode
};

class VPS_VIEWER_API PartVoice {
 public:
  /// @param volume_m3, mass_kg  of the part, for the click
  PartVoice(BodyModes modes, double volume_m3, double mass_kg, int rate_hz, double distance_m);

  [[nodiscard]] const BodyModes& modes() const { return modes_; }
  [[nodiscard]] double mass_kg() const { return mass_kg_; }
  [[nodiscard]] Touch touch(const Vec3& p_P, const Vec3& n_P) const;

  /// Adds a force that acts during this sample, before next().
  void push(const Touch& touch, double force_N);
  /// The pressure at the listener of this sample [Pa].
  double next();
  /// Whether it still rings.
  [[nodiscard]] bool isQuiet() const { return quiet_samples_ > quiet_after_; }

 private:
  struct Resonator {
    double a1 = 0, a2 = 0, b = 0;  ///< q = a1 q_1 - a2 q_2 + b f
    double gain = 0;               ///< from velocity to pressure
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

/// Finds its modes, up to a second, unless settings.has_rings is false.
PartVoice partVoice(const scenes::ScenePart& part, const SoundSettings& settings);

/// E / (2 (1 - nu^2)): of two equal bodies that touch.
double planeStrain_Pa(const scenes::ScenePart& part);

/// Duration of the contact of a stroke. Source: Hertz, in Johnson, "Contact Mechanics", 1985, section 11.4:
/// 2.94 (15/16)^(2/5) (m^2 / (R E^2 v))^(1/5).
double strokeDuration_s(double mass_kg, double plane_strain_Pa, double speed_m_s);

/// An impulse on a part, as a force over some samples.
struct Stroke {
  Touch touch;
  double impulse_Ns = 0;
  long start = 0;     ///< sample
  double length = 1;  ///< samples, at least 1

  /// Half a sine, whose sum over the samples is the impulse.
  [[nodiscard]] double force_N(long sample, double rate_hz) const;
  [[nodiscard]] bool isOver(long sample) const { return static_cast<double>(sample - start) >= length; }
};

/// assumed: beeps of 90 ms with pauses of 60 ms are counted with ease.
class Beeper {
 public:
  explicit Beeper(int rate_hz) : rate_hz_(rate_hz) {}

  /// Sounds after those that wait. A warning that already waits or sounds is not added again, nor a seventh.
  void add(device::Beep beep);
  /// The next sample, -1 to 1.
  double next();

 private:
  int rate_hz_;
  std::deque<double> pitches_hz_;  ///< the first one sounds
  long at_ = 0;                    ///< samples since it began
};

}  // namespace vps::viewer

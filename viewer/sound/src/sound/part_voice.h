// SPDX-License-Identifier: BSD-3-Clause
// The voice of one part: its modes as resonators, and the click of its acceleration.
#pragma once

#include <span>
#include <vector>

#include "modes/modes.h"

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

}  // namespace vps::viewer

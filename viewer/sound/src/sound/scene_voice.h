// SPDX-License-Identifier: BSD-3-Clause
// What a part of a scene sounds like where it is struck.
#pragma once

#include "sound/part_voice.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {

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

}  // namespace vps::viewer

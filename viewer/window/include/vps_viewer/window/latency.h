// SPDX-License-Identifier: BSD-3-Clause
// Measures how late picture, sound and force of a contact are, in one run without display and sound card.
//
// All times are of one clock. A simulated handle taps with the part in hand. Each tap is found again in
// the wrenches that are written to the device (a step of force), in the samples that leave the sound card (a
// click), and in the pictures that are read back (a flash).
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Bound on the time between picture, sound and force of a contact, which 99 of 100 contacts keep. Source:
/// section 2 of Tripicchio et al.
inline constexpr double kApart_s = 24e-3;

struct LatencySettings {
  std::size_t taps = 100;
  int width = 1280, height = 720;
  scenes::ModelOptions models;
  const std::atomic<bool>* stop = nullptr;
};

/// Delays of one contact [s], from the reading of the handle that its physics step used. Negative: the event
/// was not found.
struct ContactTimes {
  double found_s = -1;          ///< end of the physics step that found the contact
  double force_s = -1;          ///< first wrench with the contact written to the device
  double sound_written_s = -1;  ///< first sample of the contact written to the sound card
  double sound_s = -1;          ///< the same sample played
  double drawing_s = -1;        ///< drawing of the first picture with the contact began
  double picture_s = -1;        ///< the same picture read back

  /// Time between the first and the last of picture, sound and force; negative if one of these events was not
  /// found.
  /// @param has_sound  false: only picture and force count
  [[nodiscard]] VPS_VIEWER_API double apart_s(bool has_sound) const;
};

/// A row of the table of delays: one event between the encoder and the eye, ear or hand.
struct LatencyStage {
  const char* key;    ///< "picture_ms"
  const char* words;  ///< "picture: read back"
  double ContactTimes::*time_s;
  bool is_sound = false;
};
/// All rows, in the order in which the events happen.
VPS_VIEWER_API const std::vector<LatencyStage>& latencyStages();

struct LatencyResult {
  std::string scene, part, drawn_by;
  std::string silence;           ///< why there was no sound; empty: there was sound
  std::size_t late_samples = 0;  ///< gaps in the card's output because samples were written too late
  std::size_t late_mixes = 0;    ///< gaps in the card's output because the mixer ran too late
  double picture_wall_s = 0;     ///< median wall time of drawing a picture
  int width = 0, height = 0;
  std::vector<ContactTimes> contacts;

  [[nodiscard]] bool hasSound() const { return silence.empty(); }
  /// ContactTimes::apart_s() of each contact.
  [[nodiscard]] VPS_VIEWER_API std::vector<double> apart_s() const;
  /// Whether picture, sound and force of each contact were found, and 99 of 100 contacts keep kApart_s.
  [[nodiscard]] VPS_VIEWER_API bool isGood() const;
};

/// Percentile of the values that are not negative, by the nearest rank; NaN if there is none.
VPS_VIEWER_API double percentile(std::vector<double> values, double share);

/// Runs the first step of the scene in real time; a tap takes about 0.4 s. The handle first moves sideways by
/// a quarter of the part's size, so that the part touches the face next to the hole. Throws LoadError if the
/// part touches nothing, and std::runtime_error as Renderer does.
VPS_VIEWER_API LatencyResult measureLatency(scenes::Scene scene, const LatencySettings& settings);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// How late picture, sound and force of a contact are, measured in one run without display and sound card.
//
// One clock stamps all of it. A handle of the program taps with the part in hand. Each tap is found again in
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

/// How far picture, sound and force of a contact may be apart, 99 of 100 times: section 2 of the paper.
inline constexpr double kApart_s = 24e-3;

struct LatencySettings {
  std::size_t taps = 100;
  int width = 1280, height = 720;
  scenes::ModelOptions models;
  const std::atomic<bool>* stop = nullptr;
};

/// The way of a contact, by the times [s] since the handle was read that the physics step followed. Negative:
/// not seen.
struct ContactTimes {
  double found_s = -1;          ///< the physics step that found it was done: the contact's time
  double force_s = -1;          ///< the first wrench with it was written to the device
  double sound_written_s = -1;  ///< its first sample went to the sound card
  double sound_s = -1;          ///< that sample is played
  double drawing_s = -1;        ///< drawing of the first picture with it began
  double picture_s = -1;        ///< that picture was read back

  /// Between the first and the last of picture, sound and force; negative where one was not seen.
  /// @param has_sound  false: of picture and force
  [[nodiscard]] VPS_VIEWER_API double apart_s(bool has_sound) const;
};

/// A row of the table of the whole way: all times of one kind.
struct LatencyStage {
  const char* key;    ///< "picture_ms"
  const char* words;  ///< "picture: read back"
  double ContactTimes::*time_s;
  bool is_sound = false;
};
/// From the encoder to photon and sample, in order.
VPS_VIEWER_API const std::vector<LatencyStage>& latencyStages();

struct LatencyResult {
  std::string scene, part, drawn_by;
  std::string silence;           ///< why there was no sound; empty: there was
  std::size_t late_samples = 0;  ///< times that the card had nothing to play, since samples came too late
  std::size_t late_mixes = 0;    ///< and since they were mixed too late
  double picture_wall_s = 0;     ///< median time that a picture took
  int width = 0, height = 0;
  std::vector<ContactTimes> contacts;

  [[nodiscard]] bool hasSound() const { return silence.empty(); }
  /// Of all contacts; negative where one of the three was not seen.
  [[nodiscard]] VPS_VIEWER_API std::vector<double> apart_s() const;
  /// Whether each contact was seen in all three, and 99 of 100 within kApart_s.
  [[nodiscard]] VPS_VIEWER_API bool isGood() const;
};

/// Nearest rank of what was seen; NaN without any.
VPS_VIEWER_API double percentile(std::vector<double> values, double share);

/// Runs the first step of the scene by the clock, in about 0.4 s a tap. The handle goes aside by a quarter of
/// the part's size first, so that the part meets the face beside the hole. Throws LoadError where nothing is
/// met, std::runtime_error as Renderer.
VPS_VIEWER_API LatencyResult measureLatency(scenes::Scene scene, const LatencySettings& settings);

}  // namespace vps::viewer

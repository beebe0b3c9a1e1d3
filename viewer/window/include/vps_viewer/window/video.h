// SPDX-License-Identifier: BSD-3-Clause
// A recorded run as pictures, one for each instant, and as a film.
#pragma once

#include <optional>
#include <string>

#include "vps/errors.h"
#include "vps_device/recording.h"
#include "vps_viewer/draw/stereo.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

enum class CameraPath {
  Fixed,
  Orbit,   ///< once around the scene
  Follow,  ///< goes with the part in hand
};

struct VideoSettings {
  int width = 1280, height = 720;
  double frames_per_s = 25;
  double speed = 1;          ///< of the run in the film
  std::string view = "iso";  ///< one of standardViews()
  CameraPath path = CameraPath::Fixed;
  /// The film is its first screen, seen by its first viewer, in the screen's size; view and path do not
  /// count.
  std::optional<scenes::Display> display;
  StereoMode stereo = StereoMode::Mono;  ///< not Spectral, which needs two films
  Progress progress;
};

/// Writes FOLDER/000001.png, ... Returns their number. Throws LoadError where the recording or the folder
/// cannot be used, and for a head that only the network knows, std::runtime_error as Renderer.
VPS_VIEWER_API std::size_t writeFrames(const device::RecordedRun& run, const std::string& folder,
                                       const VideoSettings& settings);

/// Makes an MP4 file (H.264) of them with ffmpeg. Returns nothing on success, and otherwise the reason in
/// words: no ffmpeg, or what it says.
/// @param sound  WAV file; empty: a silent film
VPS_VIEWER_API std::string encodeVideo(const std::string& folder, double frames_per_s,
                                       const std::string& sound, const std::string& file);

}  // namespace vps::viewer

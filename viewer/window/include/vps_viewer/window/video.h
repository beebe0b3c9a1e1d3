// SPDX-License-Identifier: BSD-3-Clause
// A recorded run as a series of pictures, and as a film.
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
  Follow,  ///< follows the part in hand
};

struct VideoSettings {
  int width = 1280, height = 720;
  double frames_per_s = 25;
  double speed = 1;          ///< speed of playback; 1: real time
  std::string view = "iso";  ///< name of one of standardViews()
  CameraPath path = CameraPath::Fixed;
  /// If set, the film shows the first screen of the display file as its first viewer sees it, in the screen's
  /// size; `view` and `path` are ignored.
  std::optional<scenes::Display> display;
  StereoMode stereo = StereoMode::Mono;  ///< any mode but Spectral, which needs two films
  Progress progress;
};

/// Writes FOLDER/000001.png, FOLDER/000002.png and so on, and returns the number of files. Throws LoadError
/// if the recording or the folder cannot be used or the viewer's head pose comes from the network, and
/// std::runtime_error as Renderer does.
VPS_VIEWER_API std::size_t writeFrames(const device::RecordedRun& run, const std::string& folder,
                                       const VideoSettings& settings);

/// Makes an MP4 file (H.264) of the pictures in `folder` with ffmpeg. Returns an empty string on success, and
/// otherwise the reason: ffmpeg is not installed, or its error message.
/// @param sound  WAV file; empty: a silent film
VPS_VIEWER_API std::string encodeVideo(const std::string& folder, double frames_per_s,
                                       const std::string& sound, const std::string& file);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view`, which shows a scene, plays a recording, or runs a procedure.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vps_device/recording.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/model_meshes.h"
#include "vps_viewer/draw/stereo.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct WindowOptions {
  int width = 1280, height = 720;
  bool is_dark = false;
  StereoMode stereo = StereoMode::Mono;    ///< Spectral: both pictures side by side
  bool has_stereo_buffers = false;         ///< quad-buffered stereo, if the driver has it
  std::optional<scenes::Display> display;  ///< the window shows all its pictures; none: the desktop view
  std::string output;              ///< name of the display's picture that is shown alone at first; empty: all
  int full_screen = 0;             ///< monitor that the picture fills at first, counted from 1; 0: none
  bool runs = false;               ///< begins with a run of the procedure instead of the tour
  std::string hand;                ///< kind of device that moves the part in a run; empty: the scene's kind
  double speed = 1;                ///< simulated seconds per real second; 0: as fast as possible
  bool seeks_headset = false;      ///< shows the scene in a headset too, if OpenXR finds one
  bool has_sound = true;           ///< plays the sound of a run, if there is a sound card
  std::string record;              ///< file in which a run is recorded; empty: none
  std::string pictures = "view";   ///< saved pictures are PICTURES_1.png, ...
  ShownModels show;                ///< contact models shown in place of the parts
  std::vector<std::string> notes;  ///< messages that the window shows first
  scenes::ModelOptions models;     ///< contact models of a run
  const std::atomic<bool>* stop = nullptr;      ///< set it to close the window
  std::string session;                          ///< name of the session of vps render, for viewSession()
  scenes::SessionNetwork network;               ///< network of the session
  std::function<void(const std::string&)> say;  ///< shows a message before the window is open; may be empty
};

/// Reason why this build has no window, with a remedy; empty: it has one.
VPS_VIEWER_API std::string missingForWindow();

/// Opens a window and returns when it is closed. Throws std::runtime_error with a remedy if the build has no
/// window, there is no display, or OpenGL is too old.
VPS_VIEWER_API void viewScene(const scenes::Scene& scene, const WindowOptions& options);
VPS_VIEWER_API void viewRecording(const device::RecordedRun& run, const WindowOptions& options);
/// Waits for the session, then shows its run and the pointers of the other people who watch it, and plays
/// impacts. The last picture stays when the session ends. Returns the run's verdict; empty: the window was
/// closed first. Throws LoadError if the session cannot be watched.
VPS_VIEWER_API std::optional<scenes::Verdict> viewSession(const WindowOptions& options);

}  // namespace vps::viewer

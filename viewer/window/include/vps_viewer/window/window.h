// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view`: look at a scene, play a recording, watch a run.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vps_device/recording.h"
#include "vps_scenes/fits/verdict.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/model_view.h"
#include "vps_viewer/draw/stereo.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct WindowOptions {
  int width = 1280, height = 720;
  bool is_dark = false;
  StereoMode stereo = StereoMode::Mono;  ///< of Spectral both pictures are beside each other
  bool has_stereo_buffers = false;  ///< each eye's picture in a buffer of its own, where the driver has it
  std::optional<scenes::Display> display;  ///< all its pictures are in the window; none: a desktop
  std::string output;                      ///< of them the one that is shown alone at first; empty: all
  int full_screen = 0;         ///< number of the monitor that the picture fills at first, from 1; 0: a window
  bool runs = false;           ///< begins with a run of the procedure instead of the tour
  std::string hand;            ///< kind of device that moves the part in a run; empty: the scene's
  double speed = 1;            ///< of playing and of a run, by the clock; of a run, 0: as fast as it goes
  bool seeks_headset = false;  ///< shows the scene in a headset too, where OpenXR has one
  bool has_sound = true;       ///< of a run, where there is a sound card
  std::string record;          ///< file in which a run is recorded; empty: none
  std::string pictures = "view";                ///< saved pictures are PICTURES_1.png, ...
  ShownModels show;                             ///< in place of the parts
  std::vector<std::string> notes;               ///< messages that it begins with
  scenes::ModelOptions models;                  ///< of a run
  const std::atomic<bool>* stop = nullptr;      ///< set it to close the window
  std::string session;                          ///< of vps render, for viewSession()
  scenes::SessionNetwork network;               ///< where it is
  std::function<void(const std::string&)> say;  ///< before there is a window; may be empty
};

/// In words, what this build lacks for a window; empty: nothing.
VPS_VIEWER_API std::string missingForWindow();

/// Open a window and return when it is closed. Throw std::runtime_error, which names what is missing and what
/// helps: a build without a window, no display, OpenGL too old.
VPS_VIEWER_API void viewScene(const scenes::Scene& scene, const WindowOptions& options);
VPS_VIEWER_API void viewRecording(const device::RecordedRun& run, const WindowOptions& options);
/// Waits for the session, shows it and where others point, and marks places for them; hears impacts. The last
/// picture stays when it ends. Returns its verdict; empty: the window was closed before. Throws LoadError
/// where the session cannot be watched.
VPS_VIEWER_API std::optional<scenes::Verdict> viewSession(const WindowOptions& options);

}  // namespace vps::viewer

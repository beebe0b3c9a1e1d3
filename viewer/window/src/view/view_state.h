// SPDX-License-Identifier: BSD-3-Clause
// The user's choices in the window, and the effect of each key on them. Independent of GLFW.
#pragma once

#include <optional>
#include <span>

#include "view/camera_motion.h"
#include "view/picking.h"
#include "view/timeline.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

enum class Action {
  Help,
  Fit,
  View1,
  View2,
  View3,
  View4,
  View5,
  View6,
  View7,
  Explode,
  Section,
  FlipSection,
  CutHand,
  Target,
  Edges,
  Ground,
  Theme,
  PlayPause,
  Back,
  Forward,
  LastStep,
  NextStep,
  ToStart,
  ToEnd,
  RunLive,
  TakeByMouse,
  OneStep,
  Undo,
  Redo,
  Free,
  TakeOrPutDown,
  Snap,
  Path,
  Stereo,
  Output,
  FullScreen,
  Point,
  SavePicture,
  Deselect,
  Close,
};

struct KeyBinding {
  Action action;
  const char* key;   ///< name in the list of keys: "F", "Space"
  const char* does;  ///< "fits the view to what is shown"
};
/// All keys, in the order of the list that `?` shows.
VPS_VIEWER_API std::span<const KeyBinding> keyBindings();
/// The actions of the mouse, for the list that `?` shows.
VPS_VIEWER_API std::span<const KeyBinding> mouseBindings();

struct ViewState {
  Camera camera;
  PictureSize size;
  DrawOptions draw;
  double explode = 0;  ///< share of the assembly's size, see exploded()
  std::optional<PickedPlace> picked;
  double time_s = 0;
  bool is_playing = false;
  double speed = 1;  ///< speed of playback, 1: real time
  bool shows_help = false, is_dark = false;
  bool snaps = false;       ///< axis snap on the part in hand
  bool shows_path = false;  ///< the planned path of the part in hand
  StereoMode stereo = StereoMode::Mono;
  /// Index of the display file's picture that is shown alone; none: all are shown side by side.
  std::optional<std::size_t> output;
  std::size_t outputs = 1;      ///< number of the display file's pictures
  bool is_full_screen = false;  ///< without panels
  // Requests of the keys, which the window carries out and clears.
  bool wants_close = false, wants_picture_file = false, wants_run = false, wants_one_step = false,
       wants_mouse = false, wants_undo = false, wants_redo = false, wants_free = false, wants_take = false,
       wants_point = false, wants_fit = false;
};

/// The stereo mode after `mode` in the order in which the key S switches them.
VPS_VIEWER_API StereoMode nextStereo(StereoMode mode);

/// Changes the state by the action of a key.
/// @param box_W  bounds of the shown scene
VPS_VIEWER_API void apply(Action action, ViewState& state, const Timeline& line, const Box& box_W);

/// Advances the time while playing, and stops at the end.
VPS_VIEWER_API void advance(ViewState& state, const Timeline& line, double elapsed_s);

}  // namespace vps::viewer

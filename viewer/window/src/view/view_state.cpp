// SPDX-License-Identifier: BSD-3-Clause
#include "view/view_state.h"

#include <algorithm>
#include <array>

#include "view/camera_motion.h"

namespace vps::viewer {
namespace {

constexpr double kNudge_s = 0.02;  // step of the arrow keys: five rows of a trace at 250 Hz

void goTo(ViewState& state, const Timeline& line, double time_s) {
  state.time_s = std::clamp(time_s, 0.0, line.end_s);
}

/// Goes to the start of the current step; at that start, to the start of the previous step.
void goToLastStep(ViewState& state, const Timeline& line) {
  std::size_t now = line.chapterAt(state.time_s);
  if (now > 0 && state.time_s - line.chapters[now].start_s < kNudge_s) --now;
  goTo(state, line, line.chapters[now].start_s);
}

void goToNextStep(ViewState& state, const Timeline& line) {
  const std::size_t next = line.chapterAt(state.time_s) + 1;
  goTo(state, line, next < line.chapters.size() ? line.chapters[next].start_s : line.end_s);
}

void toggleSection(ViewState& state, const Box& box_W) {
  if (state.draw.cut)
    state.draw.cut.reset();
  else
    state.draw.cut = sectionFacing(state.camera, box_W);
}

/// Switches from all outputs to each output alone in turn, and then back to all outputs.
void nextOutput(ViewState& state) {
  const std::size_t next = state.output ? *state.output + 1 : 0;
  state.output = next < state.outputs && state.outputs > 1 ? std::optional(next) : std::nullopt;
}

/// Switches the stereo mode. With a display file, Spectral has two outputs (one for each eye) where other
/// modes have one, so the index of the output that is shown alone changes.
void switchStereo(ViewState& state) {
  const bool had_eyes = state.stereo == StereoMode::Spectral;
  state.stereo = nextStereo(state.stereo);
  const bool has_eyes = state.stereo == StereoMode::Spectral;
  if (!state.output || had_eyes == has_eyes) return;
  state.output = has_eyes ? 2 * *state.output : *state.output / 2;
}

void playOrPause(ViewState& state, const Timeline& line) {
  if (!state.is_playing && state.time_s >= line.end_s) state.time_s = 0;
  state.is_playing = !state.is_playing;
}

}  // namespace

StereoMode nextStereo(StereoMode mode) {
  switch (mode) {
    case StereoMode::Mono:
      return StereoMode::SideBySide;
    case StereoMode::SideBySide:
      return StereoMode::TopBottom;
    case StereoMode::TopBottom:
      return StereoMode::Anaglyph;
    case StereoMode::Anaglyph:
      return StereoMode::Interleaved;
    case StereoMode::Interleaved:
      return StereoMode::Spectral;
    case StereoMode::Spectral:
      break;
  }
  return StereoMode::Mono;
}

std::span<const KeyBinding> keyBindings() {
  static constexpr std::array kKeys = {
      KeyBinding{Action::Help, "?", "shows or hides this list"},
      KeyBinding{Action::Fit, "F", "fits the view to what is shown"},
      KeyBinding{Action::View1, "1", "view from the front, right and above"},
      KeyBinding{Action::View2, "2", "front view"},
      KeyBinding{Action::View3, "3", "back view"},
      KeyBinding{Action::View4, "4", "left view"},
      KeyBinding{Action::View5, "5", "right view"},
      KeyBinding{Action::View6, "6", "top view"},
      KeyBinding{Action::View7, "7", "bottom view"},
      KeyBinding{Action::Explode, "E", "exploded view on or off"},
      KeyBinding{Action::Section, "X", "section on or off, perpendicular to the view"},
      KeyBinding{Action::FlipSection, "V", "the section cuts away the other half"},
      KeyBinding{Action::CutHand, "C", "the section cuts the part in hand: yes or no"},
      KeyBinding{Action::Target, "T", "shows or hides the target"},
      KeyBinding{Action::Edges, "L", "shows or hides edge lines"},
      KeyBinding{Action::Ground, "G", "shows or hides the shadow on the floor"},
      KeyBinding{Action::Theme, "D", "dark or light colours"},
      KeyBinding{Action::PlayPause, "Space", "plays or pauses"},
      KeyBinding{Action::Back, "Left", "goes back by 20 ms"},
      KeyBinding{Action::Forward, "Right", "goes forward by 20 ms"},
      KeyBinding{Action::LastStep, "Up", "goes to the start of this step, then of the previous step"},
      KeyBinding{Action::NextStep, "Down", "goes to the next step"},
      KeyBinding{Action::ToStart, "Home", "goes to the start"},
      KeyBinding{Action::ToEnd, "End", "goes to the end"},
      KeyBinding{Action::RunLive, "R", "runs the procedure, or goes back to the tour"},
      KeyBinding{Action::TakeByMouse, "H", "moves the parts by the mouse, or goes back to the tour"},
      KeyBinding{Action::OneStep, "N", "makes one physics step of a paused run"},
      KeyBinding{Action::Undo, "Z", "undoes the last step; the run continues from the state before"},
      KeyBinding{Action::Redo, "Y", "redoes the step that Z undid"},
      KeyBinding{Action::Free, "U", "begins free assembly without a procedure, or goes back to the tour"},
      KeyBinding{Action::TakeOrPutDown, "Enter", "in free assembly: takes the picked part, or puts it down"},
      KeyBinding{Action::Snap, "A", "axis snap on or off: a spring guides the part to its axis"},
      KeyBinding{Action::Path, "W", "shows or hides the planned path"},
      KeyBinding{Action::Stereo, "S",
                 "stereo: none, side by side, top and bottom, anaglyph, interleaved, spectral"},
      KeyBinding{Action::Output, "O", "with a display file: all its pictures, or each one alone"},
      KeyBinding{Action::FullScreen, "F11", "full screen on or off: the picture alone on the monitor"},
      KeyBinding{Action::Point, "M", "in a session: marks the picked place for all, or removes the mark"},
      KeyBinding{Action::SavePicture, "P", "saves the picture to a PNG file"},
      KeyBinding{Action::Deselect, "Escape", "deselects the part"},
      KeyBinding{Action::Close, "Q", "closes the window"}};
  return kKeys;
}

std::span<const KeyBinding> mouseBindings() {
  static constexpr std::array kMouse = {
      KeyBinding{Action::Help, "left drag", "orbits"},
      KeyBinding{Action::Help, "middle or right drag", "pans"},
      KeyBinding{Action::Help, "wheel", "zooms at the cursor"},
      KeyBinding{Action::Help, "left click", "picks a part"},
      KeyBinding{Action::Help, "Ctrl + left drag", "moves the section"},
      KeyBinding{Action::Help, "Ctrl + right drag", "tilts the section"},
      KeyBinding{Action::Help, "on the part in hand, in a run by the mouse:", ""},
      KeyBinding{Action::Help, "left drag", "moves the part along the screen"},
      KeyBinding{Action::Help, "Shift + left drag, wheel", "moves the part in depth"},
      KeyBinding{Action::Help, "right drag", "turns the part"},
      KeyBinding{Action::Help, "Shift + right drag", "turns the part about the line of sight"}};
  return kMouse;
}

void apply(Action action, ViewState& state, const Timeline& line, const Box& box_W) {
  const auto look = [&](std::size_t view) {
    state.camera = cameraFor(standardViews()[view], box_W, state.size);
  };
  switch (action) {
    case Action::Help:
      state.shows_help = !state.shows_help;
      break;
    case Action::Fit:
      state.camera = fitted(state.camera, box_W, state.size);
      break;
    case Action::View1:
    case Action::View2:
    case Action::View3:
    case Action::View4:
    case Action::View5:
    case Action::View6:
    case Action::View7:
      look(static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::View1));
      break;
    case Action::Explode:
      state.explode = state.explode > 0 ? 0 : 1;
      state.wants_fit = true;  // the view is fitted once the parts have moved
      break;
    case Action::Section:
      toggleSection(state, box_W);
      break;
    case Action::FlipSection:
      if (state.draw.cut) state.draw.cut->n_W = -state.draw.cut->n_W;
      break;
    case Action::CutHand:
      if (state.draw.cut) state.draw.cut->cuts_hand = !state.draw.cut->cuts_hand;
      break;
    case Action::Target:
      state.draw.show_target = !state.draw.show_target;
      break;
    case Action::Edges:
      state.draw.show_edges = !state.draw.show_edges;
      break;
    case Action::Ground:
      state.draw.show_ground = !state.draw.show_ground;
      break;
    case Action::Theme:
      state.is_dark = !state.is_dark;
      state.draw.is_dark = state.is_dark;
      break;
    case Action::PlayPause:
      playOrPause(state, line);
      break;
    case Action::Back:
      goTo(state, line, state.time_s - kNudge_s);
      break;
    case Action::Forward:
      goTo(state, line, state.time_s + kNudge_s);
      break;
    case Action::LastStep:
      goToLastStep(state, line);
      break;
    case Action::NextStep:
      goToNextStep(state, line);
      break;
    case Action::ToStart:
      state.time_s = 0;
      break;
    case Action::ToEnd:
      state.time_s = line.end_s;
      break;
    case Action::RunLive:
      state.wants_run = true;
      break;
    case Action::TakeByMouse:
      state.wants_mouse = true;
      break;
    case Action::OneStep:
      state.wants_one_step = true;
      break;
    case Action::Undo:
      state.wants_undo = true;
      break;
    case Action::Redo:
      state.wants_redo = true;
      break;
    case Action::Free:
      state.wants_free = true;
      break;
    case Action::TakeOrPutDown:
      state.wants_take = true;
      break;
    case Action::Snap:
      state.snaps = !state.snaps;
      break;
    case Action::Path:
      state.shows_path = !state.shows_path;
      break;
    case Action::Stereo:
      switchStereo(state);
      break;
    case Action::Output:
      nextOutput(state);
      break;
    case Action::FullScreen:
      state.is_full_screen = !state.is_full_screen;
      break;
    case Action::SavePicture:
      state.wants_picture_file = true;
      break;
    case Action::Point:
      state.wants_point = true;
      break;
    case Action::Deselect:
      state.picked.reset();
      state.shows_help = false;
      break;
    case Action::Close:
      state.wants_close = true;
      break;
  }
}

void advance(ViewState& state, const Timeline& line, double elapsed_s) {
  if (!state.is_playing) return;
  state.time_s += state.speed * elapsed_s;
  if (state.time_s < line.end_s) return;
  state.time_s = line.end_s;
  state.is_playing = false;
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include <cmath>

#include "glfw/session.h"
#include "view/camera_motion.h"

namespace vps::viewer {
namespace {

void dragOnPicture(Session& session, const ImGuiIO& io) {
  ViewState& view = session.view;
  const PixelPlace drag = {io.MouseDelta.x, io.MouseDelta.y};
  if (drag[0] == 0 && drag[1] == 0) return;
  // A frame may report a press together with motion of the mouse from before the press.
  for (const ImGuiMouseButton button :
       {ImGuiMouseButton_Left, ImGuiMouseButton_Right, ImGuiMouseButton_Middle})
    if (ImGui::IsMouseClicked(button)) return;
  const bool is_left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  const bool is_other =
      ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  if (io.KeyCtrl && view.draw.cut) {
    if (is_left) dragSection(*view.draw.cut, view.camera, drag, session.focus.size, session.box_W());
    if (is_other) tiltSection(*view.draw.cut, view.camera, drag, session.focus.size);
  } else if (is_other) {
    pan(view.camera, drag, session.focus.size);
  } else if (is_left) {
    orbit(view.camera, drag, session.focus.size);
  }
}

void zoomAt(Session& session, const PixelPlace& at, float clicks) {
  const double size_m = session.box_W().size().norm();
  zoom(session.view.camera, std::pow(1.2, clicks), at, session.focus.size, 1e-3 * size_m, 20 * size_m);
}

std::optional<PickedPlace> pickAt(const Session& session, const PixelPlace& at) {
  return pick(session.drawn, session.placed, session.view.draw,
              rayThrough(session.view.camera, at, session.focus.size));
}

/// Converts a place in the stereo picture to a place in the picture of one eye.
PixelPlace inOneEye(StereoMode mode, PixelPlace at, PictureSize size) {
  const auto half = [](double x, int whole) { return 2 * std::fmod(x, 0.5 * std::max(1, whole)); };
  if (mode == StereoMode::SideBySide) at[0] = half(at[0], size.width);
  if (mode == StereoMode::TopBottom) at[1] = half(at[1], size.height);
  return at;
}

/// Grabs the part in hand when a button is pressed on it, and releases it when all buttons are up.
void grabOrLetGo(Session& session, const ImGuiIO& io, const PixelPlace& at) {
  const bool is_pressed =
      ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Right);
  if (is_pressed && !io.KeyCtrl && !session.drag.isGrabbed() && session.view.explode == 0) {
    const scenes::BodySnapshot* body = partInHand(session.shown);
    const std::optional<PickedPlace> place = pickAt(session, at);
    if (body != nullptr && place && place->part == body->part) session.drag.grab(place->p_W, session.shown);
  }
  const bool is_down =
      ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Right);
  if (session.drag.isGrabbed() && !is_down) session.drag.letGo(session.shown);
}

void dragPart(Session& session, const ImGuiIO& io) {
  const PixelPlace drag = {io.MouseDelta.x, io.MouseDelta.y};
  const bool turns = ImGui::IsMouseDown(ImGuiMouseButton_Right);
  const HandMotion motion = turns ? (io.KeyShift ? HandMotion::Twist : HandMotion::Turn)
                                  : (io.KeyShift ? HandMotion::Depth : HandMotion::Across);
  if (drag[0] != 0 || drag[1] != 0) session.drag.drag(session.view.camera, drag, session.focus.size, motion);
  constexpr double kWheelStep = 0.01;  // distance per click of the wheel, as a share of the scene's size
  if (io.MouseWheel != 0)
    session.drag.pull(session.view.camera, kWheelStep * io.MouseWheel * session.box_W().size().norm());
}

/// Whether the left button was pressed and released at one place without moving in between.
bool isClick(const ImGuiIO& io) {
  constexpr float kClick_px = 3;  // a press that moved farther is a drag, even if it came back
  return ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !io.KeyCtrl &&
         io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < kClick_px * kClick_px;
}

}  // namespace

void useMouse(Session& session) {
  if (session.holding_hand) return;  // a headset's controller holds the part
  const ImGuiIO& io = ImGui::GetIO();
  const PixelPlace at =
      inOneEye(session.view.stereo, {io.MousePos.x - session.focus.x, io.MousePos.y - session.focus.y},
               session.focus.size);
  if (session.drag.isGrabbed()) {  // the drag continues while the cursor is over the panels
    dragPart(session, io);
    return grabOrLetGo(session, io, at);
  }
  if (io.WantCaptureMouse || session.focus.size.width <= 0) return;
  if (session.isByMouse()) {
    grabOrLetGo(session, io, at);
    if (session.drag.isGrabbed()) return;
  }
  dragOnPicture(session, io);
  if (io.MouseWheel != 0) zoomAt(session, at, io.MouseWheel);
  if (isClick(io)) session.view.picked = pickAt(session, at);
}

}  // namespace vps::viewer

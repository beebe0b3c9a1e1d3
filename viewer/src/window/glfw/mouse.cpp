// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include <cmath>

#include "window/glfw/session.h"
#include "window/section_drag.h"

namespace vps::viewer::inline v0 {
namespace {

void dragOnPicture(Session& session, const ImGuiIO& io) {
  ViewState& view = session.view;
  const PixelPlace drag = {io.MouseDelta.x, io.MouseDelta.y};
  if (drag[0] == 0 && drag[1] == 0) return;
  const bool is_left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  const bool is_other =
      ImGui::IsMouseDown(ImGuiMouseButton_Right) || ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  if (io.KeyCtrl && view.draw.cut) {
    if (is_left) dragSection(*view.draw.cut, view.camera, drag, session.area.size, session.box_W());
    if (is_other) tiltSection(*view.draw.cut, view.camera, drag, session.area.size);
  } else if (is_other) {
    pan(view.camera, drag, session.area.size);
  } else if (is_left) {
    orbit(view.camera, drag, session.area.size);
  }
}

}  // namespace

void useMouse(Session& session) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || session.area.size.width <= 0) return;
  const PixelPlace at = {io.MousePos.x - session.area.x, io.MousePos.y - session.area.y};
  dragOnPicture(session, io);
  if (io.MouseWheel != 0) {
    const double size_m = session.box_W().size().norm();
    zoom(session.view.camera, std::pow(1.2, io.MouseWheel), at, session.area.size, 1e-3 * size_m,
         20 * size_m);
  }
  constexpr float kClick_px = 3;  // a press that moves farther is a drag
  const bool is_click = ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
                        ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0).x == 0 &&
                        std::hypot(io.MousePos.x - io.MouseClickedPos[0].x,
                                   io.MousePos.y - io.MouseClickedPos[0].y) < kClick_px;
  if (is_click && !io.KeyCtrl)
    session.view.picked = pick(session.drawn, session.placed, session.view.draw,
                               rayThrough(session.view.camera, at, session.area.size));
}

}  // namespace vps::viewer::inline v0

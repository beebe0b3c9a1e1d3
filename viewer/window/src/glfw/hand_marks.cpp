// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include "glfw/session.h"
#include "marks/marks.h"
#include "run/hand_mark.h"
#include "vps_scenes/cad/srgb.h"

namespace vps::viewer {
namespace {

ImU32 packed(const Eigen::Vector3f& linear) {
  return IM_COL32(scenes::srgbByte(linear.x()), scenes::srgbByte(linear.y()), scenes::srgbByte(linear.z()),
                  255);
}

/// White below, so that it is seen on light and dark parts; the bar before it has the force's colour.
void label(ImDrawList& list, ImVec2 at, ImU32 color, const char* words) {
  const ImVec2 size = ImGui::CalcTextSize(words);
  list.AddRectFilled({at.x - 14, at.y - 2}, {at.x - 4, at.y + size.y + 2}, color, 2);
  list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2},
                     IM_COL32(255, 255, 255, 220), 4);
  list.AddRect({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, color, 4);
  list.AddText(at, IM_COL32(20, 20, 20, 255), words);
}

}  // namespace

void drawHandMarks(const Session& session) {
  if (!session.isByHand()) return;
  const scenes::BodySnapshot* body = partInHand(session.shown);
  if (body == nullptr || !session.shown.has_hand) return;
  const PictureSize size = session.focus.size;
  const auto onScreen = [&](const PixelPlace& at) {
    return ImVec2(session.focus.x + static_cast<float>(at[0]), session.focus.y + static_cast<float>(at[1]));
  };
  const auto place = [&](const Vec3& p_W) {
    return onScreen(session.view.camera.project(p_W, size.width, size.height));
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const HandMark mark = handMark(session.shown);
  const ImU32 color = packed(depthColor(mark.share));
  const StereoMode stereo = session.view.stereo;
  if (stereo != StereoMode::Mono || !session.drag.isGrabbed()) {
    const bool is_begun = session.shown.time_s > 0 || !session.isByMouse();
    for (const PixelPlace& at : handMarkPlaces(stereo, session.shown.X_W_Proxy.p, session.view.camera, size))
      label(list, onScreen(at), color, is_begun ? mark.words.c_str() : "drag this part");
    return;
  }
  const ImVec2 from = place(session.drag.grabbedPoint(body->X_WP)), to = place(session.drag.cursorPoint());
  list.AddLine(from, to, IM_COL32(255, 255, 255, 200), 5);
  list.AddLine(from, to, color, 3);
  list.AddCircleFilled(from, 5, color);
  list.AddCircle(to, 7, color, 0, 2);
  label(list, {to.x + 14, to.y + 8}, color, mark.words.c_str());
}

}  // namespace vps::viewer

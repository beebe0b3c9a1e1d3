// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "draw/marks.h"
#include "image/srgb.h"
#include "window/glfw/session.h"

namespace vps::viewer::inline v0 {
namespace {

ImU32 packed(const Eigen::Vector3f& linear) {
  return IM_COL32(srgbByte(linear.x()), srgbByte(linear.y()), srgbByte(linear.z()), 255);
}

/// Dark below, so that it is seen on light and dark parts.
void label(ImDrawList& list, ImVec2 at, ImU32 color, const char* words) {
  const ImVec2 size = ImGui::CalcTextSize(words);
  list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2},
                     IM_COL32(255, 255, 255, 220), 4);
  list.AddRect({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, color, 4);
  list.AddText(at, IM_COL32(20, 20, 20, 255), words);
}

}  // namespace

void drawHandMarks(const Session& session) {
  if (!session.isByMouse()) return;
  const scenes::BodySnapshot* body = partInHand(session.shown);
  if (body == nullptr || !session.shown.has_hand) return;
  const PictureSize size = session.area.size;
  const auto place = [&](const Vec3& p_W) {
    const auto [x, y] = session.view.camera.project(p_W, size.width, size.height);
    return ImVec2(session.area.x + static_cast<float>(x), session.area.y + static_cast<float>(y));
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const double force_N = session.shown.F_hand_W.f.norm(), torque_Nm = session.shown.F_hand_W.tau.norm();
  const device::PulledHandleSettings limits;
  const ImU32 color = packed(depthColor(std::max(force_N / limits.force_N, torque_Nm / limits.torque_Nm)));
  char words[64];
  std::snprintf(words, sizeof words, "%.1f N  %.2f N m", force_N, torque_Nm);
  if (!session.drag.isGrabbed()) {
    const ImVec2 at = place(session.shown.X_W_Proxy.p);
    return label(list, {at.x + 16, at.y}, color, session.shown.time_s > 0 ? words : "drag this part");
  }
  const ImVec2 from = place(session.drag.grabbedPoint(body->X_WP)), to = place(session.drag.cursorPoint());
  list.AddLine(from, to, IM_COL32(255, 255, 255, 200), 5);
  list.AddLine(from, to, color, 3);
  list.AddCircleFilled(from, 5, color);
  list.AddCircle(to, 7, color, 0, 2);
  label(list, {to.x + 14, to.y + 8}, color, words);
}

}  // namespace vps::viewer::inline v0

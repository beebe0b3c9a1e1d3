// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include "glfw/session.h"

namespace vps::viewer {
namespace {

constexpr ImU32 kOthers = IM_COL32(214, 39, 140, 255), kOwn = IM_COL32(20, 130, 60, 255);
constexpr ImU32 kPointerRim = IM_COL32(255, 255, 255, 230);
constexpr float kPointer_px = 9;

}  // namespace

void drawPointerMarks(const Session& session) {
  if (session.followed == nullptr || session.view.explode > 0) return;
  const PictureSize size = session.focus.size;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto mark = [&](const Vec3& p_W, ImU32 color) {
    const auto [x, y] = session.view.camera.project(p_W, size.width, size.height);
    const ImVec2 at(session.focus.x + static_cast<float>(x), session.focus.y + static_cast<float>(y));
    list.AddCircleFilled(at, kPointer_px + 3, kPointerRim);
    list.AddCircleFilled(at, kPointer_px, color);
    list.AddCircle(at, 2.2f * kPointer_px, color, 0, 3);
  };
  for (const auto& [person, p_W] : session.followed->pointers()) mark(p_W, kOthers);
  if (session.followed->pointing()) mark(*session.followed->pointing(), kOwn);
}

}  // namespace vps::viewer

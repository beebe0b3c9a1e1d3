// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include "glfw/session.h"
#include "view/planned_path.h"

namespace vps::viewer {
namespace {

constexpr ImU32 kPath = IM_COL32(0, 90, 160, 255), kAxis = IM_COL32(170, 70, 0, 255);
constexpr ImU32 kRim = IM_COL32(255, 255, 255, 200);  // so that a line is seen on dark parts too

}  // namespace

void drawPathMarks(const Session& session) {
  const ViewState& view = session.view;
  if (!(view.shows_path || view.snaps) || view.explode > 0 || session.work.isFree()) return;
  const PlannedPath path = plannedPath(session.scene, session.shown);
  if (path.points_W.empty()) return;
  const PictureSize size = session.focus.size;
  const auto place = [&](const Vec3& p_W) {
    const auto [x, y] = view.camera.project(p_W, size.width, size.height);
    return ImVec2(session.focus.x + static_cast<float>(x), session.focus.y + static_cast<float>(y));
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto line = [&](const Vec3& a_W, const Vec3& b_W, ImU32 color) {
    list.AddLine(place(a_W), place(b_W), kRim, 4);
    list.AddLine(place(a_W), place(b_W), color, 2);
  };
  if (view.snaps && !path.axis_W.isZero()) {
    // Dashed over the last leg, and half as far beyond both of its ends.
    constexpr int kDashes = 24;
    const Vec3& to_W = path.points_W.back();
    const Vec3 leg_W = to_W - path.points_W[path.points_W.size() - 2];
    for (int i = 0; i < kDashes; ++i) {
      const double from = -1.5 + 2.0 * i / kDashes;
      line(to_W + from * leg_W, to_W + (from + 1.2 / kDashes) * leg_W, kAxis);
    }
  }
  if (!view.shows_path) return;
  for (std::size_t i = 1; i < path.points_W.size(); ++i) line(path.points_W[i - 1], path.points_W[i], kPath);
  for (std::size_t i = 0; i < path.points_W.size(); ++i) {
    const bool is_target = i + 1 == path.points_W.size();
    list.AddCircleFilled(place(path.points_W[i]), is_target ? 6.0f : 4.0f, kRim);
    list.AddCircleFilled(place(path.points_W[i]), is_target ? 5.0f : 3.0f, kPath);
  }
}

}  // namespace vps::viewer

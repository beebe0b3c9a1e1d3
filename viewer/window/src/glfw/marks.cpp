// SPDX-License-Identifier: BSD-3-Clause
#include <imgui.h>

#include "glfw/session.h"
#include "marks/marks.h"
#include "run/hand_drag.h"
#include "view/procedure_view.h"
#include "vps_scenes/cad/colors.h"

namespace vps::viewer {
namespace {

ImU32 packed(const Eigen::Vector3f& linear) {
  return IM_COL32(scenes::srgbByte(linear.x()), scenes::srgbByte(linear.y()), scenes::srgbByte(linear.z()),
                  255);
}

/// Draws a label on white, so that it is legible on light and dark parts, with a bar in the force's colour.
void label(ImDrawList& list, ImVec2 at, ImU32 color, const char* words) {
  const ImVec2 size = ImGui::CalcTextSize(words);
  list.AddRectFilled({at.x - 14, at.y - 2}, {at.x - 4, at.y + size.y + 2}, color, 2);
  list.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2},
                     IM_COL32(255, 255, 255, 220), 4);
  list.AddRect({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, color, 4);
  list.AddText(at, IM_COL32(20, 20, 20, 255), words);
}

constexpr ImU32 kPath = IM_COL32(0, 90, 160, 255), kAxis = IM_COL32(170, 70, 0, 255);
constexpr ImU32 kRim = IM_COL32(255, 255, 255, 200);  // makes a line visible on dark parts

constexpr ImU32 kOthers = IM_COL32(214, 39, 140, 255), kOwn = IM_COL32(20, 130, 60, 255);
constexpr ImU32 kPointerRim = IM_COL32(255, 255, 255, 230);
constexpr float kPointer_px = 9;

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
    // The axis is a dashed line over the last leg and half its length beyond both ends.
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

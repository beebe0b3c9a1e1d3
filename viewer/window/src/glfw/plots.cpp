// SPDX-License-Identifier: BSD-3-Clause
// Curves over time, drawn with Dear ImGui.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>

#include "glfw/session.h"

namespace vps::viewer {
namespace {

// Okabe and Ito's colours, which people with common kinds of colour blindness can tell apart.
constexpr ImU32 kColors[] = {IM_COL32(0, 114, 178, 255), IM_COL32(213, 94, 0, 255),
                             IM_COL32(0, 158, 115, 255), IM_COL32(204, 121, 167, 255),
                             IM_COL32(230, 159, 0, 255), IM_COL32(86, 180, 233, 255)};

struct Frame {
  ImVec2 low, high;
  double end_s;
  float top;  ///< value at the upper edge

  [[nodiscard]] float x(double t_s) const {
    return low.x + (high.x - low.x) * static_cast<float>(end_s > 0 ? t_s / end_s : 0);
  }
  [[nodiscard]] float y(float value) const { return high.y - (high.y - low.y) * value / top; }
};

/// Draws one vertical line per column of pixels, from the least to the greatest value in the column. A column
/// without known values stays empty.
void drawCurve(ImDrawList& list, const Frame& frame, const std::vector<double>& time_s,
               const std::vector<float>& values, ImU32 color) {
  const std::size_t count = std::min(time_s.size(), values.size());
  std::size_t i = 0;
  std::optional<float> before_y;
  while (i < count) {
    if (!std::isfinite(values[i])) {
      before_y.reset();
      ++i;
      continue;
    }
    const float column = std::floor(frame.x(time_s[i]));
    float low = values[i], high = values[i];
    const float last_y = before_y.value_or(frame.y(values[i]));
    for (; i < count && std::isfinite(values[i]) && std::floor(frame.x(time_s[i])) == column; ++i) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    const float y0 = std::max(frame.y(low), last_y), y1 = std::min(frame.y(high), last_y);
    list.AddRectFilled({column, y1}, {column + 1.5f, std::max(y0, y1 + 1.5f)}, color);
    before_y = frame.y(values[i - 1]);
  }
}

float valueAt(const Timeline& line, const Curve& curve, double t_s) {
  const auto after = std::upper_bound(line.time_s.begin(), line.time_s.end(), t_s);
  if (after == line.time_s.begin() || curve.values.empty()) return 0;
  const auto i = static_cast<std::size_t>(after - line.time_s.begin()) - 1;
  return curve.values[std::min(i, curve.values.size() - 1)];
}

}  // namespace

void drawPlots(const Timeline& line, double* now_s, float scale, bool may_seek) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::size_t color = 0;
  for (const Curve& curve : line.curves) {
    char now[32];
    const float value = valueAt(line, curve, *now_s);
    std::snprintf(now, sizeof now, std::isfinite(value) ? "%.3g" : "-", static_cast<double>(value));
    float most = 0;
    for (const float each : curve.values)
      if (each > most) most = each;
    ImGui::Text("%s %s %s   (at most %.3g)", curve.name.c_str(), now, curve.unit.c_str(),
                static_cast<double>(most));
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 44 * scale);
    ImGui::InvisibleButton(curve.name.c_str(), size);
    const Frame frame = {low, {low.x + size.x, low.y + size.y}, line.end_s, std::max(most, 1e-9f) * 1.05f};
    list.AddRectFilled(frame.low, frame.high, ImGui::GetColorU32(ImGuiCol_FrameBg));
    drawCurve(list, frame, line.time_s, curve.values, kColors[color++ % std::size(kColors)]);
    for (const Chapter& chapter : line.chapters)
      list.AddLine({frame.x(chapter.start_s), frame.low.y}, {frame.x(chapter.start_s), frame.high.y},
                   ImGui::GetColorU32(ImGuiCol_Border));
    list.AddLine({frame.x(*now_s), frame.low.y}, {frame.x(*now_s), frame.high.y},
                 ImGui::GetColorU32(ImGuiCol_Text));
    if (may_seek && ImGui::IsItemActive() && size.x > 0)
      *now_s = std::clamp(double((ImGui::GetIO().MousePos.x - low.x) / size.x), 0.0, 1.0) * line.end_s;
  }
}

}  // namespace vps::viewer

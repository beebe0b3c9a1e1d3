// SPDX-License-Identifier: BSD-3-Clause
#include "pages/bar_svg.h"

#include <algorithm>

#include "files/html.h"

namespace vps::viewer {

namespace {

using html::format;

constexpr double kWidth = 912, kNames = 200, kValues = 170;  // [px]
constexpr double kRow = 26, kBarHeight = 16;                 // [px]
constexpr double kChartHeight = 150, kAxis = 22;             // [px] of a histogram

std::string attribute(const char* name, double value) {
  return std::string(" ").append(name).append("=\"").append(format(value, "%.1f")).append("\"");
}

std::string rectangle(double x, double y, double width, double height, const std::string& color) {
  return "<rect" + attribute("x", x) + attribute("y", y) + attribute("width", width) +
         attribute("height", height) + " fill=\"" + color + "\"/>\n";
}

std::string words(double x, double y, const char* anchor, const std::string& text) {
  return std::string("<text") + attribute("x", x) + attribute("y", y) + " text-anchor=\"" + anchor + "\">" +
         escapeHtml(text) + "</text>\n";
}

std::string figure(double height, const std::string& shapes, const std::string& caption_html) {
  return "<figure class=\"section\"><svg viewBox=\"0 0 " + format(kWidth, "%.0f ") + format(height, "%.0f") +
         "\" font-family=\"system-ui, DejaVu Sans, sans-serif\" font-size=\"13\" fill=\"#222\">\n" + shapes +
         "</svg><figcaption>" + caption_html + "</figcaption></figure>\n";
}

}  // namespace

std::string barChart(const std::vector<Bar>& bars, const std::string& caption_html) {
  double most = 0;
  for (const Bar& bar : bars) most = std::max(most, bar.value);
  std::string shapes;
  const double room = kWidth - kNames - kValues;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const Bar& bar = bars[i];
    const double top = kRow * static_cast<double>(i), length = most > 0 ? room * bar.value / most : 0;
    shapes += words(kNames - 8, top + 17, "end", bar.name);
    shapes += rectangle(kNames, top + 5, std::max(length, 1.0), kBarHeight, bar.color);
    shapes += words(kNames + length + 8, top + 17, "start", bar.text);
  }
  return figure(kRow * static_cast<double>(bars.size()) + 4, shapes, caption_html);
}

std::string histogram(const std::vector<Column>& columns, const std::string& left_text,
                      const std::string& right_text, const std::string& caption_html) {
  double most = 1;
  for (const Column& column : columns) most = std::max(most, column.lower + column.upper);
  const double width = kWidth / static_cast<double>(std::max<std::size_t>(1, columns.size()));
  std::string shapes;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double x = width * static_cast<double>(i) + 1, scale = kChartHeight / most;
    const double lower = columns[i].lower * scale, upper = columns[i].upper * scale;
    if (lower > 0) shapes += rectangle(x, kChartHeight - lower, width - 2, lower, "#1b6e3c");
    if (upper > 0) shapes += rectangle(x, kChartHeight - lower - upper, width - 2, upper, "#b00020");
  }
  shapes += rectangle(0, kChartHeight, kWidth, 1, "#888");
  shapes += words(0, kChartHeight + 16, "start", left_text);
  shapes += words(kWidth, kChartHeight + 16, "end", right_text);
  return figure(kChartHeight + kAxis, shapes, caption_html);
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "pages/svg.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "files/html.h"
#include "pages/section_shapes.h"
#include "vps_scenes/fits/check_types.h"

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

namespace {

using svg::filled;
using svg::key;
using svg::kFoot;
using svg::kGap;
using svg::kSide;
using svg::kTop;
using svg::pathOf;
using svg::Point;
using svg::scaleBar;
using svg::Window;

/// Fills of the two parts; the first is the inner one of a fit.
constexpr std::array kFills = {"#9db9dd", "#dcc79c"};

std::string drawn(const scenes::CheckedSection& section, const Window& window, const std::string& id) {
  std::string out = "<clipPath id=\"w" + id + "\">" + svg::rectangle(window.left, kTop, kSide, kSide, "") +
                    "</clipPath>\n<g clip-path=\"url(#w" + id + ")\">\n" +
                    svg::rectangle(window.left, kTop, kSide, kSide, "fill=\"#fff\"");
  for (std::size_t i = 2; i < section.parts.size(); ++i) {
    const std::string path = pathOf(section.parts[i], window);
    if (!path.empty())
      out += filled(path, i % 2 == 0 ? "#e3e3e3" : "#cfd3cf",
                    "data-part=\"" + escapeHtml(section.parts[i].part) + "\"");
  }
  // The outer part is drawn first, so that it does not hide a shaft.
  const std::array<std::string, 2> paths = {pathOf(section.parts[0], window),
                                            pathOf(section.parts[1], window)};
  for (const std::size_t i : {1U, 0U})
    out += filled(paths[i], kFills[i], "data-part=\"" + escapeHtml(section.parts[i].part) + "\"");
  out += "<clipPath id=\"o" + id + "\"><path d=\"" + paths[1] + "\" clip-rule=\"evenodd\"/></clipPath>\n" +
         "<g clip-path=\"url(#o" + id + ")\">" + filled(paths[0], "#e0202f") + "</g>\n";
  return out + "</g>\n" + svg::rectangle(window.left, kTop, kSide, kSide, "fill=\"none\" stroke=\"#999\"") +
         scaleBar(window);
}

std::string captionOf(const scenes::CheckResult& result, const scenes::CheckedSection& section) {
  constexpr double kZero_m = 5e-9;  // is written as 0.00 µm
  std::string out;
  if (section.is_fit) {
    const scenes::CheckedFit& fit = result.fits[section.of];
    const bool is_shaft = fit.kind != scenes::FitKind::Key;
    out =
        "<b>" + escapeHtml(fit.shaft) + "</b> in <b>" + escapeHtml(fit.bore) +
        "</b>: " + (is_shaft ? "⌀ " : "width ") + format(1e3 * fit.shaft_m, "%.4f") + " in " +
        format(1e3 * fit.bore_m, "%.4f") + " mm, " +
        (fit.diametral_clearance_m < -kZero_m ? "interference " : "clearance ") +
        lengthOnPage(std::abs(fit.diametral_clearance_m)) + " ± " + lengthOnPage(fit.error_m) +
        (is_shaft ? " in diameter, so half of this value to each side if centred" : " both sides together") +
        (standardOf(fit).empty() ? "" : "; " + standardOf(fit));
    out += is_shaft ? ". Section through the axis" : ". Section across the length";
  } else {
    const scenes::CheckedPair& pair = result.pairs[section.of];
    out = "<b>" + escapeHtml(pair.a) + "</b> and <b>" + escapeHtml(pair.b) + "</b> overlap by " +
          lengthOnPage(pair.interference_depth_m) + " ± " + lengthOnPage(pair.error_m) + " (" +
          toText(pair.state) + "). Section through the deepest place, along the depth";
  }
  out += "; the right picture shows the small square " +
         format(section.half_m / section.near_half_m, "%.0f") + " times as large.";
  if (std::ranges::any_of(section.parts, &scenes::SectionOutline::is_open))
    out += " A surface has holes here; its outline is closed by straight lines.";
  return out;
}

}  // namespace

std::string sectionSvg(const scenes::CheckResult& result, const scenes::CheckedSection& section,
                       std::size_t id) {
  const Window whole{{0, 0}, section.half_m, 1}, near{section.near_m, section.near_half_m, 1 + kSide + kGap};
  const double width = 2 * kSide + kGap + 2, height = kTop + kSide + kFoot + 22;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + format(width, "%.0f") + " " +
                    format(height, "%.0f") + "\" font-family=\"DejaVu Sans, sans-serif\" font-size=\"12\">\n";
  const std::string name = std::to_string(id);
  out += drawn(section, whole, name + "a") + drawn(section, near, name + "b");
  // A frame in the left picture marks the region of the right one.
  const Point middle = whole.toPixel(section.near_m);
  const double half = std::max(5.0, section.near_half_m * whole.scale());
  out += svg::rectangle(middle[0] - half, middle[1] - half, 2 * half, 2 * half,
                        "fill=\"none\" stroke=\"#d0007f\" stroke-width=\"1.6\"");
  out +=
      svg::rectangle(near.left, kTop, kSide, kSide, "fill=\"none\" stroke=\"#d0007f\" stroke-width=\"1.6\"");
  const double y = kTop + kSide + kFoot + 10;
  out += key(3, y, kFills[0], escapeHtml(section.parts[0].part)) +
         key(3 + 0.5 * kSide, y, kFills[1], escapeHtml(section.parts[1].part));
  const bool overlaps = section.is_fit ? result.fits[section.of].diametral_clearance_m < 0 : true;
  if (overlaps) out += key(near.left, y, "#e0202f", "overlap");
  if (section.parts.size() > 2) out += key(near.left + 0.5 * kSide, y, "#e3e3e3", "other parts");
  return out + "</svg>\n";
}

std::string sectionPictures(const scenes::CheckResult& result) {
  if (result.sections.empty()) return "";
  std::size_t wanted = result.fits.size();
  for (const scenes::CheckedPair& pair : result.pairs) wanted += pair.state >= scenes::PairState::PressFit;
  std::string out = "<h2>Sections</h2>\n<p>Cut through the meshes at each overlap and each fit";
  if (wanted > result.sections.size())
    out += format(static_cast<double>(result.sections.size()), ": the first %.0f") +
           format(static_cast<double>(wanted), " of %.0f, the deepest and tightest");
  out +=
      ". The pictures show the facets of the meshes; the numbers of a fit describe the true cylinders.</p>\n";
  for (std::size_t i = 0; i < result.sections.size(); ++i)
    out += "<figure class=\"section\">" + sectionSvg(result, result.sections[i], i) + "<figcaption>" +
           captionOf(result, result.sections[i]) + "</figcaption></figure>\n";
  return out;
}

}  // namespace vps::viewer

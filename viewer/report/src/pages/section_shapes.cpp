// SPDX-License-Identifier: BSD-3-Clause
#include "pages/section_shapes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/html.h"

namespace vps::viewer::svg {

using html::format;

namespace {

/// Length of the scale bar: 1, 2 or 5 times a power of ten, at most a third of the window.
double barLength(double half_m) {
  const double most_m = 2 * half_m / 3, power = std::pow(10, std::floor(std::log10(most_m)));
  for (const double of : {5.0, 2.0})
    if (of * power <= most_m) return of * power;
  return power;
}

}  // namespace

std::string pathOf(const scenes::SectionOutline& outline, const Window& window) {
  std::string out;
  const double half_m = std::max(window.half_m, 0.5 * window.height / window.scale());
  for (const std::vector<Point>& chain : outline.chains) {
    Point last{-1e9, -1e9};
    bool is_first = true;
    // Outlines are clipped a little beyond the window, so that coordinates stay small.
    for (const Point& p : scenes::clippedToSquare(chain, window.middle_m, 1.1 * half_m)) {
      const Point at = window.toPixel(p);
      if (!is_first && std::hypot(at[0] - last[0], at[1] - last[1]) < 0.3) continue;
      out.append(is_first ? "M" : "L").append(format(at[0], "%.1f ")).append(format(at[1], "%.1f"));
      is_first = false;
      last = at;
    }
    if (!is_first) out += "Z";
  }
  return out;
}

std::string text(double x, double y, const std::string& words, const char* anchor) {
  return "<text x=\"" + format(x, "%.1f") + "\" y=\"" + format(y, "%.1f") + "\" text-anchor=\"" + anchor +
         "\">" + words + "</text>\n";
}

std::string scaleBar(const Window& window) {
  const double bar_m = barLength(window.half_m), x = window.left + 2, y = kTop + window.height + 12;
  return "<path d=\"M" + format(x, "%.1f") + " " + format(y - 4, "%.1f") + "v8m0 -4h" +
         format(bar_m * window.scale(), "%.1f") + "m0 -4v8\" stroke=\"#222\" fill=\"none\"/>\n" +
         text(x + bar_m * window.scale() + 6, y + 4, lengthText(bar_m));
}

std::string rectangle(double x, double y, double w, double h, const char* style) {
  return "<rect x=\"" + format(x, "%.1f") + "\" y=\"" + format(y, "%.1f") + "\" width=\"" +
         format(w, "%.1f") + "\" height=\"" + format(h, "%.1f") + "\" " + style + "/>\n";
}

std::string filled(const std::string& path, const std::string& fill, const std::string& more) {
  return "<path d=\"" + path + "\" fill=\"" + fill +
         "\" fill-rule=\"evenodd\" stroke=\"#333\" stroke-width=\"0.8\" " + more + "/>\n";
}

std::string key(double x, double y, const char* fill, const std::string& words) {
  return rectangle(x, y - 10, 12, 12, (std::string("fill=\"") + fill + "\" stroke=\"#333\"").c_str()) +
         text(x + 18, y, words);
}

}  // namespace vps::viewer::svg

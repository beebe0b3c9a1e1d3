// SPDX-License-Identifier: BSD-3-Clause
#include "draw/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "draw/marks.h"

namespace vps {
namespace {

std::uint8_t toSrgb(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float s = c < 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * s));
}

/// One entry after the other along the lower border.
class Legend {
 public:
  Legend(Image& image, const Lettering& lettering, double scale)
      : image_(image), lettering_(lettering), scale_(scale), x_(24 * scale), y_(image.height - 24 * scale) {}

  void swatch(const Eigen::Vector3f& color, double opacity, const std::string& text) {
    const double size = 13 * scale_;
    fill(
        x_, size, [&](double) { return color; }, opacity);
    x_ += size + 7 * scale_;
    label(text);
    x_ += 26 * scale_;
  }

  void depthScale(double full_scale_m) {
    label("contact depth 0");
    x_ += 7 * scale_;
    const double length = 90 * scale_;
    fill(
        x_, length, [](double share) { return depthColor(share); }, 1);
    x_ += length + 7 * scale_;
    char text[40];
    std::snprintf(text, sizeof text, "%.3g µm", full_scale_m * 1e6);
    label(text);
    x_ += 26 * scale_;
  }

 private:
  template <class ColorAt>
  void fill(double x, double length, ColorAt colorAt, double opacity) {
    const int x0 = static_cast<int>(std::lround(x)), x1 = static_cast<int>(std::lround(x + length));
    const int y1 = static_cast<int>(std::lround(y_ + scale_)),
              y0 = y1 - static_cast<int>(std::lround(12 * scale_));
    for (int py = std::max(0, y0); py < std::min(y1, image_.height); ++py)
      for (int px = std::max(0, x0); px < std::min(x1, image_.width); ++px) {
        const Eigen::Vector3f color = colorAt((px - x0 + 0.5) / (x1 - x0));
        for (int k = 0; k < 3; ++k) {
          std::uint8_t& channel = image_.at(px, py)[k];
          channel =
              static_cast<std::uint8_t>(std::lround(channel * (1 - opacity) + toSrgb(color[k]) * opacity));
        }
      }
  }
  void label(const std::string& text) { x_ += lettering_.write(image_, x_, y_, text, {15 * scale_}); }

  Image& image_;
  const Lettering& lettering_;
  double scale_, x_, y_;
};

}  // namespace

void drawOverlay(Image& image, const Snapshot& snapshot, const DrawOptions& options,
                 const LegendColors& colors, const Lettering& lettering) {
  if (!lettering.isReady()) return;
  const double scale = std::clamp(image.height / 960.0, 0.6, 3.0);
  const double left = 24 * scale;
  double y = 24 * scale;
  if (!options.title.empty()) {
    y += 16 * scale;
    lettering.write(image, left, y, options.title, {23 * scale, FontWeight::Bold, 35});
    y += 8 * scale;
  }
  std::istringstream lines(options.caption);
  for (std::string line; std::getline(lines, line);) {
    y += 19 * scale;
    lettering.write(image, left, y, line, {16 * scale, FontWeight::Regular, 70});
    y += 4 * scale;
  }
  if (!options.show_legend) return;

  Legend legend(image, lettering, scale);
  const bool has_hand_part = std::any_of(snapshot.bodies.begin(), snapshot.bodies.end(),
                                         [](const BodySnapshot& b) { return b.role == BodyRole::InHand; });
  if (has_hand_part && options.highlight_hand) legend.swatch(colors.hand, 1, "part in hand");
  if (snapshot.has_target && options.show_target) legend.swatch(colors.target, 0.4, "target");
  if (snapshot.has_hand && options.show_force) {
    char text[60];
    std::snprintf(text, sizeof text, "force on the hand %.1f N", snapshot.F_hand_W.f.norm());
    legend.swatch(kForceColor, 1, text);
  }
  if (!snapshot.contacts.empty() && options.show_contacts) legend.depthScale(options.contact_full_scale_m);
}

}  // namespace vps

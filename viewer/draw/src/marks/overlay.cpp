// SPDX-License-Identifier: BSD-3-Clause
#include "marks/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "marks/marks.h"
#include "vps_scenes/cad/srgb.h"

namespace vps::viewer {
namespace {

/// Blends rows y0 to y1 with white, so that text is readable on any background: `opacity` at the picture's
/// border, fading out over the last third.
void whiten(Image& image, double y0, double y1, double opacity) {
  const double middle_y = 0.5 * image.height, sign = y0 < middle_y ? 1 : -1;
  const double outer = sign > 0 ? y0 : y1, height = y1 - y0;
  for (int y = std::max(0, static_cast<int>(y0)); y < std::min(image.height, static_cast<int>(y1)); ++y) {
    const double inward = sign * (y - outer) / height;
    const double here = opacity * std::clamp(3 * (1 - inward), 0.0, 1.0);
    std::uint8_t* row = image.at(0, y);
    for (int i = 0; i < 3 * image.width; ++i)
      row[i] = static_cast<std::uint8_t>(std::lround(row[i] + (248 - row[i]) * here));
  }
}

/// Draws entries from left to right along the lower border.
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
          channel = static_cast<std::uint8_t>(
              std::lround(channel * (1 - opacity) + scenes::srgbByte(color[k]) * opacity));
        }
      }
  }
  void label(const std::string& text) { x_ += lettering_.write(image_, x_, y_, text, {15 * scale_}); }

  Image& image_;
  const Lettering& lettering_;
  double scale_, x_, y_;
};

}  // namespace

void drawOverlay(Image& image, const scenes::Snapshot& snapshot, const DrawOptions& options,
                 const LegendColors& colors, const Lettering& lettering) {
  if (!lettering.isReady()) return;
  const double scale = std::clamp(image.height / 960.0, 0.6, 3.0);
  const double left = 24 * scale;
  double y = 24 * scale;
  const auto line_count = std::count(options.caption.begin(), options.caption.end(), '\n') + 1;
  if (!options.title.empty() || !options.caption.empty())
    whiten(
        image, 0,
        ((options.title.empty() ? 24 : 48) + (options.caption.empty() ? 0 : 23.0 * line_count) + 30) * scale,
        0.6);
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

  const bool has_hand_part =
      std::any_of(snapshot.bodies.begin(), snapshot.bodies.end(),
                  [](const scenes::BodySnapshot& b) { return b.role == scenes::BodyRole::InHand; });
  const bool has_target = snapshot.has_target && options.show_target;
  const bool has_force = snapshot.has_hand && options.show_force;
  const bool has_contacts = !snapshot.contacts.empty() && options.show_contacts;
  if (!has_hand_part && !has_target && !has_force && !has_contacts) return;
  whiten(image, image.height - 66 * scale, image.height, 0.6);
  Legend legend(image, lettering, scale);
  if (has_hand_part && options.highlight_hand) legend.swatch(colors.hand, 1, "part in hand");
  if (has_target) legend.swatch(colors.target, 0.4, "target");
  if (has_force) {
    char text[60];
    std::snprintf(text, sizeof text, "force on the hand %.1f N", snapshot.F_hand_W.f.norm());
    legend.swatch(kForceColor, 1, text);
  }
  if (has_contacts) legend.depthScale(options.contact_full_scale_m);
}

}  // namespace vps::viewer

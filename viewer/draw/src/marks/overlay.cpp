// SPDX-License-Identifier: BSD-3-Clause
#include "marks/overlay.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>

#include "marks/marks.h"
#include "vps_scenes/cad/colors.h"

namespace vps::viewer {

// --- Text

namespace {

/// Calls visit for each code point. Bytes that are not UTF-8 become U+FFFD.
void forEachCodePoint(const std::string& utf8, const std::function<void(char32_t)>& visit) {
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = lead < 0x80         ? 1
                               : lead >> 5 == 0x6  ? 2
                               : lead >> 4 == 0xE  ? 3
                               : lead >> 3 == 0x1E ? 4
                                                   : 0;
    char32_t code = length == 0 ? 0xFFFD : length == 1 ? lead : lead & (0x7F >> length);
    bool is_good = length != 0 && i + length <= utf8.size();
    for (std::size_t k = 1; is_good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(utf8[i + k]);
      is_good = next >> 6 == 2;
      code = code << 6 | (next & 0x3F);
    }
    visit(is_good ? code : 0xFFFD);
    i += is_good ? length : 1;
  }
}

}  // namespace

struct Lettering::Impl {
  FT_Library library = nullptr;
  std::array<FT_Face, 2> faces = {nullptr, nullptr};

  ~Impl() {
    for (const FT_Face face : faces)
      if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }

  /// Lays out one line and calls draw with each rendered glyph and the pen's position. Returns the width.
  double walk(const std::string& utf8, const TextStyle& style, bool is_drawn,
              const std::function<void(const FT_GlyphSlot, double)>& draw) const {
    const FT_Face face = faces[style.weight == FontWeight::Bold ? 1 : 0];
    FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(64 * style.size_px)), 72, 72);
    double pen_px = 0;
    FT_UInt previous = 0;
    forEachCodePoint(utf8, [&](char32_t code) {
      const FT_UInt glyph = FT_Get_Char_Index(face, code);
      FT_Vector kerning = {0, 0};
      if (previous != 0 && FT_Get_Kerning(face, previous, glyph, FT_KERNING_UNFITTED, &kerning) == 0)
        pen_px += static_cast<double>(kerning.x) / 64;
      previous = glyph;
      // Light hinting aligns glyphs with pixel rows only, so that they are sharp and keep their width.
      if (FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_LIGHT | (is_drawn ? FT_LOAD_RENDER : 0)) != 0) return;
      if (is_drawn) draw(face->glyph, pen_px);
      pen_px += static_cast<double>(face->glyph->linearHoriAdvance) / 65536;
    });
    return pen_px;
  }
};

Lettering::Lettering() : impl_(std::make_unique<Impl>()) {
  // Folders of the font in Debian (fonts-dejavu-core), Fedora and Arch.
  static const std::array<const char*, 3> kFolders = {
      "/usr/share/fonts/truetype/dejavu/", "/usr/share/fonts/dejavu-sans-fonts/", "/usr/share/fonts/TTF/"};
  static const std::array<const char*, 2> kFiles = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"};
  if (FT_Init_FreeType(&impl_->library) != 0) return;
  for (std::size_t i = 0; i < kFiles.size(); ++i)
    for (const char* folder : kFolders)
      if (impl_->faces[i] == nullptr)
        FT_New_Face(impl_->library, (std::string(folder) + kFiles[i]).c_str(), 0, &impl_->faces[i]);
}

Lettering::~Lettering() = default;
Lettering::Lettering(Lettering&&) noexcept = default;
Lettering& Lettering::operator=(Lettering&&) noexcept = default;

bool Lettering::isReady() const {
  return impl_->faces[0] != nullptr && impl_->faces[1] != nullptr;
}

double Lettering::width(const std::string& utf8, const TextStyle& style) const {
  return isReady() ? impl_->walk(utf8, style, false, {}) : 0;
}

double Lettering::write(Image& image, double x, double y, const std::string& utf8,
                        const TextStyle& style) const {
  if (!isReady()) return 0;
  return impl_->walk(utf8, style, true, [&](const FT_GlyphSlot slot, double pen_px) {
    const FT_Bitmap& bitmap = slot->bitmap;
    const int left = static_cast<int>(std::lround(x + pen_px)) + slot->bitmap_left;
    const int top = static_cast<int>(std::lround(y)) - slot->bitmap_top;
    for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
      for (int column = 0; column < static_cast<int>(bitmap.width); ++column) {
        const int px = left + column, py = top + row;
        if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
        const int cover = bitmap.buffer[row * bitmap.pitch + column];
        for (int k = 0; k < 3; ++k) {
          std::uint8_t& channel = image.at(px, py)[k];
          channel = static_cast<std::uint8_t>((channel * (255 - cover) + style.level * cover + 127) / 255);
        }
      }
  });
}

// --- Title, caption and legend

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

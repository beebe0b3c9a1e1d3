// SPDX-License-Identifier: BSD-3-Clause
#include "marks/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <cmath>
#include <functional>

namespace vps::viewer {
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
  // The folders of Debian's fonts-dejavu-core and of Fedora's and Arch's packages.
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

}  // namespace vps::viewer

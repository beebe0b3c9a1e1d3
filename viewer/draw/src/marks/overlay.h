// SPDX-License-Identifier: BSD-3-Clause
// Text on images, by FreeType with the font DejaVu Sans; and the title, caption and legend of a finished
// picture.
#pragma once

#include <memory>
#include <string>

#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

enum class FontWeight { Regular, Bold };

struct TextStyle {
  double size_px = 18;
  FontWeight weight = FontWeight::Regular;
  std::uint8_t level = 40;  ///< grey, 0 black
};

class Lettering {
 public:
  Lettering();  ///< does not throw: without the font, write() does nothing and isReady() is false
  ~Lettering();
  Lettering(Lettering&&) noexcept;
  Lettering& operator=(Lettering&&) noexcept;
  [[nodiscard]] bool isReady() const;
  /// Width of one line of UTF-8 text [px].
  [[nodiscard]] double width(const std::string& utf8, const TextStyle& style) const;
  /// Draws one line whose baseline begins at (x, y). Returns the width of the line.
  double write(Image& image, double x, double y, const std::string& utf8, const TextStyle& style) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct LegendColors {
  Eigen::Vector3f hand, target;  ///< linear RGB
};

/// Draws title, caption and legend over the finished image, for the marks that the snapshot has.
void drawOverlay(Image& image, const scenes::Snapshot& snapshot, const DrawOptions& options,
                 const LegendColors& colors, const Lettering& lettering);

}  // namespace vps::viewer

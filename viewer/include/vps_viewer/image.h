// SPDX-License-Identifier: BSD-3-Clause
// Pictures in memory and on disk (PNG), and how far two of them differ.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// sRGB, 8 bits a channel, rows from the top; rgb.size() == 3 * width * height.
struct VPS_VIEWER_API Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int width, int height, std::uint8_t level = 0)
      : width(width), height(height), rgb(std::size_t(3) * width * height, level) {}
  /// The three channels of the pixel in column x from the left and row y from the top.
  [[nodiscard]] const std::uint8_t* at(int x, int y) const { return &rgb[3 * (std::size_t(y) * width + x)]; }
  [[nodiscard]] std::uint8_t* at(int x, int y) { return &rgb[3 * (std::size_t(y) * width + x)]; }
};

/// Writes a PNG: the same image gives the same bytes (no time stamp), and no reader ever sees half a file.
/// Throws std::runtime_error naming the file and the system's reason.
VPS_VIEWER_API void savePng(const Image& image, const std::string& file);

/// Reads any 8- or 16-bit PNG as RGB; transparency is laid on white. Throws LoadError if it is missing,
/// damaged or no PNG.
VPS_VIEWER_API Image loadPng(const std::string& file);

/// How far two images differ. A pixel's difference is the greatest of its channels', 0 to 255.
struct ImageDifference {
  bool is_same_size = true;  ///< if not, the rest says "entirely different"
  double share_beyond = 0;   ///< share of pixels that differ by more than the tolerance, 0 to 1
  int greatest = 0;
  double mean = 0;  ///< over all pixels
};

/// @param tolerance difference that still counts as equal, 0 to 255; 2 absorbs what SSE and AVX round
/// differently
VPS_VIEWER_API ImageDifference compare(const Image& a, const Image& b, int tolerance);

/// A picture of the difference: a in pale grey, pixels beyond the tolerance in red, the stronger the further
/// apart. Throws std::invalid_argument unless the sizes agree.
VPS_VIEWER_API Image differenceImage(const Image& a, const Image& b, int tolerance);

/// savePng(differenceImage(...)).
VPS_VIEWER_API void writeDifference(const Image& a, const Image& b, int tolerance, const std::string& file);

}  // namespace vps::viewer

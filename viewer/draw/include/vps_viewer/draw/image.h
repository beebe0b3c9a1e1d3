// SPDX-License-Identifier: BSD-3-Clause
// Images in memory and as PNG files, and the difference of two images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// sRGB, 8 bits per channel, rows from the top; rgb.size() == 3 * width * height.
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

/// The bytes of a PNG file of the image; the same image gives the same bytes. Throws std::runtime_error when
/// rgb has the wrong size.
VPS_VIEWER_API std::string pngBytes(const Image& image);

/// Writes a PNG file, whole or not at all. The same image gives the same bytes (no time stamp). The file's
/// folder must exist. Throws LoadError when the file cannot be written, std::runtime_error when rgb has the
/// wrong size.
VPS_VIEWER_API void savePng(const Image& image, const std::string& file);

/// Reads any 8- or 16-bit PNG as RGB; transparent pixels are blended with white. Throws LoadError if the file
/// is missing, damaged or not a PNG.
VPS_VIEWER_API Image loadPng(const std::string& file);

/// The difference of two images. A pixel's difference is the greatest of its channels' differences, 0 to 255.
struct ImageDifference {
  bool is_same_size = true;  ///< false: the sizes differ, and the other members have their greatest values
  double share_beyond = 0;   ///< share of pixels that differ by more than the tolerance, 0 to 1
  int greatest = 0;
  double mean = 0;  ///< mean difference over all pixels
};

/// @param tolerance difference that counts as equal, 0 to 255; 2 covers the different rounding of SSE and AVX
VPS_VIEWER_API ImageDifference compare(const Image& a, const Image& b, int tolerance);

/// A picture of the difference: image a in pale grey, pixels beyond the tolerance in a red that grows with
/// the difference. Throws std::invalid_argument unless the sizes agree.
VPS_VIEWER_API Image differenceImage(const Image& a, const Image& b, int tolerance);

/// Writes differenceImage() as a PNG file. Throws as differenceImage() and savePng().
VPS_VIEWER_API void writeDifference(const Image& a, const Image& b, int tolerance, const std::string& file);

}  // namespace vps::viewer

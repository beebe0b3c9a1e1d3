// SPDX-License-Identifier: BSD-3-Clause
// The difference of two images, as numbers and as a picture.
#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "vps_viewer/draw/image.h"

namespace vps::viewer {
namespace {

int pixelDifference(const std::uint8_t* a, const std::uint8_t* b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b, int tolerance) {
  if (a.width != b.width || a.height != b.height) return {false, 1, 255, 255};
  ImageDifference d;
  const std::size_t count = a.rgb.size() / 3;
  std::size_t beyond = 0;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const int difference = pixelDifference(&a.rgb[3 * i], &b.rgb[3 * i]);
    d.greatest = std::max(d.greatest, difference);
    sum += difference;
    if (difference > tolerance) ++beyond;
  }
  if (count > 0) {
    d.share_beyond = static_cast<double>(beyond) / static_cast<double>(count);
    d.mean = sum / static_cast<double>(count);
  }
  return d;
}

Image differenceImage(const Image& a, const Image& b, int tolerance) {
  if (a.width != b.width || a.height != b.height)
    throw std::invalid_argument("images of different sizes have no difference picture");
  Image out(a.width, a.height);
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const int difference = pixelDifference(&a.rgb[i], &b.rgb[i]);
    const int grey = 160 + (a.rgb[i] + a.rgb[i + 1] + a.rgb[i + 2]) / 9;  // the original, faint: 160 to 245
    if (difference <= tolerance) {
      std::fill_n(&out.rgb[i], 3, static_cast<std::uint8_t>(grey));
    } else {
      const int pale = std::max(0, 140 - difference);  // the red is stronger for larger differences
      out.rgb[i] = static_cast<std::uint8_t>(200 + difference / 5);
      out.rgb[i + 1] = out.rgb[i + 2] = static_cast<std::uint8_t>(pale);
    }
  }
  return out;
}

void writeDifference(const Image& a, const Image& b, int tolerance, const std::string& file) {
  savePng(differenceImage(a, b, tolerance), file);
}

}  // namespace vps::viewer

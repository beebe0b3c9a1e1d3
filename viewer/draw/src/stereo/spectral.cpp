// SPDX-License-Identifier: BSD-3-Clause
#include "stereo/spectral.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "vps/pose.h"
#include "vps_scenes/cad/srgb.h"

namespace vps::viewer {
namespace {

// sRGB's primaries in XYZ, by column: IEC 61966-2-1.
Mat3 srgbToXyz() {
  Mat3 M;
  M << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  return M;
}

// The bands' middles, by eye: red 629 and 615, green 532 and 518, blue 446 and 432 nm, as published for
// interference filters [Jorke and Fritz, "Infitec: a new stereoscopic visualisation tool", 2003]. Their
// colours: the CIE 1931 observer there, interpolated between the 5 nm of its table; rows red, green, blue.
Mat3 bands(bool is_left) {
  Mat3 rows;
  if (is_left)
    rows << 0.6642, 0.2762, 0, 0.1896, 0.8832, 0.0372, 0.3457, 0.0314, 1.7805;
  else
    rows << 0.9384, 0.4412, 0.0008, 0.0496, 0.6693, 0.0916, 0.3017, 0.0137, 1.4806;
  return rows.transpose();
}

/// From linear sRGB to the bands, with their strengths such that all of them together are sRGB's white.
Mat3 conversion(bool is_left) {
  const Mat3 primaries = bands(is_left);
  const Vec3 white = srgbToXyz() * Vec3::Ones();
  const Vec3 strengths = primaries.inverse() * white;
  return (primaries * strengths.asDiagonal()).inverse() * srgbToXyz();
}

}  // namespace

Image throughSpectralFilter(const Image& image, bool is_left) {
  const Mat3 M = conversion(is_left);
  std::array<double, 256> levels{};
  for (int i = 0; i < 256; ++i) levels[static_cast<std::size_t>(i)] = scenes::linearFromSrgb(i / 255.0);
  Image out = image;
  for (std::size_t i = 0; i + 2 < out.rgb.size(); i += 3) {
    const Vec3 rgb(levels[image.rgb[i]], levels[image.rgb[i + 1]], levels[image.rgb[i + 2]]);
    const Vec3 mixed = M * rgb;
    for (int k = 0; k < 3; ++k) out.rgb[i + static_cast<std::size_t>(k)] = scenes::srgbByte(mixed[k]);
  }
  return out;
}

}  // namespace vps::viewer

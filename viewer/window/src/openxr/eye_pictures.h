// SPDX-License-Identifier: BSD-3-Clause
// The pictures of one eye that a headset takes (a swapchain of OpenXR).
#pragma once

#include <cstdint>
#include <vector>

#include "openxr/xr_calls.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {

class EyePictures {
 public:
  /// With the context of the session current. Throws std::runtime_error.
  EyePictures(XrSession session, int width, int height);
  ~EyePictures();
  EyePictures(const EyePictures&) = delete;
  EyePictures& operator=(const EyePictures&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Hands over a picture of at most that size; returns where it is, for the frame's layer.
  XrSwapchainSubImage put(const Image& image);

 private:
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<std::uint32_t> textures_;
  int width_, height_;
  std::vector<std::uint8_t> flipped_;
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// What a headset takes pictures from: an OpenGL context on the X display, and a swapchain for each eye.
#pragma once

#include <cstdint>
#include <vector>

#include "openxr/xr_instance.h"
#include "vps_viewer/draw/image.h"

namespace vps::viewer {

/// The pictures of one eye (a swapchain of OpenXR).
class EyePictures {
 public:
  /// The OpenGL context of the session must be current. Throws std::runtime_error.
  EyePictures(XrSession session, int width, int height);
  ~EyePictures();
  EyePictures(const EyePictures&) = delete;
  EyePictures& operator=(const EyePictures&) = delete;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Copies a picture, at most as large as the swapchain, to the swapchain. Returns the picture's place, for
  /// the frame's layer.
  XrSwapchainSubImage put(const Image& image);

 private:
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<std::uint32_t> textures_;
  int width_, height_;
  std::vector<std::uint8_t> flipped_;
};

/// An OpenGL context on the X display without a window, from which a runtime of OpenXR takes pictures.
class GlxContext {
 public:
  /// Throws std::runtime_error if there is no X display, or no GLX with OpenGL 3.3.
  GlxContext();
  ~GlxContext();
  GlxContext(const GlxContext&) = delete;
  GlxContext& operator=(const GlxContext&) = delete;

  /// Makes the context current on this thread. While a Renderer draws on a thread, no GLX context may be
  /// current on that thread.
  void makeCurrent() const;
  void release() const;
  [[nodiscard]] XrGraphicsBindingOpenGLXlibKHR binding() const;

 private:
  Display* display_ = nullptr;
  GLXFBConfig config_ = nullptr;
  GLXContext context_ = nullptr;
  GLXPbuffer surface_ = 0;
  unsigned visual_ = 0;
};

}  // namespace vps::viewer

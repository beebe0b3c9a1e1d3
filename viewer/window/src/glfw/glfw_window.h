// SPDX-License-Identifier: BSD-3-Clause
// A window with OpenGL and Dear ImGui, with the renderer's picture as its background.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <string>

#include "view/camera_motion.h"
#include "vps_viewer/draw/image.h"

struct GLFWwindow;

namespace vps::viewer {

/// Throws as GlfwWindow does if there is no display. Must not be called while a GlfwWindow exists.
void requireDisplay();

/// All functions except wake() are called on the thread that made the window. Only one window may exist at a
/// time.
class GlfwWindow {
 public:
  /// Throws std::runtime_error if there is no display or it has no OpenGL 3.3.
  /// @param wants_stereo  asks the driver for a buffer for each eye; hasStereo() tells whether the driver has
  /// such buffers
  GlfwWindow(const std::string& title, PictureSize size, bool wants_stereo = false);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Called with each typed character, and with the names of other keys: "Left", "Escape".
  std::function<void(const std::string& key)> on_key;

  /// Waits for events. Returns whether there is something new to draw.
  bool wait(double longest_s);
  /// Ends wait(). May be called by any thread.
  void wake();
  [[nodiscard]] bool isClosed() const;
  /// Fills a monitor, counted from 0, or restores the window's place and size. Returns false if there is no
  /// such monitor.
  bool setFullScreen(bool is_full, int monitor);
  [[nodiscard]] bool isFullScreen() const { return is_full_screen_; }
  /// Size of the window's content in pixels; 0 while the window is minimised.
  [[nodiscard]] PictureSize size() const;
  /// Row of the monitor that shows the window's uppermost row; 0 if the display does not tell it (Wayland).
  [[nodiscard]] int screenRow() const;
  /// Greatest width and height of setPicture()'s image.
  [[nodiscard]] int greatestPicture() const { return greatest_picture_; }
  /// Scale of texts and distances: 1 on a common screen, 2 on a screen with twice the pixels per length.
  [[nodiscard]] float scale() const { return scale_; }

  void beginFrame(bool is_dark);
  void endFrame();
  /// Shows what endFrame() drew.
  void present();
  /// Uploads the picture to the texture that picture() returns.
  void setPicture(const Image& image);
  /// Whether the window has a buffer for each eye. With such buffers, the left half of setPicture()'s image
  /// is the left eye's picture.
  [[nodiscard]] bool hasStereo() const { return has_stereo_; }
  /// The picture's texture, for ImGui's AddImage().
  [[nodiscard]] void* picture() const;
  [[nodiscard]] bool hasPicture() const { return has_picture_; }
  /// The window's content with its panels. Call it between endFrame() and present().
  [[nodiscard]] Image readBack() const;

 private:
  void openImGui();
  void drawPanels() const;
  static void onAny(GLFWwindow* window);

  GLFWwindow* window_ = nullptr;
  unsigned texture_ = 0, right_texture_ = 0;
  PictureSize texture_size_{0, 0};
  float scale_ = 1;
  int greatest_picture_ = 0;
  bool has_picture_ = false, is_full_screen_ = false, has_stereo_ = false;
  std::array<int, 4> windowed_{};  ///< place and size before the window filled a monitor
  int frames_due_ = 3;
  std::atomic<bool> has_news_{false};
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// A window with OpenGL and Dear ImGui, and the picture that it shows.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <string>

#include "view/camera_motion.h"
#include "vps_viewer/draw/image.h"

struct GLFWwindow;

namespace vps::viewer {

/// Throws as GlfwWindow does where there is no display. Not while there is a window.
void requireDisplay();

/// Used on the thread that made it, except wake(). One at a time.
class GlfwWindow {
 public:
  /// Throws std::runtime_error, which says what is missing: a display, or OpenGL 3.3.
  /// @param wants_stereo  with a buffer for each eye, where the driver has that; see hasStereo()
  GlfwWindow(const std::string& title, PictureSize size, bool wants_stereo = false);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  /// Called with each typed character, and with the names of other keys: "Left", "Escape".
  std::function<void(const std::string& key)> on_key;

  /// Waits for events. Returns whether there is something new to draw.
  bool wait(double longest_s);
  /// Ends wait(), from any thread.
  void wake();
  [[nodiscard]] bool isClosed() const;
  /// Fills that monitor, counted from 0, or goes back to where the window was. False where there is none.
  bool setFullScreen(bool is_full, int monitor);
  [[nodiscard]] bool isFullScreen() const { return is_full_screen_; }
  /// In pixels; 0 while it is minimised.
  [[nodiscard]] PictureSize size() const;
  /// Row of the monitor that shows the window's uppermost row; 0 where the display does not say it (Wayland).
  [[nodiscard]] int screenRow() const;
  /// Greatest width and height of setPicture()'s image.
  [[nodiscard]] int greatestPicture() const { return greatest_picture_; }
  /// Of texts and distances: 1 on a common screen, 2 on one with twice the pixels for the same length.
  [[nodiscard]] float scale() const { return scale_; }

  void beginFrame(bool is_dark);
  void endFrame();
  /// Shows what endFrame() drew.
  void present();
  /// The picture that picture() stands for, as ImGui's images want it.
  void setPicture(const Image& image);
  /// Whether it has a buffer for each eye. Then setPicture()'s left half is the left eye's picture.
  [[nodiscard]] bool hasStereo() const { return has_stereo_; }
  [[nodiscard]] void* picture() const;
  [[nodiscard]] bool hasPicture() const { return has_picture_; }
  /// Between endFrame() and present(): what endFrame() drew, panels included.
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
  std::array<int, 4> windowed_{};  ///< place and size before it filled a monitor
  int frames_due_ = 3;
  std::atomic<bool> has_news_{false};
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// A test fixture that opens the window of `vps view` on a display in memory (Xvfb), with keys from xdotool.
#pragma once

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "program.h"
#include "view/camera_motion.h"
#include "view/timeline.h"
#include "vps_scenes/scene/display.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/draw/stereo.h"
#include "vps_viewer/window/window.h"

namespace vps {

using namespace std::chrono_literals;
using viewer::Image;

inline std::string outputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

inline bool has(const char* program) {
  return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

class Window : public Program {
 protected:
  // The part of a window of 1280 x 720 that the panels do not cover.
  static constexpr viewer::PictureSize kPicture = {950, 656};

  void SetUp() override {
    Program::SetUp();
    if (!viewer::missingForWindow().empty()) GTEST_SKIP() << viewer::missingForWindow();
    if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "needs Xvfb and xdotool (Debian: xvfb, xdotool)";
    const std::string number = (folder_ / "display.txt").string();
    // Without -noreset the server restarts when its last client leaves, for example xdotool, and refuses a
    // window that opens at this moment. The display number is unique to this process: if two servers share a
    // number, the first to end removes the socket of the other.
    xvfb_ = std::stoi(outputOf("Xvfb :" + std::to_string(1000 + getpid() % 30000) +
                               " -noreset -displayfd 3 -screen 0 1400x900x24 3>'" + number +
                               "' >/dev/null 2>&1 & echo $!"));
    ASSERT_TRUE(soon([&] { return slurp(number).find('\n') != std::string::npos; }));
    const std::string text = slurp(number);
    display_number_ = text.substr(0, text.find('\n'));
    display_ = "DISPLAY=:" + display_number_ + " ";
  }
  void TearDown() override {
    if (view_ > 0) kill(view_, SIGKILL);
    if (xvfb_ > 0) kill(xvfb_, SIGTERM);
    for (int i = 0; i < 50 && fs::exists("/tmp/.X11-unix/X" + display_number_); ++i)
      std::this_thread::sleep_for(100ms);
    Program::TearDown();
  }

  /// Waits for at most a minute until the condition holds.
  template <class Condition>
  static bool soon(Condition is_true) {
    for (int i = 0; i < 600; ++i) {
      if (is_true()) return true;
      std::this_thread::sleep_for(100ms);
    }
    return false;
  }

  void open(const std::string& arguments) {
    view_ = std::stoi(outputOf("cd '" + folder_.string() + "'; (" + display_ +
                               " exec '" VPS_PROGRAM "' view " + arguments +
                               " >out.txt 2>err.txt & echo $! >pid.txt; wait $!; echo $? >status.txt) "
                               "</dev/null >/dev/null 2>&1 & sleep 0.3; cat pid.txt"));
    ASSERT_TRUE(soon([&] {
      window_ = outputOf(display_ + "xdotool search --name 'vps view' 2>/dev/null");
      return !window_.empty() || fs::exists(folder_ / "status.txt");
    }));
    ASSERT_FALSE(window_.empty()) << slurp(folder_ / "err.txt");
    // A window has its name before it is on the screen. Before the window is on the screen it gets no keys;
    // the window's first frame sets the camera.
    ASSERT_TRUE(soon([&] {
      xdotool("windowfocus " + window_);
      return outputOf(display_ + "xdotool getwindowfocus 2>/dev/null") == window_;
    })) << slurp(folder_ / "err.txt");
    ASSERT_GT(picture().width, 0) << slurp(folder_ / "err.txt");
  }
  void xdotool(const std::string& arguments) const {
    std::system((display_ + "xdotool " + arguments + " >/dev/null 2>&1").c_str());
  }
  /// The content of the window, which the window saves on a key.
  Image picture() {
    const fs::path file = folder_ / ("view_" + std::to_string(++pictures_) + ".png");
    for (int i = 0; i < 20 && !fs::exists(file); ++i) {
      xdotool("key p");
      for (int k = 0; k < 50 && !fs::exists(file); ++k) std::this_thread::sleep_for(100ms);
    }
    // If a key was sent twice, the window saves two pictures.
    while (fs::exists(folder_ / ("view_" + std::to_string(pictures_ + 1) + ".png"))) ++pictures_;
    return fs::exists(file) ? viewer::loadPng(file.string()) : Image();
  }
  /// Whether the window shows this picture, or does so soon.
  bool shows(const Image& wanted) {
    return soon([&] {
      const Image now = picture();
      if (now.width < wanted.width || now.height < wanted.height) return false;
      Image crop(wanted.width, wanted.height);
      for (int y = 0; y < crop.height; ++y)
        std::copy_n(now.at(0, y), 3 * static_cast<std::size_t>(crop.width), crop.at(0, y));
      return viewer::compare(crop, wanted, 2).share_beyond ==
             0;  // tolerance 2, as for other pictures (image.h)
    });
  }
  /// Returns when the window has handled all keys so far and has drawn a frame with their effect.
  void settle() { ASSERT_GT(picture().width, 0) << slurp(folder_ / "err.txt"); }
  /// Closes the window by a key and returns the exit status.
  int close(const std::string& key = "q") {
    xdotool("key " + key);
    if (!soon([&] { return !slurp(folder_ / "status.txt").empty(); })) return -1;
    view_ = 0;
    return std::stoi(slurp(folder_ / "status.txt"));
  }
  /// The expected picture of the finished assembly from a standard view, or on a screen of a display file.
  Image expected(std::size_t view, viewer::StereoMode mode = viewer::StereoMode::Mono,
                 const std::string& display_file = "", int screen_row = 0) const {
    const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
    const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
    const scenes::Snapshot snapshot = viewer::sceneTour(scene).at(0);
    viewer::DrawOptions options;
    options.width = kPicture.width;
    options.height = kPicture.height;
    options.supersampling = 1;
    options.show_legend = false;
    viewer::Renderer renderer(drawn);
    const viewer::Camera camera =
        viewer::cameraFor(viewer::standardViews()[view], viewer::snapshotBounds(drawn, snapshot), kPicture);
    if (!display_file.empty()) {
      const scenes::Display display = scenes::loadDisplay((folder_ / display_file).string());
      const auto eye = [&](int side) {
        return viewer::cameraFor(display, display.screens[0], display.viewers[0].eye_S(side));
      };
      options.show_ground = false;
      return viewer::renderStereo(renderer, snapshot, {eye(-1), eye(1)}, options, mode)[0];
    }
    if (mode == viewer::StereoMode::Mono) return renderer.render(snapshot, camera, options);
    const double distance_m = (camera.eye_W - camera.target_W).norm();
    const viewer::EyePair eyes =
        viewer::eyesOf(camera, viewer::kEyeShare * distance_m, double(kPicture.width) / kPicture.height);
    return viewer::renderStereo(renderer, snapshot, eyes, options, mode, {0, 0, screen_row})[0];
  }
  /// The part of the window that shows the scene.
  Image scenePicture() {
    const Image whole = picture();
    Image crop(kPicture.width, kPicture.height);
    if (whole.width < crop.width || whole.height < crop.height) return crop;
    for (int y = 0; y < crop.height; ++y)
      std::copy_n(whole.at(0, y), 3 * static_cast<std::size_t>(crop.width), crop.at(0, y));
    return crop;
  }
  /// The scene's picture (scenePicture()) once it is drawn in full and no longer changes.
  Image restingPicture() {
    Image last = scenePicture();
    int same = 0;  // drawing a picture in full may take longer than the interval between two comparisons
    soon([&] {
      std::this_thread::sleep_for(1s);
      Image now = scenePicture();
      same = now.rgb == last.rgb ? same + 1 : 0;
      last = std::move(now);
      return same >= 4;
    });
    return last;
  }

  std::string display_, window_, display_number_;
  pid_t xvfb_ = 0, view_ = 0;
  int pictures_ = 0;
};

}  // namespace vps

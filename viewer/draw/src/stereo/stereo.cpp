// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/stereo.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "vps/errors.h"
#include "vps/pose.h"
#include "vps_scenes/cad/colors.h"

namespace vps::viewer {
namespace {

// sRGB's primaries in XYZ, by column: IEC 61966-2-1.
Mat3 srgbToXyz() {
  Mat3 M;
  M << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
  return M;
}

// The middles of the bands for the left and right eye: red 629 and 615, green 532 and 518, blue 446 and 432
// nm, as published for interference filters [Jorke and Fritz, "Infitec: a new stereoscopic visualisation
// tool", 2003]. Each row has the values of the CIE 1931 observer at one band (red, green, blue), interpolated
// between the table's steps of 5 nm.
Mat3 bands(bool is_left) {
  Mat3 rows;
  if (is_left)
    rows << 0.6642, 0.2762, 0, 0.1896, 0.8832, 0.0372, 0.3457, 0.0314, 1.7805;
  else
    rows << 0.9384, 0.4412, 0.0008, 0.0496, 0.6693, 0.0916, 0.3017, 0.0137, 1.4806;
  return rows.transpose();
}

/// The matrix from linear sRGB to the bands. The strengths of the bands are chosen so that all bands together
/// give sRGB's white.
Mat3 conversion(bool is_left) {
  const Mat3 primaries = bands(is_left);
  const Vec3 white = srgbToXyz() * Vec3::Ones();
  const Vec3 strengths = primaries.inverse() * white;
  return (primaries * strengths.asDiagonal()).inverse() * srgbToXyz();
}

/// Converts a picture to the primaries of one eye's filter, so that a viewer with the glasses sees its
/// colours. Colours that the primaries cannot mix are clamped; white stays white.
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

/// The camera of an eye in front of a rectangle; all arguments are in one frame.
/// @param R  columns: to the right, up, and towards the eye
Camera behindRectangle(const Vec3& eye, const Vec3& lower_left, double width_m, double height_m,
                       const Mat3& R) {
  const Vec3 from = R.transpose() * (lower_left - eye);  // from the eye to the corner
  const double distance_m = -from.z();
  Camera camera;
  camera.eye_W = eye;
  camera.target_W = eye - distance_m * R.col(2);
  camera.up_W = R.col(1);
  camera.fov_rad = 2 * std::atan(0.5 * height_m / distance_m);
  camera.shift_x = (from.x() + 0.5 * width_m) / distance_m;
  camera.shift_y = (from.y() + 0.5 * height_m) / distance_m;
  camera.aspect = width_m / height_m;
  return camera;
}

/// Stretches both pictures by repeating rows and columns. Interpolated rows would show each eye the other
/// eye's picture.
Image interleaved(const Image& left, const Image& right, const ScreenRows& rows) {
  Image both(rows.width > 0 ? rows.width : left.width, rows.height > 0 ? rows.height : left.height);
  for (int y = 0; y < both.height; ++y) {
    const Image& eye = (rows.first + y) % 2 == 0 ? left : right;
    const int from_y = static_cast<int>(std::int64_t(y) * eye.height / both.height);
    for (int x = 0; x < both.width; ++x)
      std::copy_n(eye.at(static_cast<int>(std::int64_t(x) * eye.width / both.width), from_y), 3,
                  both.at(x, y));
  }
  return both;
}

/// Red is the left eye's brightness, so that both eyes see parts of every colour.
Image anaglyph(const Image& left, const Image& right) {
  Image both = right;
  for (std::size_t i = 0; i + 2 < both.rgb.size(); i += 3)  // luma: Rec. ITU-R BT.601
    both.rgb[i] = static_cast<std::uint8_t>(
        std::lround(0.299 * left.rgb[i] + 0.587 * left.rgb[i + 1] + 0.114 * left.rgb[i + 2]));
  return both;
}

}  // namespace

const char* toText(StereoMode mode) {
  switch (mode) {
    case StereoMode::Mono:
      return "mono";
    case StereoMode::SideBySide:
      return "side_by_side";
    case StereoMode::TopBottom:
      return "top_bottom";
    case StereoMode::Interleaved:
      return "interleaved";
    case StereoMode::Anaglyph:
      return "anaglyph";
    case StereoMode::Spectral:
      return "spectral";
  }
  return "unknown";
}

const std::vector<StereoMode>& stereoModes() {
  static const std::vector<StereoMode> modes = {StereoMode::Mono,      StereoMode::SideBySide,
                                                StereoMode::TopBottom, StereoMode::Interleaved,
                                                StereoMode::Anaglyph,  StereoMode::Spectral};
  return modes;
}

StereoMode stereoModeOf(const std::string& name) {
  for (const StereoMode mode : stereoModes())
    if (name == toText(mode)) return mode;
  return StereoMode::Mono;
}

EyePair eyesOf(const Camera& camera, double eye_distance_m, double picture_aspect) {
  const Mat3 R = camera.pose().R;
  const double height_m = 2 * std::tan(0.5 * camera.fov_rad) * (camera.eye_W - camera.target_W).norm();
  const double width_m = picture_aspect * height_m;
  const Vec3 lower_left_W = camera.target_W - 0.5 * (width_m * R.col(0) + height_m * R.col(1));
  const Vec3 aside_W = 0.5 * eye_distance_m * R.col(0);
  return {behindRectangle(camera.eye_W - aside_W, lower_left_W, width_m, height_m, R),
          behindRectangle(camera.eye_W + aside_W, lower_left_W, width_m, height_m, R)};
}

Camera cameraFor(const scenes::Display& display, const scenes::DisplayScreen& screen, const Vec3& eye_S) {
  const Mat3 R_S = screen.axes();
  if (R_S.col(2).dot(eye_S - screen.lower_left_S) <= 0)
    throw LoadError(display.file, screen.name,
                    "has the eye of a viewer behind its plane; move the head or the screen");
  const Mat3 R_WS = display.X_SW.R.transpose();
  return behindRectangle(display.toScene(eye_S), display.toScene(screen.lower_left_S),
                         (screen.lower_right_S - screen.lower_left_S).norm() / display.scale,
                         (screen.upper_left_S - screen.lower_left_S).norm() / display.scale, R_WS * R_S);
}

EyePair eyesOf(const scenes::Display& display, const scenes::DisplayScreen& screen,
               const scenes::DisplayViewer& viewer) {
  return {cameraFor(display, screen, viewer.eye_S(-1)), cameraFor(display, screen, viewer.eye_S(1))};
}

Camera middleEye(const EyePair& eyes) {
  Camera middle = eyes.left;  // both frusta end at one screen, so the middle frustum is their mean
  middle.eye_W = 0.5 * (eyes.left.eye_W + eyes.right.eye_W);
  middle.target_W = 0.5 * (eyes.left.target_W + eyes.right.target_W);
  middle.shift_x = 0.5 * (eyes.left.shift_x + eyes.right.shift_x);
  middle.shift_y = 0.5 * (eyes.left.shift_y + eyes.right.shift_y);
  return middle;
}

std::vector<Image> renderStereo(Renderer& renderer, const scenes::Snapshot& snapshot, const EyePair& eyes,
                                const DrawOptions& options, StereoMode mode, const ScreenRows& rows) {
  DrawOptions half = options;
  half.width = pictureLength_px(options.width);
  half.height = pictureLength_px(options.height);
  const int width = half.width, height = half.height;
  half.show_legend = false;
  half.title.clear();
  half.caption.clear();
  if (mode == StereoMode::SideBySide) half.width = width / 2;
  if (mode == StereoMode::TopBottom) half.height = height / 2;
  if (mode == StereoMode::Mono) return {renderer.render(snapshot, middleEye(eyes), half)};
  const Image left = renderer.render(snapshot, eyes.left, half);
  const Image right = renderer.render(snapshot, eyes.right, half);
  switch (mode) {
    case StereoMode::Mono:
      break;
    case StereoMode::SideBySide:
    case StereoMode::TopBottom: {
      const bool is_across = mode == StereoMode::SideBySide;
      Image both(width, height);
      paste(left, 0, 0, both);
      paste(right, is_across ? left.width : 0, is_across ? 0 : left.height, both);
      return {both};
    }
    case StereoMode::Interleaved:
      return {interleaved(left, right, rows)};
    case StereoMode::Anaglyph:
      return {anaglyph(left, right)};
    case StereoMode::Spectral:
      return {throughSpectralFilter(left, true), throughSpectralFilter(right, false)};
  }
  return {};
}

void paste(const Image& part, int x, int y, Image& whole) {
  const int width = std::min(part.width, whole.width - x), height = std::min(part.height, whole.height - y);
  if (width <= 0) return;
  for (int row = 0; row < height; ++row)
    std::copy_n(part.at(0, row), 3 * static_cast<std::size_t>(width), whole.at(x, y + row));
}

Image renderSpectralEye(Renderer& renderer, const scenes::Snapshot& snapshot, const EyePair& eyes,
                        const DrawOptions& options, bool is_left) {
  DrawOptions plain = options;
  plain.show_legend = false;
  plain.title.clear();
  plain.caption.clear();
  return throughSpectralFilter(renderer.render(snapshot, is_left ? eyes.left : eyes.right, plain), is_left);
}

std::vector<ScreenPicture> renderDisplay(Renderer& renderer, const scenes::Snapshot& snapshot,
                                         const scenes::Display& display, const DrawOptions& options,
                                         StereoMode mode) {
  std::vector<ScreenPicture> pictures;
  for (const scenes::DisplayScreen& screen : display.screens)
    for (const scenes::DisplayViewer& viewer : display.viewers) {
      DrawOptions sized = options;
      sized.width = screen.width;
      sized.height = screen.height;
      sized.show_ground = false;  // the room has a floor of its own
      const EyePair eyes = eyesOf(display, screen, viewer);
      const std::string name = display.viewers.size() > 1 ? screen.name + "_" + viewer.name : screen.name;
      std::vector<Image> images = renderStereo(renderer, snapshot, eyes, sized, mode);
      for (std::size_t i = 0; i < images.size(); ++i) {
        std::string whole = name;
        if (images.size() > 1) whole.append(i == 0 ? "_left" : "_right");
        pictures.push_back({std::move(whole), std::move(images[i])});
      }
    }
  return pictures;
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Parallax of a known point in every stereo mode and on displays, against the line from the eye through it.
#include "vps_viewer/draw/stereo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vps/errors.h"

namespace vps::viewer {
namespace {

// Tolerance. An edge that is averaged over 3 x 3 samples is found to 0.02 px.
constexpr double kParallax_px = 0.1;

Mesh ball(double radius_m) {
  return makeSphere(radius_m, 6);
}

DrawOptions plain(int width, int height) {
  DrawOptions options;
  options.width = width;
  options.height = height;
  options.show_edges = options.show_ground = options.show_legend = false;
  options.supersampling = 3;
  return options;
}

/// Centre and area of the pixels that differ between two pictures, in one channel and every n-th row from the
/// first.
struct Blob {
  double x = 0, y = 0, area_px = 0;
};
Blob blobOf(const Image& with, const Image& without, int channel, int first_row = 0, int every = 1) {
  std::vector<int> change;
  int most = 0;
  for (std::size_t i = 0; i < with.rgb.size(); i += 3) {
    change.push_back(std::abs(int(with.rgb[i + channel]) - int(without.rgb[i + channel])));
    most = std::max(most, change.back());
  }
  Blob blob;
  for (int y = first_row; y < with.height; y += every)
    for (int x = 0; x < with.width; ++x) {
      // An edge covers a share of its pixel. All shades of the dark ball itself count as fully covered.
      const double share = std::min(1.0, change[static_cast<std::size_t>(y) * with.width + x] / (0.6 * most));
      blob.area_px += share;
      blob.x += share * (x + 0.5);
      blob.y += share * (y + 0.5);
    }
  blob.x /= blob.area_px;
  blob.y /= blob.area_px;
  return blob;
}

Image cropped(const Image& image, int x, int y, int width, int height) {
  Image out(width, height);
  for (int row = 0; row < height; ++row) std::copy_n(image.at(x, y + row), 3 * width, out.at(0, row));
  return out;
}

/// Both eyes' blobs in pixels of the whole screen, whatever the mode.
std::array<Blob, 2> eyesIn(const std::vector<Image>& with, const std::vector<Image>& without,
                           StereoMode mode) {
  const Image &a = with[0], &b = without[0];
  const int w = a.width, h = a.height;
  const auto part = [&](int x, int y, int pw, int ph, double sx, double sy) {
    Blob blob = blobOf(cropped(a, x, y, pw, ph), cropped(b, x, y, pw, ph), 1);
    blob.x *= sx;
    blob.y *= sy;
    return blob;
  };
  switch (mode) {
    case StereoMode::Mono:
      return {blobOf(a, b, 1), blobOf(a, b, 1)};
    case StereoMode::SideBySide:
      return {part(0, 0, w / 2, h, 2, 1), part(w / 2, 0, w / 2, h, 2, 1)};
    case StereoMode::TopBottom:
      return {part(0, 0, w, h / 2, 1, 2), part(0, h / 2, w, h / 2, 1, 2)};
    case StereoMode::Interleaved:
      return {blobOf(a, b, 1, 0, 2), blobOf(a, b, 1, 1, 2)};
    case StereoMode::Anaglyph:
      return {blobOf(a, b, 0), blobOf(a, b, 2)};
    case StereoMode::Spectral:
      return {blobOf(a, b, 1), blobOf(with[1], without[1], 1)};
  }
  return {};
}

class OneBall : public testing::Test {
 protected:
  static constexpr double kRadius_m = 5e-3;
  Mesh ball_ = ball(kRadius_m);
  RenderScene scene_ = {{&ball_, {0.02f, 0.02f, 0.02f}}};
  Renderer renderer_{scene_};

  static scenes::Snapshot at(const Vec3& p_W) {
    scenes::Snapshot shot;
    shot.bodies = {{0, Pose::translation(p_W), scenes::BodyRole::Mounted}};
    return shot;
  }
};

class Stereo : public OneBall, public testing::WithParamInterface<StereoMode> {};

TEST_P(Stereo, AKnownPointHasItsParallaxToATenthOfAPixel) {
  // The camera looks along -z from 0.5 m; the screen is the plane z = 0, 2 x 0.5 tan(0.25) high.
  Camera camera;
  camera.eye_W = Vec3(0, 0, 0.5);
  camera.target_W = Vec3::Zero();
  camera.up_W = Vec3::UnitY();
  const double eyes_m = 0.05, height_m = 2 * 0.5 * std::tan(0.25);
  const DrawOptions options = plain(960, 720);
  const EyePair eyes = eyesOf(camera, eyes_m, 960.0 / 720);
  for (const Vec3& p_W : {Vec3(0.02, 0.015, 0), Vec3(-0.03, 0.02, 0.12), Vec3(0.04, -0.03, -0.2)}) {
    const auto with = renderStereo(renderer_, at(p_W), eyes, options, GetParam());
    const auto without = renderStereo(renderer_, {}, eyes, options, GetParam());
    const auto blobs = eyesIn(with, without, GetParam());
    double x_px[2];
    for (int side = 0; side < 2; ++side) {
      const double eye = GetParam() == StereoMode::Mono ? 0 : (side == 0 ? -0.5 : 0.5) * eyes_m;
      const double t = 0.5 / (0.5 - p_W.z());  // where the line from the eye meets the screen
      x_px[side] = 480 + 720 / height_m * (eye + t * (p_W.x() - eye));
      const double y_px = 360 - 720 / height_m * t * p_W.y();
      EXPECT_NEAR(blobs[side].x, x_px[side], kParallax_px) << side << " at " << p_W.transpose();
      // An eye sees every second row, so the vertical position of a round blob is as exact as the spacing of
      // its rows.
      EXPECT_NEAR(blobs[side].y, y_px, GetParam() == StereoMode::Interleaved ? 1 : 2 * kParallax_px);
    }
    EXPECT_NEAR(blobs[1].x - blobs[0].x, x_px[1] - x_px[0], kParallax_px);
    if (GetParam() != StereoMode::Mono) {
      EXPECT_EQ(blobs[1].x - blobs[0].x > 0.5, p_W.z() < 0) << "behind the screen: to the right";
    }
  }
}

TEST_P(Stereo, AScreenInTheRoomShowsAPointWhereTheLineFromTheEyeMeetsIt) {
  scenes::Display room;
  room.scale = 4;  // the ball is as large as a tennis ball; the outline of a larger ball would not be centred
                   // on its middle
  room.X_SW = Pose(rotationFromVector(Vec3(0.2, -0.1, 0.4)), Vec3(0.3, 1.5, 1.4));
  scenes::DisplayScreen wall;  // 2.4 m x 1.5 m, slanted
  const Mat3 R =
      rotationFromVector(Vec3(std::numbers::pi / 2 - 0.1, 0, 0)) * rotationFromVector(Vec3(0, 0.3, 0));
  wall.lower_left_S = Vec3(-1.2, 2, 0.5);
  wall.lower_right_S = wall.lower_left_S + 2.4 * R.col(0);
  wall.upper_left_S = wall.lower_left_S + 1.5 * R.col(1);
  wall.width = 960;
  wall.height = 600;
  scenes::DisplayViewer head;
  head.X_SE = Pose(R, wall.lower_left_S + R * Vec3(0.9, 0.8, 1.7));
  room.screens = {wall};
  room.viewers = {head};
  const Vec3 p_S = wall.lower_left_S + R * Vec3(1.1, 0.6, 0.3);
  const DrawOptions options = plain(960, 600);
  const auto imagesOf = [&](const scenes::Snapshot& shot) {
    std::vector<Image> images;
    for (ScreenPicture& picture : renderDisplay(renderer_, shot, room, options, GetParam()))
      images.push_back(std::move(picture.image));
    return images;
  };
  const auto blobs = eyesIn(imagesOf(at(room.toScene(p_S))), imagesOf({}), GetParam());
  for (int side = 0; side < 2; ++side) {
    const int eye = GetParam() == StereoMode::Mono ? 0 : 2 * side - 1;
    const Vec3 e = R.transpose() * (head.eye_S(eye) - wall.lower_left_S),
               p = R.transpose() * (p_S - wall.lower_left_S);
    const Vec3 on_wall = e + (p - e) * (e.z() / (e.z() - p.z()));
    EXPECT_NEAR(blobs[side].x, 960 * on_wall.x() / 2.4, kParallax_px) << side;
    EXPECT_NEAR(blobs[side].y, 600 * (1 - on_wall.y() / 1.5),
                GetParam() == StereoMode::Interleaved ? 1 : 2 * kParallax_px)
        << side;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Stereo, testing::ValuesIn(stereoModes()),
                         [](const auto& info) { return std::string(toText(info.param)); });

TEST_F(OneBall, ADiscCoversItsAreaToOnePercent) {
  Camera camera;
  camera.eye_W = Vec3(0, 0, 0.05);
  camera.target_W = Vec3::Zero();
  camera.up_W = Vec3::UnitY();
  const DrawOptions options = plain(800, 600);
  const Blob blob =
      blobOf(renderer_.render(at(Vec3::Zero()), camera, options), renderer_.render({}, camera, options), 1);
  // A ball of radius r at distance d appears under the half angle asin(r / d).
  const double radius_px = 300 / std::tan(0.25) * std::tan(std::asin(kRadius_m / 0.05));
  EXPECT_NEAR(blob.area_px / (std::numbers::pi * radius_px * radius_px), 1, 0.01);
}

TEST(Spectral, WhiteStaysWhiteForBothEyesAndColoursStayApart) {
  // Two cameras that see only the background give pictures that differ in the filter alone.
  Mesh mesh = ball(1e-3);
  Renderer renderer({{&mesh, {0.5f, 0.02f, 0.02f}}});
  Camera camera;
  camera.eye_W = Vec3(0, 0, 0.01);
  scenes::Snapshot shot;
  shot.bodies = {{0, {}, scenes::BodyRole::Mounted}};
  const auto images =
      renderStereo(renderer, shot, eyesOf(camera, 1e-4, 1), plain(64, 64), StereoMode::Spectral);
  ASSERT_EQ(images.size(), 2u);
  for (const Image& image : images) {
    const std::uint8_t* background = image.at(2, 2);
    EXPECT_NEAR(background[0], background[2], 6) << "grey stays grey";
    const std::uint8_t* red = image.at(32, 32);
    EXPECT_GT(red[0], red[1] + 20);
  }
  EXPECT_NE(images[0].rgb, images[1].rgb);
}

TEST_P(Stereo, PicturesOfAFewPixelsAreAsLargeAsWasAskedForAndShowBothEyes) {
  Camera camera;
  camera.eye_W = Vec3(0, 0, 0.02);
  camera.target_W = Vec3::Zero();
  camera.up_W = Vec3::UnitY();
  for (const auto& [width, height] :
       {std::pair(16, 16), std::pair(17, 19), std::pair(2, 2), std::pair(16, 400)}) {
    const EyePair eyes = eyesOf(camera, 1e-3, double(width) / height);
    for (const Image& image :
         renderStereo(renderer_, at(Vec3::Zero()), eyes, plain(width, height), GetParam())) {
      EXPECT_EQ(image.width, width);
      EXPECT_EQ(image.height, height);
      // The dark ball on a background of 241 covers more than half of a pixel in the middle of each eye's
      // picture.
      const int x = GetParam() == StereoMode::SideBySide ? width / 2 + width / 4 : width / 2;
      const int y = GetParam() == StereoMode::TopBottom ? height / 2 + height / 4 : height / 2;
      EXPECT_LT(image.at(x, y)[1], 180) << width << " x " << height;
    }
  }
}

TEST(DisplayCamera, AnEyeBehindItsScreenIsRefused) {
  scenes::Display room;
  room.file = "room.toml";
  scenes::DisplayScreen wall;
  wall.name = "wall";
  wall.lower_right_S = Vec3(1, 0, 0);
  wall.upper_left_S = Vec3(0, 1, 0);
  EXPECT_NO_THROW(cameraFor(room, wall, Vec3(0, 0, 1)));
  EXPECT_THROW(cameraFor(room, wall, Vec3(0, 0, -1)), LoadError);
}

}  // namespace
}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "view/display_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "view/picture_worker.h"

namespace vps::viewer {
namespace {

/// A cave of a front and a right wall before two people.
scenes::Display cave() {
  scenes::Display display;
  display.scale = 10;
  display.screens = {{"front", Vec3(-1, 1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 1), 200, 100},
                     {"right", Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(1, 1, 2), 100, 100}};
  display.viewers.resize(2);
  display.viewers[0].name = "anna";
  display.viewers[0].X_SE = Pose(rotationFromVector(Vec3(1.5707963, 0, 0)), Vec3(-0.2, -1, 0.7));
  display.viewers[1].name = "ben";
  display.viewers[1].X_SE = Pose(rotationFromVector(Vec3(1.5707963, 0, 0)), Vec3(0.3, -1, 0.9));
  display.X_SW = Pose::translation(Vec3(0, 1.5, 0.4));
  return display;
}

TEST(DisplayTiles, EachScreenIsAnOutputForEachViewerNamedAsInSnapshots) {
  const Mesh box = makeBox(Vec3(0.02, 0.02, 0.02));
  Renderer renderer({{&box}});
  scenes::Snapshot shot;
  shot.bodies = {{0, Pose(), scenes::BodyRole::Mounted}};
  for (const StereoMode mode : {StereoMode::Mono, StereoMode::Anaglyph, StereoMode::Spectral}) {
    const std::vector<DisplayOutput> outputs = outputsOf(cave(), mode);
    const std::vector<ScreenPicture> pictures = renderDisplay(renderer, shot, cave(), {}, mode);
    ASSERT_EQ(outputs.size(), pictures.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) EXPECT_EQ(outputs[i].name, pictures[i].name);
  }
  EXPECT_NEAR(outputsOf(cave(), StereoMode::Mono)[0].aspect, 2, 1e-12);
  EXPECT_NEAR(outputsOf(cave(), StereoMode::Mono)[2].aspect, 1, 1e-12);
}

TEST(DisplayTiles, KeepTheirProportionsAndDoNotOverlap) {
  for (const auto& [width, height] : {std::pair(950, 656), std::pair(300, 900), std::pair(64, 16)}) {
    const std::vector<DisplayOutput> outputs = outputsOf(cave(), StereoMode::Spectral);
    const std::vector<TilePlace> places = tilePlaces(outputs, {width, height});
    ASSERT_EQ(places.size(), 8u);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const TilePlace& a = places[i];
      // Both lengths are rounded to whole pixels.
      EXPECT_NEAR(a.width, outputs[i].aspect * a.height, 2.5);
      EXPECT_GE(a.x, 0);
      EXPECT_GE(a.y, 0);
      EXPECT_LE(a.x + a.width, width);
      EXPECT_LE(a.y + a.height, height);
      for (std::size_t k = i + 1; k < places.size(); ++k) {
        const TilePlace& b = places[k];
        EXPECT_TRUE(a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y ||
                    b.y + b.height <= a.y)
            << i << " " << k;
      }
    }
  }
}

TEST(DisplayTiles, OneAloneFillsTheWindowAndSeveralAreAsLargeAsTheyCanBe) {
  std::vector<DisplayOutput> outputs = outputsOf(cave(), StereoMode::Mono);
  EXPECT_EQ(tilePlaces(std::span(outputs).first(1), {950, 656}), (std::vector<TilePlace>{{0, 0, 950, 656}}));
  EXPECT_TRUE(tilePlaces({}, {950, 656}).empty());
  // Two wide pictures are placed one above the other in a square window, and side by side in a wide one.
  const std::vector<TilePlace> square = tilePlaces(std::span(outputs).first(2), {400, 404});
  EXPECT_EQ(square[0], (TilePlace{0, 0, 400, 200}));
  EXPECT_EQ(square[1], (TilePlace{0, 204, 400, 200}));
  const std::vector<TilePlace> strip = tilePlaces(std::span(outputs).first(2), {804, 100});
  EXPECT_EQ(strip[0].y, strip[1].y);
}

TEST(DisplayTiles, APictureOfSeveralHoldsWhatEachShowsAlone) {
  const Mesh box = makeBox(Vec3(0.02, 0.02, 0.02));
  const RenderScene scene = {{&box}};
  Renderer renderer(scene);
  PictureRequest wanted;
  wanted.snapshot.bodies = {{0, Pose(), scenes::BodyRole::Mounted}};
  wanted.options.width = 300;
  wanted.options.height = 200;
  wanted.options.supersampling = 1;
  const scenes::Display display = cave();
  const auto add = [&](std::size_t screen, TilePlace place, int eye) {
    wanted.tiles.push_back({eyesOf(display, display.screens[screen], display.viewers[0]), place, eye});
  };
  const auto shows = [&](const Image& whole, const TilePlace& place, const Image& part) {
    if (part.width != place.width || part.height != place.height) return false;
    for (int y = 0; y < part.height; ++y)
      if (!std::equal(part.at(0, y), part.at(0, y) + 3 * part.width, whole.at(place.x, place.y + y)))
        return false;
    return true;
  };
  add(0, {0, 0, 200, 100}, 0);
  add(1, {205, 50, 90, 90}, 0);
  for (const StereoMode mode : {StereoMode::Mono, StereoMode::SideBySide, StereoMode::TopBottom,
                                StereoMode::Anaglyph, StereoMode::Interleaved}) {
    wanted.stereo = mode;
    const Image whole = drawInFull(renderer, wanted);
    ASSERT_EQ(whole.width, 300);
    for (const PictureTile& tile : wanted.tiles) {
      DrawOptions alone = wanted.options;
      alone.width = tile.place.width;
      alone.height = tile.place.height;
      // Rows alternate over the whole picture.
      const ScreenRows rows{alone.width, alone.height, tile.place.y};
      EXPECT_TRUE(shows(whole, tile.place,
                        renderStereo(renderer, wanted.snapshot, tile.eyes, alone, mode, rows).front()))
          << toText(mode);
    }
    EXPECT_EQ(whole.at(299, 199)[0], 0) << "pixels outside all outputs are black";
  }
  wanted.stereo = StereoMode::Spectral;
  wanted.tiles.clear();
  add(0, {0, 0, 140, 70}, -1);
  add(0, {150, 0, 140, 70}, 1);
  const Image whole = drawInFull(renderer, wanted);
  DrawOptions alone = wanted.options;
  alone.width = 140;
  alone.height = 70;
  const std::vector<Image> both =
      renderStereo(renderer, wanted.snapshot, wanted.tiles[0].eyes, alone, StereoMode::Spectral);
  EXPECT_TRUE(shows(whole, wanted.tiles[0].place, both[0]));
  EXPECT_TRUE(shows(whole, wanted.tiles[1].place, both[1]));
  // In a draft with half the pixels, the outputs lie at half the coordinates.
  EXPECT_EQ(drawDraft(renderer, wanted, 2).width, 150);
}

}  // namespace
}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/scene/display.h"

namespace vps::scenes {
namespace {

const std::string kWall =
    "[[screen]]\nname = 'wall'\npixels = [1600, 900]\nlower_left = [-0.8, 0, 0]\nlower_right = [0.8, 0, 0]\n"
    "upper_left = [-0.8, 0, 0.9]\n";
// A head upright in front of the screen: its x axis is parallel to the screen's, its -z axis points to the
// screen.
const std::string kHead =
    "[[viewer]]\nname = 'anna'\nhead = {position = [0, -1, 0.5], rpy_deg = [90, 0, 0]}\n";

class DisplayFile : public testing::Test {
 protected:
  Display load(const std::string& text) {
    // Tests of this file run at the same time.
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const std::string file =
        (std::filesystem::path(testing::TempDir()) / ("display_" + name + ".toml")).string();
    std::ofstream(file) << text;
    return loadDisplay(file);
  }
  std::string refusal(const std::string& text) {
    try {
      load(text);
    } catch (const LoadError& error) {
      return error.what();
    }
    return "not refused";
  }
};

TEST_F(DisplayFile, HoldsScreensViewersAndThePlaceOfTheScene) {
  const Display display =
      load("unit = 'm'\n[scene]\npose = {position = [0, 0.1, 0.4]}\nscale = 10\n" + kWall + kHead);
  ASSERT_EQ(display.screens.size(), 1u);
  ASSERT_EQ(display.viewers.size(), 1u);
  EXPECT_EQ(display.screens[0].width, 1600);
  EXPECT_LT((display.screens[0].axes().col(2) - Vec3(0, -1, 0)).norm(), 1e-15) << "seen from the front";
  EXPECT_LT((display.viewers[0].eye_S(-1) - Vec3(-0.0315, -1, 0.5)).norm(), 1e-15);
  EXPECT_LT((display.toScene({0.2, 0.1, 0.4}) - Vec3(0.02, 0, 0)).norm(), 1e-15);
}

TEST_F(DisplayFile, AScreenBehindTheHeadIsRefused) {
  // A head that is rotated by 180 degrees looks away from the wall.
  const std::string away =
      "[[viewer]]\nname = 'anna'\nhead = {position = [0, -1, 0.5], rpy_deg = [90, 0, 180]}\n";
  EXPECT_NE(refusal(kWall + away).find("has 'wall' behind the head"), std::string::npos)
      << refusal(kWall + away);
  const std::string behind =
      "[[viewer]]\nname = 'anna'\nhead = {position = [0, 1, 0.5], rpy_deg = [90, 0, 0]}\n";
  EXPECT_NE(refusal(kWall + behind).find("of 'anna' is behind 'wall'"), std::string::npos)
      << refusal(kWall + behind);
}

TEST_F(DisplayFile, WhatIsWrongIsSaidWithLineAndRemedy) {
  EXPECT_NE(refusal(kHead).find("no [[screen]]"), std::string::npos);
  EXPECT_NE(refusal(kWall).find("no [[viewer]]"), std::string::npos);
  EXPECT_NE(refusal("[[screen]]\nlower_left = [0, 0, 0]\n" + kHead).find("'lower_right' is missing"),
            std::string::npos)
      << refusal("[[screen]]\nlower_left = [0, 0, 0]\n" + kHead);
  std::string slanted = kWall;
  slanted.replace(slanted.find("-0.8, 0, 0.9"), 12, "-0.7, 0, 0.9");
  EXPECT_NE(refusal(slanted + kHead).find("right angle"), std::string::npos);
  std::string flat = kWall;
  flat.replace(flat.find("-0.8, 0, 0.9"), 12, "-0.8, 0, 0.0");
  EXPECT_NE(refusal(flat + kHead).find("no area"), std::string::npos);
  EXPECT_NE(refusal("[[screen]\n").find("not valid TOML"), std::string::npos);
  EXPECT_NE(refusal("screens = 3\n").find("screens"), std::string::npos);
  EXPECT_THROW(loadDisplay("missing.toml"), LoadError);
}

TEST_F(DisplayFile, CutAtEveryByteItIsReadOrRefused) {
  const std::string whole = kWall + kHead;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    try {
      load(whole.substr(0, i));
    } catch (const LoadError&) {
    }
  }
}

}  // namespace
}  // namespace vps::scenes

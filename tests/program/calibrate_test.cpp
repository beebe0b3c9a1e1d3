// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <random>

#include "program.h"
#include "support/random_draw.h"
#include "vps_scenes/scene/display.h"
#include "vps_scenes/scene/scene.h"

namespace vps {
namespace {

TEST_F(Program, ADevicesPlaceIsFoundFromTouchedPoints) {
  // The device is shifted by (1, 2, 3) m and rotated by a quarter turn about z, so that x becomes y.
  write("touched.csv",
        "x, y, z, room x, room y, room z\n0, 0, 0, 1, 2, 3\n0.1, 0, 0, 1, 2.1, 3\n0, 0.2, 0, 0.8, 2, 3\n"
        "0, 0, 0.1, 1, 2, 3.1  # up\n");
  const Ran ran = run("calibrate --points touched.csv -o placement.toml");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("4 points: residual"), std::string::npos) << ran.out;
  const std::string toml = slurp(folder_ / "placement.toml");
  EXPECT_NE(toml.find("position = [\"1m\", \"2m\", \"3m\"]"), std::string::npos) << toml;
  EXPECT_NE(toml.find("0.707106781187"), std::string::npos) << toml;
}

TEST_F(Program, ADevicesPlaceIsReadByDisplayFilesAndScenes) {
  write("touched.csv", "0,0,0,1,2,3\n0.1,0,0,1,2.1,3\n0,0.2,0,0.8,2,3\n0,0,0.1,1,2,3.1\n");
  const std::string wall =
      "[scene]\nscale = 4\n[[screen]]\npixels = [64, 48]\nlower_left = [-0.8, 0, 0]\nlower_right = [0.8, 0, "
      "0]\n"
      "upper_left = [-0.8, 0, 1.2]\n[[viewer]]\nhead = {position = [0, -1, 0.5], rpy_deg = [90, 0, 0]}\n";
  write("bare.toml", wall);
  ASSERT_EQ(run("calibrate --points touched.csv -o placement.toml").status, 0);
  write("wall.toml", wall + slurp(folder_ / "placement.toml"));
  const Ran shown = run("snapshot scene.toml -o wall.png --display wall.toml");
  EXPECT_EQ(shown.status, 0) << shown.err;
  // The placement for the scene file: a metre of the room is a quarter of a metre of the scene, whatever unit
  // the scene file has.
  ASSERT_EQ(run("calibrate --points touched.csv --display bare.toml -o device.toml").status, 0);
  const std::string device = slurp(folder_ / "device.toml");
  EXPECT_NE(device.find("scale = 0.25"), std::string::npos) << device;
  EXPECT_NE(device.find("[\"0.25m\", \"0.5m\", \"0.75m\"]"), std::string::npos) << device;
  write("placed.toml", std::string(kScene) + device);
  const Ran explained = run("explain placed.toml");
  EXPECT_EQ(explained.status, 0) << explained.err;
  write("crooked.toml", std::string(kScene) + "[device]\nplacement = 3\n");
  expectRefused("explain crooked.toml", "placement");
}

/// The scene is at (1, 0.2, 0.9) m in the room, rotated by a quarter turn and five times as large.
const std::string kRoom =
    "# Our wall. Größe: 1.6 m\n[scene] # stands on the table\npose = {position = [1, 0.2, 0.9], rpy_deg = "
    "[0, "
    "0, 90]}\nscale = 5.0   # as seen\n\n[[screen]]\npixels = [64, 48]\nlower_left = [-0.8, 0, 0]\n"
    "lower_right = [0.8, 0, 0]\nupper_left = [-0.8, 0, 1.2]\n";
const std::string kHead = "[[viewer]]\nhead = {position = [0, -1, 0.5], rpy_deg = [90, 0, 0]}  # Anna";
const std::string kTouched =
    "0,0,0,1,2,3\n0.1,0,0,1,2.1,3\n0,0.2,0,0.8,2,3\n0,0,0.1,1,2,3.1\n";  // as in the first test

TEST_F(Program, ACalibrationIsWrittenIntoDisplayFileAndSceneSoThatTheHandIsWhereItsPartIsDrawn) {
  // Twelve points of the workspace, touched with an error of 0.2 mm along each axis (standard deviation).
  const Pose X_SD(rotationFromVector(Vec3(0.05, -0.1, 1.2)), Vec3(0.8, 0.3, 0.7));
  std::mt19937 random(7);
  std::normal_distribution<double> draw;
  std::ostringstream touched;
  std::vector<Vec3> places_D;
  double greatest_m = 0;
  touched.precision(12);
  for (int i = 0; i < 12; ++i) {
    const Vec3 p_D = 0.15 * test::drawnVector(draw, random);
    const Vec3 error_S = 0.2e-3 * test::drawnVector(draw, random);
    const Vec3 p_S = X_SD * p_D + error_S;
    greatest_m = std::max(greatest_m, error_S.norm());
    places_D.push_back(p_D);
    for (int k = 0; k < 3; ++k) touched << p_D[k] << ", ";
    touched << p_S[0] << ", " << p_S[1] << ", " << p_S[2] << "\n";
  }
  write("touched.csv", touched.str());
  write("wall.toml", kRoom + kHead);
  write("scene.toml", std::string(kScene) + "[device] # ours\nkind = 'mouse'\nscale = 1 # for now\n");
  const Ran ran = run("calibrate --points touched.csv --write-display wall.toml --write-scene scene.toml");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("12 points: residual"), std::string::npos) << ran.out;

  const scenes::Display display = scenes::loadDisplay((folder_ / "wall.toml").string());
  const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
  ASSERT_TRUE(display.X_SD);
  ASSERT_TRUE(scene.device.placement);
  EXPECT_EQ(scene.device.kind, "mouse");
  for (const Vec3& p_D : places_D) {
    const Vec3 p_W = *scene.device.placement * Vec3(scene.device.scale * p_D);
    const Vec3 drawn_S = display.X_SW * Vec3(display.scale * p_W);
    // Least squares reduce the errors of the points, so that no position is off by more than the greatest of
    // them.
    EXPECT_LT((drawn_S - X_SD * p_D).norm(), greatest_m);
    EXPECT_LT((*display.X_SD * p_D - drawn_S).norm(), 1e-8) << "9 digits are written";
  }
}

TEST_F(Program, ACalibrationLeavesAllElseOfAFileAsItIs) {
  write("touched.csv", kTouched);
  const std::string printed = run("calibrate --points touched.csv").out, key = "placement = ";
  ASSERT_NE(printed.find(key), std::string::npos) << printed;
  const std::size_t at = printed.find(key) + key.size();
  const std::string found = printed.substr(at, printed.find('\n', at) - at);
  // Texts before and after; '@' stands for the placement that was found.
  const std::array<std::array<std::string, 2>, 6> texts = {{
      {kRoom + kHead, kRoom + kHead + "\n\n[device]\nplacement = @\n"},
      {kRoom + "[device]  # the arm\n# to be measured\n" + kHead,
       kRoom + "[device]  # the arm\nplacement = @\n# to be measured\n" + kHead},
      {kRoom + "[device]\nplacement = {position = [\n9, # é\n9, 9]} # old\n" + kHead,
       kRoom + "[device]\nplacement = @ # old\n" + kHead},
      {"device = {placement = {position = [9, 9, 9]}} # ö\n" + kRoom + kHead,
       "device = {placement = @} # ö\n" + kRoom + kHead},
      {"device = {}\n" + kRoom + kHead, "device = {placement = @}\n" + kRoom + kHead},
      {"unit = 'm'\r\n[device]\r\n" + kRoom + kHead,
       "unit = 'm'\r\n[device]\r\nplacement = @\r\n" + kRoom + kHead},
  }};
  for (const auto& [before, after] : texts) {
    write("wall.toml", before);
    fs::permissions(folder_ / "wall.toml", fs::perms::owner_read | fs::perms::owner_write);
    const Ran ran = run("calibrate --points touched.csv --write-display wall.toml");
    EXPECT_EQ(ran.status, 0) << ran.err;
    std::string wanted = after;
    wanted.replace(wanted.find('@'), 1, found);
    EXPECT_EQ(slurp(folder_ / "wall.toml"), wanted);
    EXPECT_EQ(fs::status(folder_ / "wall.toml").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_NO_THROW(scenes::loadDisplay((folder_ / "wall.toml").string())) << wanted;
    run("calibrate --points touched.csv --write-display wall.toml");
    EXPECT_EQ(slurp(folder_ / "wall.toml"), wanted) << "the same again";
  }
}

TEST_F(Program, AFileThatACalibrationCannotWriteIsLeftAsItWas) {
  write("touched.csv", kTouched);
  const auto expectLeft = [&](const std::string& arguments, const std::string& words) {
    const std::string wall = slurp(folder_ / "wall.toml"), scene = slurp(folder_ / "scene.toml");
    expectRefused("calibrate --points touched.csv " + arguments, words);
    EXPECT_EQ(slurp(folder_ / "wall.toml"), wall) << arguments;
    EXPECT_EQ(slurp(folder_ / "scene.toml"), scene) << arguments;
  };
  write("wall.toml", kRoom + kHead);
  expectLeft("--write-scene scene.toml", "--display");
  expectLeft("--write-display wall.toml --display wall.toml", "give only one");
  expectLeft("--write-display wall.toml --write-scene missing.toml", "missing.toml: no such file");
  expectLeft("--write-display wall.toml --write-scene wall.toml", "wall.toml");
  expectLeft("--write-display scene.toml", "scene.toml");
  fs::permissions(folder_ / "scene.toml", fs::perms::owner_read);
  expectLeft("--write-display wall.toml --write-scene scene.toml", "scene.toml: is write-protected");
  fs::permissions(folder_ / "scene.toml", fs::perms::owner_all);
  // The disk is full after 32 kB: the scene is longer, so the display file is not written either.
  write("scene.toml", std::string(40000, '#') + "\n" + kScene);
  const std::string whole = slurp(folder_ / "scene.toml");
  const Ran full = run("--version && trap '' XFSZ && ulimit -f 64 && '" VPS_PROGRAM
                       "' calibrate --points touched.csv --write-display wall.toml --write-scene scene.toml");
  EXPECT_EQ(full.status, 2) << full.out;
  EXPECT_NE(full.err.find("scene.toml: cannot be written"), std::string::npos) << full.err;
  EXPECT_EQ(slurp(folder_ / "scene.toml"), whole);
  EXPECT_EQ(slurp(folder_ / "wall.toml"), kRoom + kHead);
  write("wall.toml", kRoom + "[device.placement]\nposition = [9, 9, 9]\n" + kHead);
  expectLeft("--write-display wall.toml", "in a form that cannot be edited");
}

TEST_F(Program, TablesThatCannotCalibrateAreRefused) {
  write("two.csv", "0,0,0,1,2,3\n1,0,0,2,2,3\n");
  write("short.csv", "0,0,0,1,2,3\n1,0,0,2,2\n");
  write("line.csv", "0,0,0,1,2,3\n1,0,0,2,2,3\n2,0,0,3,2,3\n");
  write("words.csv", "0,0,0,1,2,3\n1,0,0,2,two,3\n");
  expectRefused("calibrate --points two.csv", "fewer than three");
  expectRefused("calibrate --points short.csv", "short.csv:2");
  expectRefused("calibrate --points line.csv", "on one line");
  expectRefused("calibrate --points words.csv", "words.csv:2");
  expectRefused("calibrate --points missing.csv", "missing.csv");
  expectRefused("calibrate", "--points");
  write("arms.csv", "0,0,0.8,0,0,0.8,0\n");
  expectRefused("calibrate --bases arms.csv", "fewer than twelve");
}

}  // namespace
}  // namespace vps

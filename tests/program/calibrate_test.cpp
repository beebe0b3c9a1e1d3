// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

namespace vps {
namespace {

TEST_F(Program, ADevicesPlaceIsFoundFromTouchedPoints) {
  // Shifted by (1, 2, 3) m and turned by a quarter about z: x goes to y.
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
  // For the scene's own file: a quarter of a room's metre is one of the scene's, in whatever unit it has.
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

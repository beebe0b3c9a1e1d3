// SPDX-License-Identifier: BSD-3-Clause
// Scenes are written and read again without a change.
#include "vps_scenes/scene/scene_text.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/stl_box.h"
#include "support/temporary_folder.h"

namespace vps::scenes {
namespace {

TEST(SceneText, IsReadAsTheSameScene) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "box.stl", std::ios::binary) << stlBox(Vec3(20, 20, 10));
  const auto load = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
    return loadScene((folder.path() / name).string());
  };
  const Scene first = load("first.toml", R"(name = "a \"scene\""
unit = "mm"
gravity = [0, 1.5, -9]
release_s = 0.3
[[part]]
file = "box.stl"
name = "base"
fixed = true
color = "#804020"
[[part]]
file = "box.stl"
name = "lid"
pose = {position = [1, 2, 10.1], rpy_deg = [0, 0, 30]}
press_fit = "3um"
density = 2700
[[step]]
part = "lid"
approach = [0, 0, 40]
way_points = [{position = [1, 2, 30]}, {position = [1, 2, 20]}]
tolerance = 0.07
tolerance_deg = 1.5
holds = true
[device]
scale = 2.5
[operator]
seed = 17
aim_error_deg = 0.1
[coupling]
k_N_per_m = 900
[fidelity]
preset = "fast"
substeps = "auto"
)");
  const std::string text = sceneText(first, {"box.stl", "box.stl"}, "a comment");
  // STL states no unit, and the text is in metres: the mesh of this test is scaled instead.
  std::ofstream(folder.path() / "box.stl", std::ios::binary) << stlBox(Vec3(0.020, 0.020, 0.010));
  const Scene second = load("second.toml", text);
  EXPECT_EQ(sceneText(second, {"box.stl", "box.stl"}, "a comment"), text);
  EXPECT_EQ(second.name, "a \"scene\"");
  EXPECT_EQ(second.gravity_W, first.gravity_W);
  EXPECT_EQ(second.release_s, 0.3);
  EXPECT_EQ(second.fidelity.voxel_m, first.fidelity.voxel_m);
  EXPECT_NE(text.find("substeps = \"auto\""), std::string::npos);
  EXPECT_EQ(second.fidelity.substeps, 0);
  EXPECT_TRUE(second.parts[0].is_fixed);
  EXPECT_EQ(second.parts[1].press_fit_m, 3e-6);
  EXPECT_EQ(second.parts[1].part.material.density_kg_m3, 2700);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(second.parts[0].part.color[i], first.parts[0].part.color[i], 1e-6);
  EXPECT_LT((second.parts[1].X_WP.R - first.parts[1].X_WP.R).norm(), 1e-11);
  ASSERT_EQ(second.steps.size(), 1U);
  EXPECT_LT((second.steps[0].X_WP_start.p - first.steps[0].X_WP_start.p).norm(), 1e-12);
  EXPECT_EQ(second.steps[0].way_points.size(), 2U);
  EXPECT_NEAR(second.steps[0].tolerance_rad, first.steps[0].tolerance_rad, 1e-12);
  EXPECT_TRUE(second.steps[0].is_held);
  EXPECT_EQ(second.device.scale, 2.5);
  EXPECT_EQ(second.hand.seed, 17U);
  EXPECT_EQ(second.coupling.k_N_per_m, 900);
}

}  // namespace
}  // namespace vps::scenes

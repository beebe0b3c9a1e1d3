// SPDX-License-Identifier: BSD-3-Clause
// Rigid groups: in the scene file, as proposed by import, and as one body in all uses.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scenes/assemblies_to_plan.h"
#include "support/stl_box.h"
#include "support/temporary_folder.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::scenes {
namespace {

using Names = std::vector<std::string>;

/// A plate of 40 x 40 x 10 mm with three boxes on it: a and b touch, c stands alone.
class SceneGroups : public testing::Test {
 protected:
  void SetUp() override {
    write("plate.stl", stlBox(Vec3(40, 40, 10)));
    write("box.stl", stlBox(Vec3(4, 4, 20)));
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
  }
  [[nodiscard]] Scene load(const std::string& more) const {
    std::string text =
        "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n"
        "[[part]]\nname = 'a'\nfile = 'box.stl'\npose = {position = [0, 0, 15]}\ndensity = 1000\n"
        "[[part]]\nname = 'b'\nfile = 'box.stl'\npose = {position = [4, 0, 15]}\ndensity = 3000\n"
        "friction = 0.9\n"
        "[[part]]\nname = 'c'\nfile = 'box.stl'\npose = {position = [-12, 0, 15]}\nscenery = true\n";
    write("scene.toml", text + more);
    return loadScene((folder_.path() / "scene.toml").string());
  }
  [[nodiscard]] std::string messageOf(const std::string& more) const {
    try {
      static_cast<void>(load(more));
    } catch (const LoadError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(SceneGroups, AGroupKeepsTheColorsOfItsParts) {
  const std::string group = "[[group]]\nname = 'plug'\nparts = ['a', 'b']\n";
  EXPECT_TRUE(load(group).parts[1].part.face_colors.isNone());
  std::vector<ScenePart> parts = load("").parts;
  parts = {parts[1], parts[2]};
  parts[0].part.color = {1, 0, 0};
  parts[1].part.color = {0, 0, 1};
  const FaceColors colors = unitedPart("plug", parts).part.face_colors;
  ASSERT_EQ(colors.of_triangle.size(), 24U);
  EXPECT_EQ(colors.at(0), parts[0].part.color);
  EXPECT_EQ(colors.at(11), parts[0].part.color);
  EXPECT_EQ(colors.at(12), parts[1].part.color);
  EXPECT_EQ(colors.at(23), parts[1].part.color);
}

TEST_F(SceneGroups, AGroupIsOnePartInPlaceOfItsFirst) {
  const Scene scene = load("[[group]]\nname = 'plug'\nparts = ['a', 'b']\n[[step]]\npart = 'plug'\n");
  ASSERT_EQ(scene.parts.size(), 3U);
  const ScenePart& plug = scene.parts[1];
  EXPECT_EQ(plug.part.name, "plug");
  EXPECT_EQ(plug.members, (Names{"a", "b"}));
  EXPECT_EQ(plug.part.mesh.triangles.size(), 24U);
  EXPECT_LT((plug.X_WP.p - Vec3(0, 0, 0.015)).norm(), 1e-12);
  EXPECT_LT((bounds(plug.part.mesh).size() - Vec3(8e-3, 4e-3, 20e-3)).norm(), 1e-8);
  // Two equal volumes with densities of 1000 and 3000 kg/m^3.
  EXPECT_NEAR(plug.part.material.density_kg_m3, 2000, 1e-6);
  EXPECT_EQ(plug.part.material.friction, 0.15);  // the friction of the group's first part
  EXPECT_FALSE(plug.is_fixed);
  ASSERT_EQ(scene.steps.size(), 1U);
  EXPECT_EQ(scene.steps[0].part, 1U);
}

TEST_F(SceneGroups, OneFixedPartFixesAll) {
  const Scene scene = load("[[group]]\nname = 'base'\nparts = ['a', 'plate']\n[[step]]\npart = 'b'\n");
  EXPECT_TRUE(scene.parts[0].is_fixed);
  EXPECT_EQ(scene.parts[0].part.name, "base");
}

TEST_F(SceneGroups, AGroupMayHaveTheNameOfOneOfItsParts) {
  const Scene scene = load("[[group]]\nname = 'a'\nparts = ['a', 'b']\n[[step]]\npart = 'a'\n");
  EXPECT_EQ(scene.parts[1].members.size(), 2U);
}

TEST_F(SceneGroups, MistakesAreSaidWithLineAndKey) {
  const auto says = [&](const std::string& text, const std::string& line, const std::string& words) {
    const std::string message = messageOf(text);
    EXPECT_NE(message.find("scene.toml:" + line + ": "), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const std::string group = "[[group]]\nname = 'plug'\n";
  says("[[group]]\nparts = ['a', 'b']\n", "21", "has no 'name'");
  says(group, "21", "has no 'parts'");
  says(group + "parts = 'a'\n", "23", "expected a list");
  says(group + "parts = ['a', 3]\n", "23", "expected texts only");
  says(group + "parts = ['a']\n", "23", "fewer than two");
  says(group + "parts = ['a', 'a']\n", "23", "in the group 'plug' already");
  says(group + "parts = ['a', 'bb']\n", "23", "did you mean 'b'?");
  says(group + "parts = ['a', 'c']\n", "23", "only one is scenery");
  says(group + "parts = ['a', 'b']\nmass = 3\n", "24", "mass");
  says("[[group]]\nname = 'plate'\nparts = ['a', 'b']\n", "22", "which is also the name of a part");
  says(group + "parts = ['a', 'b']\n[[group]]\nname = 'plug'\nparts = ['plate', 'c']\n", "26", "scenery");
  says(group + "parts = ['a', 'b']\n[[step]]\npart = 'b'\n", "25", "is part of the group 'plug'");
}

TEST_F(SceneGroups, ItsTextReadsBack) {
  const PartGroup group{"plug", {"a", "b"}, "one product"};
  const Scene scene = load(groupText(group));
  EXPECT_EQ(scene.parts[1].members, group.parts);
  EXPECT_NE(groupText(group).find("# one product"), std::string::npos);
}

ImportedPart imported(const std::string& name, const Mesh& mesh, const Vec3& p_W, Names within = {}) {
  ImportedPart part{name, mesh, Pose::translation(p_W)};
  part.within = std::move(within);
  return part;
}

/// A plug of twelve solids, and the socket that it goes into.
ImportedCad plugAndSocket() {
  ImportedCad cad;
  cad.file = "plug.step";
  cad.parts.push_back(
      imported("socket", block({-0.02, -0.02, -0.02}, {0.02, 0.02, 0}), Vec3::Zero(), {"product", "socket"}));
  for (int i = 0; i < 12; ++i)  // blades and shell, each touching the next
    cad.parts.push_back(imported(i == 0 ? "plug" : "plug_" + std::to_string(i + 1),
                                 makeBox(Vec3::Constant(2e-3)), Vec3(2e-3 * (i % 4), 2e-3 * (i / 4), 1e-3),
                                 {"product", "plug"}));
  return cad;
}

TEST(PartGroups, TheSolidsOfOneProductAreOne) {
  ImportedCad cad = plugAndSocket();
  const std::vector<PartGroup> groups = partGroups(cad, {});
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].name, "plug");
  EXPECT_EQ(groups[0].parts.size(), 12U);
  EXPECT_EQ(groups[0].reason, "one product");
  EXPECT_TRUE(partGroups(cad, {.is_proposed = false}).empty());

  Scene scene = sceneOf(cad);
  uniteGroups(scene, groups);
  ASSERT_EQ(scene.parts.size(), 2U);
  const PlanResult plan = planAssembly(scene);
  ASSERT_EQ(plan.assemblies.size(), 1U);
  EXPECT_EQ(plan.assemblies[0].fixed, Names{"socket"});
  ASSERT_EQ(plan.assemblies[0].steps.size(), 1U);
  EXPECT_EQ(plan.assemblies[0].steps[0].name, "plug");
  EXPECT_TRUE(plan.overlaps.empty());
}

TEST(PartGroups, WhatOverlapsWithinAGroupIsNoClash) {
  ImportedCad cad = plugAndSocket();
  cad.parts[2].X_WP.p.x() -= 1e-3;  // into its neighbour
  Scene scene = sceneOf(cad);
  EXPECT_GT(checkAssembly("loose", drawnParts(scene)).clashes(), 0U);
  uniteGroups(scene, partGroups(cad, {}));
  EXPECT_EQ(checkAssembly("grouped", drawnParts(scene)).clashes(), 0U);
}

TEST(PartGroups, AFileOfOneProductIsAnAssemblyAndSaysSo) {
  ImportedCad cad = plugAndSocket();
  cad.parts.erase(cad.parts.begin());
  EXPECT_TRUE(partGroups(cad, {}).empty());
  ASSERT_EQ(cad.warnings.size(), 1U);
  EXPECT_NE(cad.warnings[0].find("--group 'plug'"), std::string::npos) << cad.warnings[0];
  EXPECT_EQ(partGroups(cad, {.names = {"plug"}}).size(), 1U);
}

TEST(PartGroups, AreWishedForByAssemblyOrByPattern) {
  ImportedCad cad = plugAndSocket();
  EXPECT_EQ(partGroups(cad, {.names = {"product"}})[0].parts.size(), 13U);
  const std::vector<PartGroup> some = partGroups(cad, {.is_proposed = false, .names = {"plug_1*"}});
  ASSERT_EQ(some.size(), 1U);
  EXPECT_EQ(some[0].parts, (Names{"plug_10", "plug_11", "plug_12"}));
  EXPECT_THROW(partGroups(cad, {.names = {"nothing"}}), LoadError);
  EXPECT_THROW(partGroups(cad, {.names = {"socket"}}), LoadError);
  EXPECT_THROW(partGroups(cad, {.names = {"plug_1*", "plug"}}), LoadError);
}

TEST(PartGroups, OpenSurfacesThatShareEdgesAreOne) {
  // A cube without its top, a top with one quarter missing, and a separate sheet.
  Mesh open = makeBox(Vec3::Constant(0.01)), top;
  top.vertices = open.vertices;
  std::erase_if(open.triangles, [&](const auto& t) {
    const bool is_top = std::ranges::all_of(t, [&](std::uint32_t i) { return open.vertices[i].z() > 0; });
    if (is_top && top.triangles.empty()) top.triangles.push_back(t);
    return is_top;
  });
  ImportedCad cad;
  cad.parts = {imported("shell", open, {0, 0, 0}), imported("lid", top, {0, 0, 0}),
               imported("sheet", top, {0, 0, 0.1})};
  const std::vector<PartGroup> groups = partGroups(cad, {});
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(groups[0].parts, (Names{"shell", "lid"}));
  // Solids that touch remain separate parts.
  cad.parts = {imported("a", makeBox(Vec3::Constant(0.01)), {0, 0, 0}),
               imported("b", makeBox(Vec3::Constant(0.01)), {0.01, 0, 0}),
               imported("c", makeBox(Vec3::Constant(0.01)), {0.03, 0, 0})};
  EXPECT_TRUE(partGroups(cad, {}).empty());
}

}  // namespace
}  // namespace vps::scenes

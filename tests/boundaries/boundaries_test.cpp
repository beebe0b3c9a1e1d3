// SPDX-License-Identifier: BSD-3-Clause
// Who may include whom: between the folders of the project, and between the groups inside each folder.
#include <gtest/gtest.h>

#include <fstream>

#include "boundaries/include_graph.h"
#include "support/temporary_folder.h"

namespace vps::boundaries {

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = VPS_SOURCE_DIR;

std::string joined(const std::vector<std::string>& messages) {
  std::string text;
  for (const std::string& message : messages) text += message + "\n";
  return text;
}

class GroupsTest : public testing::TestWithParam<const char*> {};

TEST_P(GroupsTest, IncludeEachOtherInNoCircle) {
  EXPECT_EQ(joined(groupCircles(kRoot, GetParam())), "");
}

INSTANTIATE_TEST_SUITE_P(OfEachFolder, GroupsTest,
                         testing::Values("plugin", "bullet_bridge", "device", "scenes", "viewer"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Folders, IncludeNoFolderAboveThemAndNoLibraryOfAnother) {
  EXPECT_EQ(joined(folderViolations(kRoot)), "");
}

TEST(Folders, HaveFilesThatTheChecksRead) {
  for (const char* folder : {"plugin", "bullet_bridge", "device", "scenes", "viewer"})
    EXPECT_GT(includesBelow(kRoot, folder).size(), 50U) << folder;
}

/// A tree of sources that breaks the rules.
class BrokenTree : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    fs::create_directories((root_.path() / file).parent_path());
    std::ofstream(root_.path() / file) << text;
  }
  [[nodiscard]] fs::path root() const { return root_.path(); }

 private:
  test::TemporaryFolder root_;
};

TEST_F(BrokenTree, ACircleOfGroupsIsReportedWithItsLines) {
  write("plugin/src/mesh/mesh.cpp", "#include \"vps/mesh.h\"\n#include \"voxmap/layout.h\"\n");
  write("plugin/src/voxmap/layout.h", "#pragma once\n#include \"vps/mesh.h\"\n");
  write("plugin/include/vps/mesh.h", "#pragma once\n");
  const std::vector<std::string> circles = groupCircles(root(), "plugin");
  ASSERT_EQ(circles.size(), 1U);
  EXPECT_NE(circles[0].find("mesh -> voxmap -> mesh"), std::string::npos) << circles[0];
  EXPECT_NE(circles[0].find("plugin/src/mesh/mesh.cpp:2 includes voxmap/layout.h"), std::string::npos);
}

TEST_F(BrokenTree, ACircleThroughAHeaderWithoutSourceIsReported) {
  write("plugin/src/mesh/mesh.cpp", "#include \"vps/part.h\"\n");
  write("plugin/include/vps/part.h", "#include \"vps/mesh.h\"\n");
  write("plugin/include/vps/mesh.h", "#pragma once\n");
  EXPECT_EQ(groupCircles(root(), "plugin").size(), 1U);
}

TEST_F(BrokenTree, AnOrderOfGroupsIsNoCircle) {
  write("plugin/src/mesh/mesh.cpp", "#include \"vps/mesh.h\"\n");
  write("plugin/src/voxmap/voxmap.cpp", "#include \"vps/mesh.h\"\n#include \"vps/voxmap.h\"\n");
  write("plugin/src/query/query.cpp", "#include \"vps/voxmap.h\"\n#include \"vps/mesh.h\"\n");
  write("plugin/include/vps/mesh.h", "#pragma once\n");
  write("plugin/include/vps/voxmap.h", "#include \"vps/mesh.h\"\n");
  EXPECT_EQ(joined(groupCircles(root(), "plugin")), "");
}

TEST_F(BrokenTree, ACircleOfGroupsInTwoWingsIsReported) {
  write("scenes/cad/src/import/import.cpp", "#include \"models/plan.h\"\n");
  write("scenes/cad/include/vps_scenes/cad/import.h", "#pragma once\n");
  write("scenes/scene/src/models/plan.h", "#include \"vps_scenes/cad/import.h\"\n");
  const std::vector<std::string> circles = groupCircles(root(), "scenes");
  ASSERT_EQ(circles.size(), 1U);
  EXPECT_NE(circles[0].find("cad/import -> scene/models -> cad/import"), std::string::npos) << circles[0];
}

TEST_F(BrokenTree, AnIncludeOfAFolderAboveIsReported) {
  write("device/src/loop/loop.cpp", "#include \"vps_bullet/shape.h\"\n");
  write("plugin/src/mesh/mesh.cpp", "#include <btBulletDynamicsCommon.h>\n");
  const std::string text = joined(folderViolations(root()));
  EXPECT_NE(text.find("device/src/loop/loop.cpp:1"), std::string::npos) << text;
  EXPECT_NE(text.find("plugin/src/mesh/mesh.cpp:1"), std::string::npos) << text;
}

}  // namespace

}  // namespace vps::boundaries

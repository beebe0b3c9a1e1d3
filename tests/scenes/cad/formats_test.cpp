// SPDX-License-Identifier: BSD-3-Clause
// The table of CAD formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "import/formats.h"
#include "vps/errors.h"

namespace vps::scenes {
namespace {

TEST(CadFormats, EachExtensionBelongsToOneFormatInAnyCase) {
  std::set<std::string_view> seen;
  for (const import::FormatRow& row : import::formatRows())
    for (const std::string_view extension : row.extensions) {
      if (extension.empty()) continue;
      EXPECT_TRUE(seen.insert(extension).second) << extension;
      std::string capitals(extension);
      std::ranges::transform(capitals, capitals.begin(),
                             [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      EXPECT_EQ(import::formatOfExtension(extension), row.id) << extension;
      EXPECT_EQ(import::formatOfExtension(capitals), row.id) << extension;
      EXPECT_TRUE(isCadExtension("." + capitals)) << extension;
    }
  EXPECT_EQ(seen.size(), 20U);
}

TEST(CadFormats, OtherExtensionsAreNoCadFiles) {
  for (const char* extension : {"", ".", ".toml", ".mcap", ".vdb", ".st", ".step2"}) {
    EXPECT_FALSE(isCadExtension(extension)) << extension;
    EXPECT_EQ(import::formatOfExtension(extension), import::CadFormat::Other) << extension;
  }
}

// Reports and JSON have these names.
TEST(CadFormats, NamesAreStable) {
  std::vector<std::string> names;
  for (const import::FormatRow& row : import::formatRows()) names.emplace_back(row.name);
  EXPECT_EQ(names, (std::vector<std::string>{"STEP", "IGES", "BREP", "Inventor", "VRML", "3MF", "glTF", "DAE",
                                             "STL", "OBJ", "PLY", "OFF", "3DS", "X3D", "FBX", ""}));
}

TEST(CadFormats, AMissingUnitIsAnErrorThatNamesTheFormat) {
  const auto messageOf = [](import::FileFormat format) {
    try {
      import::unitOf("part.x", format, {});
    } catch (const LoadError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string remedy = "; set unit = \"mm\" in the scene or give --units mm";
  EXPECT_EQ(messageOf(import::CadFormat::Stl), "part.x: STL files do not state their unit" + remedy);
  EXPECT_EQ(messageOf(import::CadFormat::Brep), "part.x: BREP files do not state their unit" + remedy);
  EXPECT_EQ(messageOf(import::CadFormat::Fbx), "part.x: the unit of FBX files is not read" + remedy);
  ImportSettings millimetres;
  millimetres.unit_m = 1e-3;
  EXPECT_EQ(import::unitOf("part.x", import::CadFormat::Stl, millimetres), 1e-3);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The table of CAD formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>
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
  for (const char* known : {"step", "stp", "iges", "igs", "brep", "brp", "iv",  "wrl", "wrz", "3mf",
                            "gltf", "glb", "dae",  "stl", "obj",  "ply", "off", "3ds", "x3d", "fbx"})
    EXPECT_TRUE(seen.contains(known)) << known;
}

TEST(CadFormats, OtherExtensionsAreNoCadFiles) {
  for (const char* extension : {"", ".", ".toml", ".mcap", ".vdb", ".st", ".step2"}) {
    EXPECT_FALSE(isCadExtension(extension)) << extension;
    EXPECT_EQ(import::formatOfExtension(extension), import::CadFormat::Other) << extension;
  }
}

// Reports and JSON have these names.
TEST(CadFormats, NamesAreStable) {
  using import::CadFormat;
  const std::vector<std::pair<CadFormat, std::string>> known = {
      {CadFormat::Step, "STEP"},   {CadFormat::Iges, "IGES"},
      {CadFormat::Brep, "BREP"},   {CadFormat::Inventor, "Inventor"},
      {CadFormat::Vrml, "VRML"},   {CadFormat::ThreeMf, "3MF"},
      {CadFormat::Gltf, "glTF"},   {CadFormat::Collada, "DAE"},
      {CadFormat::Stl, "STL"},     {CadFormat::Obj, "OBJ"},
      {CadFormat::Ply, "PLY"},     {CadFormat::Off, "OFF"},
      {CadFormat::ThreeDs, "3DS"}, {CadFormat::X3d, "X3D"},
      {CadFormat::Fbx, "FBX"},     {CadFormat::Other, ""}};
  for (const auto& [format, name] : known) EXPECT_EQ(import::FileFormat(format).name, name);
  EXPECT_GE(import::formatRows().size(), known.size());
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

// SPDX-License-Identifier: BSD-3-Clause
// Triangles of 3MF files have their colours, of base materials and of colour groups.
#include "import/colors_3mf.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "support/temporary_folder.h"
#include "vps_scenes/import.h"

namespace vps::scenes::import {
namespace {

// A tetrahedron [mm] of which one face has a material, one a colour, one three colours, and one that of the
// object; and another one in one colour.
constexpr const char* kModel = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- <triangle v1="9"/> -->
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
 <resources>
  <basematerials id="1"><base name="red" displaycolor="#FF0000"/><base name="blue" displaycolor="#0000FFFF" /></basematerials>
  <m:colorgroup id="5"><m:color color="#00ff00"/><m:color color='#000000'/></m:colorgroup>
  <object id="2" type="model" pid="1" pindex="1" name="tip"><mesh>
   <vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/><vertex x="0" y="10" z="0"/>
    <vertex x="0" y="0" z="10"/></vertices>
   <triangles><triangle v1="0" v2="2" v3="1" pid="1" p1="0"/><triangle v1="0" v2="1" v3="3" pid="5" p1="0"/>
    <triangle v1="0" v2="3" v3="2" pid="5" p1="0" p2="0" p3="1"/><triangle v1="1" v2="2" v3="3"/></triangles>
  </mesh></object>
  <object id="3" type="model" pid="1" pindex="0"><mesh>
   <vertices><vertex x="0" y="0" z="0"/><vertex x="20" y="0" z="0"/><vertex x="0" y="20" z="0"/>
    <vertex x="0" y="0" z="20"/></vertices>
   <triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/>
    <triangle v1="1" v2="2" v3="3"/></triangles>
  </mesh></object>
 </resources>
 <build><item objectid="2"/><item objectid="3" transform="1 0 0 0 1 0 0 0 1 40 0 0"/></build>
</model>
)";
const std::vector<Color> kTruth = {{1, 0, 0}, {0, 1, 0}, {0, 2.0F / 3, 0}, {0, 0, 1}};

TEST(Colors3mf, AreOfTheTriangleOrElseOfTheObject) {
  const std::vector<Mesh3mf> meshes = meshes3mf(kModel);
  ASSERT_EQ(meshes.size(), 2U);
  EXPECT_EQ(meshes[0].vertices.size(), 4U);
  ASSERT_EQ(meshes[0].triangles.size(), 4U);
  EXPECT_EQ(meshes[0].triangles[2], (std::array<std::uint32_t, 3>{0, 3, 2}));
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_TRUE(meshes[0].colors[i]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((*meshes[0].colors[i])[k], kTruth[i][k], 1e-6) << i;
    EXPECT_EQ(meshes[1].colors[i], (Color{1, 0, 0}));
  }
}

TEST(Colors3mf, OfATextThatIsCutAnywhereEndInNothingWorse) {
  const std::string text = kModel;
  for (std::size_t size = 0; size < text.size(); ++size)
    for (const Mesh3mf& mesh : meshes3mf(std::string_view(text).substr(0, size)))
      EXPECT_EQ(mesh.colors.size(), mesh.triangles.size());
}

std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
  }
  return ~crc;
}

/// A zip archive whose files are stored as they are.
class Zip {
 public:
  void add(const std::string& name, const std::string& bytes) {
    std::string common;
    put<std::uint16_t>(common, {20, 0, 0, 0, 0x21});  // version, flags, stored, time, date
    put<std::uint32_t>(common, {crc32(bytes), std::uint32_t(bytes.size()), std::uint32_t(bytes.size())});
    put<std::uint16_t>(common, {std::uint16_t(name.size()), 0});
    std::string entry = "PK\x01\x02";
    put<std::uint16_t>(entry, {20});
    entry += common;
    put<std::uint16_t>(entry, {0, 0, 0});
    put<std::uint32_t>(entry, {0, std::uint32_t(files_.size())});
    directory_ += entry + name;
    files_ += "PK\x03\x04" + common + name + bytes;
    ++count_;
  }
  [[nodiscard]] std::string bytes() const {
    std::string end = "PK\x05\x06";
    put<std::uint16_t>(end, {0, 0, count_, count_});
    put<std::uint32_t>(end, {std::uint32_t(directory_.size()), std::uint32_t(files_.size())});
    put<std::uint16_t>(end, {0});
    return files_ + directory_ + end;
  }

 private:
  template <typename T>
  static void put(std::string& to, std::initializer_list<T> values) {
    for (const T& value : values) to.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string files_, directory_;
  std::uint16_t count_ = 0;
};

TEST(Colors3mf, ComeWithThePartsOfAFile) {
  Zip zip;
  zip.add(
      "[Content_Types].xml",
      R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
      R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
      R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)");
  zip.add(
      "_rels/.rels",
      R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
      R"(<Relationship Target="/3D/3dmodel.model" Id="rel0" )"
      R"(Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)");
  zip.add("3D/3dmodel.model", kModel);
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "two.3mf").string();
  std::ofstream(file, std::ios::binary) << zip.bytes();
  if (model3mf(file).empty()) GTEST_SKIP() << "its library is not built in";
  EXPECT_EQ(model3mf(file), kModel);
  ImportSettings settings;
  settings.unit_m = 1e-3;
  const ImportedCad cad = importCad(file, settings);
  ASSERT_EQ(cad.parts.size(), 2U);
  const auto& tip = cad.parts[0].face_colors.isNone() ? cad.parts[1] : cad.parts[0];
  const auto& plain = &tip == &cad.parts[0] ? cad.parts[1] : cad.parts[0];
  ASSERT_EQ(tip.face_colors.of_triangle.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(tip.face_colors.at(i)[k], kTruth[i][k], 1e-6) << i;
  EXPECT_TRUE(plain.face_colors.isNone());
  EXPECT_EQ(plain.color, (Color{1, 0, 0}));
}

}  // namespace
}  // namespace vps::scenes::import

// SPDX-License-Identifier: BSD-3-Clause
// 3MF: units, names, colours, poses and volumes are read correctly, whatever else the file has.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>
#include <utility>

#include "lib3mf/stored_archive.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

/// A box of `size` from the origin, in file units; its triangles have the `attributes`.
std::string boxMesh(const Vec3& size, const std::string& attributes = "") {
  const Mesh box = makeBox(size);
  std::string text = "<mesh><vertices>";
  for (const Vec3& p : box.vertices) {
    const Vec3 corner = p + size / 2;
    text += "<vertex x=\"" + std::to_string(corner.x()) + "\" y=\"" + std::to_string(corner.y()) + "\" z=\"" +
            std::to_string(corner.z()) + "\"/>\n";
  }
  text += "</vertices><triangles>";
  for (const auto& t : box.triangles)
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\"" + attributes + "/>\n";
  return text + "</triangles></mesh>";
}

/// A 3MF file whose elements can be changed: a plate 4 x 3 x 1 at the origin and a block 1 x 2 x 3 at (10, 0,
/// 0).
struct File3mf {
  std::string unit = " unit=\"millimeter\"", head, attributes;
  std::string before_resources;
  std::string resources;  ///< text before the objects
  std::string plate = "name=\"plate\"", block = "name=\"block\"";
  std::string triangles;  ///< attributes of the plate's triangles
  std::string more_objects;
  std::string items = R"(<item objectid="1"/><item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>)";
  std::string model = "3D/3dmodel.model";
  std::string relations, types;
  std::vector<std::pair<std::string, std::string>> files;
  std::size_t cut_bytes = 0;  ///< number of bytes that are cut off at the end of the model

  [[nodiscard]] std::string modelText() const {
    return R"(<?xml version="1.0" encoding="UTF-8"?>)" + head + "\n<model" + unit + attributes +
           R"( xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02")"
           R"( xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">)" +
           before_resources + "<resources>" + resources + "<object id=\"1\" type=\"model\" " + plate + ">" +
           boxMesh({4, 3, 1}, triangles) + "</object><object id=\"2\" type=\"model\" " + block + ">" +
           boxMesh({1, 2, 3}) + "</object>" + more_objects + "</resources><build>" + items +
           "</build></model>";
  }
  [[nodiscard]] std::string bytes() const {
    import::StoredArchive zip;
    zip.add(
        "[Content_Types].xml",
        R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
        R"(<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>)"
        R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>)" +
            types + "</Types>");
    zip.add(
        "_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
        R"(<Relationship Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target="/)" +
            model + "\"/>" + relations + "</Relationships>");
    const std::string text = modelText();
    zip.add(model, text.substr(0, text.size() - cut_bytes));
    for (const auto& [name, text] : files) zip.add(name, text);
    return std::move(zip).finish();
  }
};

struct Import3mf : testing::Test {
  ImportedCad read(const std::string& bytes, const ImportSettings& settings = {}) {
    const std::string file = (folder_.path() / "rig.3mf").string();
    std::ofstream(file, std::ios::binary) << bytes;
    return importCad(file, settings);
  }
  /// The text of the error for the file.
  std::string refusalOf(const File3mf& file) {
    try {
      read(file.bytes());
    } catch (const LoadError& e) {
      return e.what();
    }
    ADD_FAILURE() << "was read";
    return "";
  }
  /// Whether this build has lib3mf.
  bool canRead() {
    try {
      read(File3mf().bytes());
    } catch (const LoadError& e) {
      if (std::string(e.what()).find("build again") != std::string::npos) return false;
      throw;
    }
    return true;
  }
  test::TemporaryFolder folder_;
};

void expectPart(const ImportedPart& part, const std::string& name, double volume_m3, const Vec3& p_m,
                const std::string& what) {
  EXPECT_EQ(part.name, name) << what;
  EXPECT_NEAR(massProperties(part.mesh).volume_m3, volume_m3, 1e-5 * volume_m3) << what;
  EXPECT_LT((part.X_WP.p - p_m).norm(), 1e-6 * (p_m.norm() + 1e-9)) << what;
  EXPECT_TRUE(checkMesh(part.mesh).isClosed()) << what;
}

const Color kRed = {1, 0, 0}, kGray = ImportedPart().color;

void expectColor(const Color& found, const Color& truth, const std::string& what) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], truth[k], 1e-5) << what;
}

struct Oddity {
  std::string name;
  std::function<void(File3mf&)> change;
  std::string plate = "plate", block = "block";
  Color color = kGray;  ///< expected colour of the plate
  const char* has_remark = nullptr;
};

/// An object of two beams, without triangles.
std::string latticeObject(int id) {
  return "<object id=\"" + std::to_string(id) +
         R"(" type="model" name="lattice"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="0" y="9" z="0"/>)"
         R"(<vertex x="9" y="0" z="0"/></vertices><triangles/><b:beamlattice radius="0.5" minlength="0.001">)"
         R"(<b:beams><b:beam v1="0" v2="1"/><b:beam v1="1" v2="2"/></b:beams></b:beamlattice></mesh></object>)";
}

const std::vector<Oddity>& oddities() {
  static const std::vector<Oddity> all = {
      {"none", [](File3mf&) {}},
      {"a thumbnail",
       [](File3mf& f) {
         f.types = R"(<Default Extension="png" ContentType="image/png"/>)";
         f.relations =
             R"(<Relationship Id="rel1" Target="/Metadata/thumbnail.png" )"
             R"(Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail"/>)";
         f.files.emplace_back("Metadata/thumbnail.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16));
       }},
      {"a slicer's settings",
       [](File3mf& f) {
         f.attributes = R"( xmlns:slic3rpe="http://schemas.slic3r.org/3mf/2017/06")";
         f.before_resources =
             R"(<metadata name="slic3rpe:Version3mf">1</metadata><metadata name="Title">rig</metadata>)"
             R"(<metadata name="Application">PrusaSlicer-2.5.0</metadata><!-- <object id="7"/> -->)";
         f.triangles = R"( paint_color="8" slic3rpe:custom_supports="4")";
         f.items = R"(<item objectid="1" printable="1"/>)"
                   R"(<item objectid="2" transform="1 0 0 0 1 0 0 0 1 10 0 0" printable="1"/>)";
         f.types = R"(<Default Extension="config" ContentType="text/plain"/>)";
         f.files.emplace_back("Metadata/Slic3r_PE.config", "; layer_height = 0.2\n");
       }},
      {"metadata",
       [](File3mf& f) {
         f.head = "\n<!-- made by hand -->";
         f.attributes = " requiredextensions=\"m\"";
       }},
      {"base materials",
       [](File3mf& f) {
         f.resources = R"(<basematerials id="5"><base name="a" displaycolor="#0000FF"/>)"
                       R"(<base name="b" displaycolor="#FF0000FF"/></basematerials>)";
         f.plate += R"( pid="5" pindex="1")";
       },
       "plate", "block", kRed},
      {"a colour group",
       [](File3mf& f) {
         f.resources = R"(<m:colorgroup id="5"><m:color color="#FF0000"/></m:colorgroup>)";
         f.plate += R"( pid="5" pindex="0")";
         f.triangles = R"( pid="5" p1="0")";
       },
       "plate", "block", kRed},
      {"names with entities and of other scripts",
       [](File3mf& f) {
         f.plate = "name=\"a &amp; &lt;b&gt;\"";
         f.block = "name='\xe6\x9d\xbf'";
       },
       "a & <b>", "\xe6\x9d\xbf"},
      {"numbers for characters",
       [](File3mf& f) {
         f.plate = "name=\"W&#228;lz &#x3C;&#38;&#x1F600;&#10;\"";
         f.block = "name='&#26495;'";
       },
       "W\xc3\xa4lz <&\xf0\x9f\x98\x80", "\xe6\x9d\xbf"},
      {"beams that are needed, and no beams",
       [](File3mf& f) {
         f.attributes = R"( xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02")"
                        R"( requiredextensions="b")";
       }},
      {"numbers with exponents, signs and blanks",
       [](File3mf& f) {
         std::string box = boxMesh({1, 2, 3});
         for (const auto& [plain, odd] :
              {std::pair("\"1.000000\"", "\"+1.0e+00\""), std::pair("\"0.000000\"", "\" -0 \""),
               std::pair("\"2.000000\"", "\".2E1\"")})
           for (std::size_t at = 0; (at = box.find(plain)) != std::string::npos;)
             box.replace(at, std::string(plain).size(), odd);
         f.more_objects = R"(<object id="3" type="model" name="block">)" + box + "</object>";
         f.items = R"(<item objectid="1"/><item objectid="3" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>)";
       }},
      {"no names", [](File3mf& f) { f.plate = f.block = ""; }, "rig", "rig_2"},
      {"the same name twice", [](File3mf& f) { f.block = f.plate; }, "plate", "plate_2"},
      {"a part number", [](File3mf& f) { f.plate += " partnumber=\"P-17\""; }},
      {"another name of the model", [](File3mf& f) { f.model = "3D/rig.model"; }},
      {"a support",
       [](File3mf& f) {
         f.more_objects = R"(<object id="3" type="support" name="s">)" + boxMesh({1, 1, 1}) + "</object>";
         f.items += R"(<item objectid="3"/>)";
       },
       "plate", "block", kGray, "1 object is for printing only"},
      {"a component of type other",
       [](File3mf& f) {
         f.more_objects = R"(<object id="3" type="other" name="s">)" + boxMesh({1, 1, 1}) +
                          R"(</object><object id="4" type="model" name="block"><components>)"
                          R"(<component objectid="2"/><component objectid="3"/></components></object>)";
         f.items = R"(<item objectid="1"/><item objectid="4" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>)";
       },
       "plate", "block", kGray, "1 object is for printing only"},
      {"a beam lattice in addition to a mesh",
       [](File3mf& f) {
         f.attributes = R"( xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02")";
         f.more_objects = latticeObject(3);
         f.items += R"(<item objectid="3"/>)";
       },
       "plate", "block", kGray, "object 'lattice' has"},
      {"a colour's number that is not in the file",
       [](File3mf& f) {
         f.resources = R"(<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials>)";
         f.plate += R"( pid="5" pindex="7")";
       },
       "plate", "block", kGray, "missing in the file"},
      {"a triangle's colour that is not in the file",
       [](File3mf& f) {
         f.resources = R"(<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials>)";
         f.plate += R"( pid="5" pindex="0")";
         f.triangles = R"( pid="5" p1="9")";
       },
       "plate", "block", kRed, "missing in the file"},
      {"components",
       [](File3mf& f) {
         // One component rotates the object by 90 degrees about z, which moves (0, -10, 0) to (10, 0, 0), and
         // another component rotates it back.
         f.more_objects =
             R"(<object id="3" type="model"><components><component objectid="2" )"
             R"(transform="0 -1 0 1 0 0 0 0 1 0 -10 0"/></components></object>)"
             R"(<object id="4" type="model" name="rig"><components><component objectid="1"/>)"
             R"(<component objectid="3" transform="0 1 0 -1 0 0 0 0 1 0 0 0"/></components></object>)";
         f.items = R"(<item objectid="4"/>)";
       }},
      {"objects in files of their own",
       [](File3mf& f) {
         f.attributes = R"( xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06")"
                        R"( requiredextensions="p")";
         f.more_objects = R"(<object id="4" type="model" name="block"><components><component objectid="9" )"
                          R"(p:path="/3D/Objects/block.model"/></components></object>)";
         f.items = R"(<item objectid="1"/><item objectid="4" transform="1 0 0 0 1 0 0 0 1 10 0 0"/>)";
         f.files.emplace_back(
             "3D/Objects/block.model",
             R"(<?xml version="1.0"?><model)" + f.unit +
                 R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>)"
                 R"(<object id="9" type="model">)" +
                 boxMesh({1, 2, 3}) + "</object></resources><build/></model>");
         f.files.emplace_back(
             "3D/_rels/3dmodel.model.rels",
             R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
             R"(<Relationship Id="r1" Target="/3D/Objects/block.model" )"
             R"(Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)");
       }},
  };
  return all;
}

void change(const std::string& name, File3mf& file) {
  const auto found = std::ranges::find(oddities(), name, &Oddity::name);
  ASSERT_NE(found, oddities().end()) << name;
  found->change(file);
}

TEST_F(Import3mf, HasTheUnitsNamesColoursAndPlacesOfTheFile) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  const std::pair<const char*, double> units[] = {
      {"micron", 1e-6},  {"millimeter", 1e-3}, {"centimeter", 1e-2},
      {"inch", 25.4e-3}, {"foot", 0.3048},     {"meter", 1},
      {"", 1e-3}};
  for (const auto& [unit, unit_m] : units)
    for (const Oddity& oddity : oddities()) {
      const std::string what = oddity.name + " in " + unit;
      File3mf file;
      file.unit = *unit == '\0' ? "" : std::string(" unit=\"") + unit + "\"";
      oddity.change(file);
      try {
        const ImportedCad cad = read(file.bytes());
        ASSERT_EQ(cad.parts.size(), 2U) << what;
        EXPECT_TRUE(cad.states_unit) << what;
        const double scale_m3 = unit_m * unit_m * unit_m;
        expectPart(cad.parts[0], oddity.plate, 12 * scale_m3, Vec3::Zero(), what);
        expectPart(cad.parts[1], oddity.block, 6 * scale_m3, Vec3(10 * unit_m, 0, 0), what);
        EXPECT_LT((cad.parts[1].X_WP.R - Mat3::Identity()).norm(), 1e-6) << what;
        EXPECT_LT((bounds(cad.parts[1].mesh).size() - unit_m * Vec3(1, 2, 3)).norm(), 1e-5 * unit_m) << what;
        expectColor(cad.parts[0].color, oddity.color, what);
        expectColor(cad.parts[1].color, kGray, what);
        for (const std::string& warning : cad.warnings)
          EXPECT_TRUE((oddity.has_remark && warning.find(oddity.has_remark) != std::string::npos) ||
                      warning.find("check the unit") != std::string::npos ||
                      warning.find("whose 32-bit numbers") != std::string::npos)
              << what << ": " << warning;
      } catch (const LoadError& e) {
        ADD_FAILURE() << what << ": " << e.what();
      }
    }
}

// One face has a material, one a colour, one three colours, and one the colour of the object.
TEST_F(Import3mf, TrianglesHaveColoursOfTheirOwn) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  File3mf file;
  file.resources =
      R"(<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="blue" displaycolor="#0000FF"/>)"
      R"(</basematerials><m:colorgroup id="6"><m:color color="#00ff00"/><m:color color="#000000"/></m:colorgroup>)";
  file.more_objects =
      R"(<object id="3" type="model" pid="5" pindex="1" name="tip"><mesh><vertices><vertex x="0" y="0" z="0"/>)"
      R"(<vertex x="10" y="0" z="0"/><vertex x="0" y="10" z="0"/><vertex x="0" y="0" z="10"/></vertices><triangles>)"
      R"(<triangle v1="0" v2="2" v3="1" pid="5" p1="0"/><triangle v1="0" v2="1" v3="3" pid="6" p1="0"/>)"
      R"(<triangle v1="0" v2="3" v3="2" pid="6" p1="0" p2="0" p3="1"/><triangle v1="1" v2="2" v3="3"/>)"
      R"(</triangles></mesh></object>)";
  file.items = R"(<item objectid="3"/>)";
  const ImportedCad cad = read(file.bytes());
  ASSERT_EQ(cad.parts.size(), 1U);
  ASSERT_EQ(cad.parts[0].face_colors.of_triangle.size(), 4U);
  const std::vector<Color> truth = {{1, 0, 0}, {0, 1, 0}, {0, 2.0F / 3, 0}, {0, 0, 1}};
  for (std::size_t i = 0; i < 4; ++i)
    expectColor(cad.parts[0].face_colors.at(i), truth[i], std::to_string(i));
}

TEST_F(Import3mf, NamesOfAssembliesAreKnownToGroups) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  File3mf file;
  change("components", file);
  ImportedCad cad = read(file.bytes());
  EXPECT_EQ(cad.parts[0].within, (std::vector<std::string>{"rig", "plate"}));
  EXPECT_EQ(partGroups(cad, {.is_proposed = false, .names = {"rig"}}).at(0).parts.size(), 2U);
}

TEST_F(Import3mf, ABuildWithoutItemsIsRefusedInWords) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  File3mf file;
  file.items = "";
  EXPECT_NE(refusalOf(file).find("places no object"), std::string::npos);
}

TEST_F(Import3mf, TheUnitIsThatOfTheRootModel) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  const auto width_m = [](const ImportedCad& cad) { return bounds(cad.parts.at(0).mesh).size().x(); };
  const auto hasWarning = [](const ImportedCad& cad, const std::string& words) {
    return std::ranges::any_of(cad.warnings,
                               [&](const std::string& w) { return w.find(words) != std::string::npos; });
  };
  for (const auto& [root, other] : {std::pair(" unit=\"inch\"", ""), std::pair("", " unit=\"inch\"")}) {
    File3mf file;
    file.unit = other;
    change("objects in files of their own", file);
    file.unit = root;
    const ImportedCad cad = read(file.bytes());
    EXPECT_NEAR(width_m(cad), *root == '\0' ? 4e-3 : 4 * 25.4e-3, 1e-8);
    EXPECT_TRUE(hasWarning(cad, "in 3D/Objects/block.model"));
  }
  File3mf file;
  file.unit = " unit=\"furlong\"";
  const ImportedCad assumed = read(file.bytes());
  EXPECT_FALSE(assumed.states_unit);
  EXPECT_TRUE(hasWarning(assumed, "'furlong', which 3MF does not define: millimetres are assumed"));
  EXPECT_NEAR(width_m(assumed), 4e-3, 1e-9);
  ImportSettings settings;
  settings.unit_m = 1e-2;
  const ImportedCad given = read(file.bytes(), settings);
  EXPECT_FALSE(given.states_unit);
  EXPECT_NEAR(width_m(given), 4e-2, 1e-8);
}

TEST_F(Import3mf, WhatCannotBeReadIsRefusedInWords) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  File3mf extension;
  extension.attributes = R"( xmlns:x="http://example.com/extension" requiredextensions="x")";
  EXPECT_NE(refusalOf(extension).find("needs an extension of 3MF that is not read"), std::string::npos);
  File3mf beams;
  beams.attributes = R"( xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02")";
  beams.more_objects = latticeObject(3);
  beams.items = R"(<item objectid="3"/>)";
  EXPECT_NE(refusalOf(beams).find("places no object with a mesh"), std::string::npos);
  File3mf deep, many;  // 200 levels of components; 10^8 objects
  for (int id = 3; id < 203; ++id)
    deep.more_objects += "<object id=\"" + std::to_string(id) +
                         R"(" type="model"><components><component objectid=")" + std::to_string(id - 1) +
                         "\"/></components></object>";
  deep.items = R"(<item objectid="202"/>)";
  EXPECT_NE(refusalOf(deep).find("has more than 100 levels"), std::string::npos);
  for (int id = 3; id < 11; ++id) {
    many.more_objects += "<object id=\"" + std::to_string(id) + R"(" type="model"><components>)";
    for (int k = 0; k < 10; ++k)
      many.more_objects += "<component objectid=\"" + std::to_string(id - 1) + "\"/>";
    many.more_objects += "</components></object>";
  }
  many.items = R"(<item objectid="10"/>)";
  EXPECT_NE(refusalOf(many).find("places more than 200000 objects"), std::string::npos);
  beams.items = R"(<item objectid="1"/><item objectid="3"/>)";
  EXPECT_NE(read(beams.bytes()).missing.find("object 'lattice' has a lattice of 2 beams"), std::string::npos);
  beams.attributes += " requiredextensions=\"b\"";
  EXPECT_NE(refusalOf(beams).find("has a lattice of beams, which the file marks as required"),
            std::string::npos);
}

// lib3mf reads "4,5" and "4mm" as 4, and reads the objects before the end of a model that is cut.
TEST_F(Import3mf, FaultsThatTheLibraryReadsOverAreRefused) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  for (const char* number : {"4,5", "4mm", "4 5", "nan", "0x4", ""}) {
    File3mf file;
    file.more_objects =
        std::string(R"(<object id="3" type="model"><mesh><vertices><vertex x=")") + number +
        R"(" y="0" z="0"/><vertex x="9" y="0" z="0"/><vertex x="0" y="9" z="0"/></vertices>)" +
        R"(<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>)";
    EXPECT_NE(refusalOf(file).find("3D/3dmodel.model has a vertex with x = \"" + std::string(number) + '"'),
              std::string::npos)
        << number;
  }
  for (const std::size_t less : {1U, 9U, 20U, 60U}) {
    File3mf file;
    file.cut_bytes = less;
    EXPECT_NE(refusalOf(file).find("ends before its model does"), std::string::npos) << less;
  }
}

// Changes bytes of the archive, and bytes of the model within a valid archive.
TEST_F(Import3mf, ADamagedFileIsReadOrRefused) {
  if (!canRead()) GTEST_SKIP() << "its library is not built in";
  std::mt19937 random(1);
  const auto tryToRead = [&](const std::string& bytes, bool is_model_whole) {
    try {
      const ImportedCad cad = read(bytes);
      EXPECT_FALSE(cad.parts.empty());
      double volume_m3 = 0;
      for (const ImportedPart& part : cad.parts) volume_m3 += massProperties(part.mesh).volume_m3;
      if (is_model_whole) {
        EXPECT_NEAR(volume_m3, 18e-9, 1e-13);
      }
    } catch (const LoadError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  };
  File3mf file;
  change("components", file);
  change("a colour group", file);
  const std::string whole = file.bytes(), model = file.modelText();
  for (int i = 0; i < 60; ++i) {
    tryToRead(whole.substr(0, random() % whole.size()), true);
    std::string changed = whole;
    for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
    tryToRead(changed, true);  // the archive has checksums
    std::string text = model;
    const std::string digits = "-0123456789.\"<>e";
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = digits[random() % digits.size()];
    if (i % 3 == 0) text.resize(random() % text.size());
    import::StoredArchive zip;
    zip.add(
        "[Content_Types].xml",
        R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">)"
        R"(<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>)");
    zip.add(
        "_rels/.rels",
        R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
        R"(<Relationship Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" )"
        R"(Target="/3D/3dmodel.model"/></Relationships>)");
    zip.add("3D/3dmodel.model", text);
    tryToRead(std::move(zip).finish(), false);
  }
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/import.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include "vps/load_error.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

const fs::path kBlock = fs::path(VPS_SOURCE_DIR) / "scenes" / "bearing_block";

/// Where real exports lie, which are not ours to commit.
fs::path cadFolder() {
  const char* given = std::getenv("VPS_CAD_DIR");
  return given ? fs::path(given) : fs::path(VPS_SOURCE_DIR) / ".." / "shared" / "cad";
}

#define SKIP_WITHOUT(file) \
  if (!fs::exists(file)) GTEST_SKIP() << (file).string() << " is not here; set VPS_CAD_DIR"

ImportSettings inUnit(const std::string& unit) {
  ImportSettings settings;
  settings.unit_m = unitFromText(unit);
  return settings;
}

/// Imports, or skips where the format's library is not built in.
std::optional<ImportedCad> tryImport(const fs::path& file, const ImportSettings& settings = {}) {
  try {
    return importCad(file.string(), settings);
  } catch (const LoadError& e) {
    if (std::string(e.what()).find("build again") != std::string::npos) return std::nullopt;
    throw;
  }
}

#define IMPORT_OR_SKIP(name, ...)                                      \
  const auto imported_##name = tryImport(__VA_ARGS__);                 \
  if (!imported_##name) GTEST_SKIP() << "its library is not built in"; \
  const ImportedCad& name = *imported_##name

/// The bearing block's STEP, imported once: it takes a second.
const std::optional<ImportedCad>& stepBlock() {
  static const std::optional<ImportedCad> cad = tryImport(kBlock / "bearing_block.step");
  return cad;
}

const ImportedPart& partNamed(const ImportedCad& cad, const std::string& name) {
  for (const ImportedPart& part : cad.parts) {
    if (part.name == name) return part;
  }
  throw std::out_of_range("no part " + name);
}

std::string messageOf(const fs::path& file, const ImportSettings& settings = {}) {
  try {
    importCad(file.string(), settings);
  } catch (const LoadError& e) {
    return e.what();
  }
  return "";
}

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("vps_import_test_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

double volume(const ImportedPart& part) {
  return massProperties(part.mesh).volume_m3;
}

std::size_t closedCount(const ImportedCad& cad) {
  return std::size_t(std::count_if(cad.parts.begin(), cad.parts.end(),
                                   [](const ImportedPart& part) { return checkMesh(part.mesh).isClosed(); }));
}

/// A unit cube: 12 facets, outward. `offset` moves it along x.
std::string cubeObj(double scale, const std::string& name, int first = 1, double offset = 0) {
  std::string text = "o " + name + "\n";
  for (int i = 0; i < 8; ++i) {
    text += "v " + std::to_string(scale * (i & 1) + offset) + " " + std::to_string(scale * (i >> 1 & 1)) +
            " " + std::to_string(scale * (i >> 2)) + "\n";
  }
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    text += "f";
    for (const int i : q) text += " " + std::to_string(i + first);
    text += "\n";
  }
  return text;
}

TEST(Units, AreReadAndOthersRefused) {
  EXPECT_EQ(unitFromText("mm"), 1e-3);
  EXPECT_EQ(unitFromText("cm"), 1e-2);
  EXPECT_EQ(unitFromText("m"), 1.0);
  EXPECT_EQ(unitFromText("um"), 1e-6);
  EXPECT_EQ(unitFromText("inch"), 25.4e-3);
  EXPECT_FALSE(unitFromText("furlong"));
  EXPECT_FALSE(unitFromText(""));
}

TEST(Units, LengthsNeedTheirUnit) {
  EXPECT_DOUBLE_EQ(lengthFromText("0.2mm", "--voxel"), 0.2e-3);
  EXPECT_DOUBLE_EQ(lengthFromText("20um", "--voxel"), 20e-6);
  EXPECT_DOUBLE_EQ(lengthFromText("1e-2 m", "--voxel"), 0.01);
  for (const char* bad : {"0.2", "", "mm", "0.2 ells", "nan mm", "inf m", "0.2mm2"}) {
    try {
      lengthFromText(bad, "--voxel");
      ADD_FAILURE() << "'" << bad << "' was taken for a length";
    } catch (const LoadError& e) {
      EXPECT_EQ(std::string(e.what()).find("--voxel: "), 0u) << e.what();
    }
  }
}

struct Expected {
  const char* name;
  Vec3 p_mm;
};
const Expected kBlockParts[] = {
    {"housing", {0, 0, 0}},        {"bushing_lower", {0, 0, 10}}, {"shaft", {0, 0, 26}},
    {"bushing_upper", {0, 0, 34}}, {"key", {0, 21, 47}},          {"dowel_1", {-23, -18, 41.5}},
    {"dowel_2", {23, 18, 41.5}},   {"cover", {0, 0, 50}},         {"screw_1", {-23, 18, 53.6}},
    {"screw_2", {23, -18, 53.6}},
};

void expectBearingBlock(const ImportedCad& cad) {
  ASSERT_EQ(cad.parts.size(), std::size(kBlockParts));
  EXPECT_TRUE(cad.warnings.empty()) << cad.warnings.front();
  for (std::size_t i = 0; i < cad.parts.size(); ++i) {
    const ImportedPart& part = cad.parts[i];
    EXPECT_EQ(part.name, kBlockParts[i].name);
    // glTF keeps places as floats: 2^-24 of 60 mm is 4 nm.
    EXPECT_LT((part.X_WP.p - kBlockParts[i].p_mm * 1e-3).norm(), 1e-8) << part.name;
    EXPECT_LT((part.X_WP.R - Mat3::Identity()).norm(), 1e-6) << part.name;
    EXPECT_TRUE(checkMesh(part.mesh).isClosed()) << part.name;
    EXPECT_GT(volume(part), 0) << part.name;
  }
  const auto& bronze = partNamed(cad, "bushing_lower").color;
  // Linear RGB as modelled; STEP keeps sRGB to 12 digits, floats 7.
  EXPECT_NEAR(bronze[0], 0.52, 1e-5);
  EXPECT_NEAR(bronze[1], 0.26, 1e-5);
  EXPECT_NEAR(bronze[2], 0.06, 1e-5);
}

TEST(ImportStep, BearingBlockHasItsPartsNamesPosesAndColours) {
  if (!stepBlock()) GTEST_SKIP() << "Open CASCADE is not built in";
  const ImportedCad& cad = *stepBlock();
  EXPECT_EQ(cad.format, "STEP");
  expectBearingBlock(cad);
}

TEST(ImportGltf, BearingBlockHasItsPartsNamesPosesAndColours) {
  const ImportedCad cad = importCad((kBlock / "bearing_block.glb").string());
  EXPECT_EQ(cad.format, "glTF");
  expectBearingBlock(cad);
}

TEST(ImportGltf, DowelHasItsFormulasVolumeWithinTheTessellation) {
  const ImportedCad cad = importCad((kBlock / "bearing_block.glb").string());
  // Pin of radius r, length L; ends are frustums of axial length a down to radius r - c.
  const double r = 2e-3, L = 16e-3, c = 0.6e-3, a = c * std::sqrt(3.0), s = r - c;
  const double truth_m3 = EIGEN_PI * (r * r * (L - 2 * a) + 2 * a / 3 * (r * r + r * s + s * s));
  // Chords lie inside by at most 1 um, two thirds of it on average: the loss is below the lateral area times
  // 1 um.
  const double lateral_m2 = 2 * EIGEN_PI * r * L;
  const double found_m3 = volume(partNamed(cad, "dowel_1"));
  EXPECT_LT(found_m3, truth_m3);
  EXPECT_GT(found_m3, truth_m3 - lateral_m2 * 1e-6);
}

TEST(ImportStep, GivesTheSamePartsAsTheMeshes) {
  if (!stepBlock()) GTEST_SKIP() << "Open CASCADE is not built in";
  const ImportedCad& step = *stepBlock();
  const ImportedCad gltf = importCad((kBlock / "bearing_block.glb").string());
  ASSERT_EQ(step.parts.size(), gltf.parts.size());
  for (const ImportedPart& part : step.parts) {
    const ImportedPart& other = partNamed(gltf, part.name);
    // Same generator, same deflection; the rest is rounding to floats, 4 nm of the area.
    EXPECT_NEAR(volume(part), volume(other), area(part.mesh) * 4e-9) << part.name;
    const Box a = bounds(part.mesh), b = bounds(other.mesh);
    EXPECT_LT((a.min - b.min).norm() + (a.max - b.max).norm(), 1e-8) << part.name << ": another frame";
  }
}

TEST(ImportStep, ChordsStayWithinTheDeflection) {
  if (!stepBlock()) GTEST_SKIP() << "Open CASCADE is not built in";
  const ImportedCad& cad = *stepBlock();
  // Midpoints of the long bore edges of the lower bushing, radius 6.012: a chord's sagitta.
  const Mesh& mesh = partNamed(cad, "bushing_lower").mesh;
  double deepest_m = 0;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 &p = mesh.vertices[t[i]], &q = mesh.vertices[t[(i + 1) % 3]];
      const double radius_p_m = p.head<2>().norm(), radius_q_m = q.head<2>().norm();
      if (std::abs(radius_p_m - 6.012e-3) > 1e-8 || std::abs(radius_q_m - 6.012e-3) > 1e-8) continue;
      deepest_m = std::max(deepest_m, 6.012e-3 - (0.5 * (p + q)).head<2>().norm());
    }
  }
  EXPECT_GT(deepest_m, 0);
  EXPECT_LE(deepest_m, 1e-6);
}

TEST(ImportObj, NeedsAUnitAndNamesTheRemedy) {
  const Folder folder;
  const fs::path file = folder.write("cube.obj", cubeObj(10, "cube"));
  const std::string message = messageOf(file);
  EXPECT_NE(message.find("unit = \"mm\""), std::string::npos) << message;
  EXPECT_NE(message.find("--units mm"), std::string::npos) << message;
  const ImportedCad cad = importCad(file.string(), inUnit("mm"));
  ASSERT_EQ(cad.parts.size(), 1u);
  EXPECT_EQ(cad.parts[0].name, "cube");
  EXPECT_NEAR(volume(cad.parts[0]), 1e-6, 1e-12);  // float coordinates
}

TEST(ImportObj, ClosedObjectsAreParts) {
  const Folder folder;
  const fs::path file = folder.write("two.obj", cubeObj(1, "cube") + cubeObj(1, "other", 9, 5));
  const ImportedCad cad = importCad(file.string(), inUnit("m"));
  ASSERT_EQ(cad.parts.size(), 2u);
  EXPECT_EQ(cad.parts[0].name, "cube");
  EXPECT_EQ(cad.parts[1].name, "other");
}

TEST(ImportObj, FacesInGroupsOfTheirOwnAreOneClosedPart) {
  const Folder folder;
  std::string text;
  for (const char c : cubeObj(1, "all")) {
    if (c == 'f') text += "g face" + std::to_string(text.size()) + "\n";
    text += c;
  }
  const ImportedCad cad = importCad(folder.write("faces.obj", text).string(), inUnit("m"));
  ASSERT_EQ(cad.parts.size(), 1u);
  EXPECT_TRUE(checkMesh(cad.parts[0].mesh).isClosed());
}

TEST(ImportObj, InsideOutIsTurnedAndSaid) {
  const Folder folder;
  std::string text = cubeObj(1, "cube");
  for (std::size_t at = text.find("\nv "); at != std::string::npos; at = text.find("\nv ", at + 1)) {
    text.insert(at + 3, "-");  // mirrored in x: the same facets look inwards
  }
  const ImportedCad cad = importCad(folder.write("cube.obj", text).string(), inUnit("m"));
  EXPECT_NEAR(volume(cad.parts.at(0)), 1, 1e-6);
  ASSERT_EQ(cad.warnings.size(), 1u);
  EXPECT_NE(cad.warnings[0].find("inside out"), std::string::npos);
}

TEST(ImportInventor, TransformsUnitsMirrorsAndNamesAreKept) {
  const Folder folder;
  const fs::path file = folder.write("scene.iv",
                                     "#Inventor V2.1 ascii\n"
                                     "Separator { Units { units MILLIMETERS }\n"
                                     " DEF plate Separator { Translation { translation 10 20 30 }\n"
                                     "  RotationXYZ { axis Z angle 1.5707964 }\n"
                                     "  Material { diffuseColor 1 0 0 } Cube { width 1 height 2 depth 3 } }\n"
                                     " DEF mirrored Separator { Scale { scaleFactor -2 1 1 }\n"
                                     "  Cube { width 1 height 1 depth 1 } } }\n");
  IMPORT_OR_SKIP(cad, file, inUnit("inch"));  // the file's own unit wins
  ASSERT_EQ(cad.parts.size(), 2u);
  const ImportedPart& plate = partNamed(cad, "plate");
  EXPECT_LT((plate.X_WP.p - Vec3(0.01, 0.02, 0.03)).norm(), 1e-8);
  EXPECT_LT((plate.X_WP.R * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-6);
  EXPECT_LT((bounds(plate.mesh).size() - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-9);
  EXPECT_FLOAT_EQ(plate.color[0], 1);
  EXPECT_FLOAT_EQ(plate.color[1], 0);
  EXPECT_NEAR(volume(partNamed(cad, "mirrored")), 2e-9, 1e-14);
  EXPECT_TRUE(cad.warnings.empty());
}

TEST(ImportInventor, RepeatedNamesAreNumbered) {
  const Folder folder;
  const std::string pin = "DEF pin Separator { Translation { translation 0 0 9 } Cube {} }\n";
  IMPORT_OR_SKIP(cad, folder.write("pins.iv", "#Inventor V2.1 ascii\nGroup {" + pin + pin + pin + "}"));
  ASSERT_EQ(cad.parts.size(), 3u);
  EXPECT_EQ(cad.parts[0].name, "pin");
  EXPECT_EQ(cad.parts[1].name, "pin_2");
  EXPECT_EQ(cad.parts[2].name, "pin_3");
}

TEST(ImportInventor, AFaceWithAVertexThatIsNotThereIsRefused) {
  const Folder folder;
  for (const auto& [name, text] :
       {std::pair("face.iv",
                  "#Inventor V2.1 ascii\nSeparator { Coordinate3 { point [0 0 0, 1 0 0, 0 1 0] }\n"
                  "IndexedFaceSet { coordIndex [0, 1, 70000, -1] } }\n"),
        std::pair("strip.iv",
                  "#Inventor V2.1 ascii\nSeparator { Coordinate3 { point [0 0 0, 1 0 0, 0 1 0] }\n"
                  "TriangleStripSet { numVertices 90000 } }\n"),
        std::pair(
            "face.wrl",
            "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0] }\n"
            "coordIndex [0 1 70000 -1] } }\n")}) {
    EXPECT_NE(messageOf(folder.write(name, text)), "") << name;
  }
}

TEST(ImportVrml, WithoutUnitIsMetresAndSaid) {
  const Folder folder;
  const fs::path file = folder.write("box.wrl", "#VRML V2.0 utf8\nShape { geometry Box { size 1 2 3 } }\n");
  IMPORT_OR_SKIP(cad, file);
  EXPECT_NEAR(volume(cad.parts.at(0)), 6, 1e-5);
  ASSERT_EQ(cad.warnings.size(), 1u);
  EXPECT_NE(cad.warnings[0].find("metres"), std::string::npos);
  EXPECT_NEAR(volume(importCad(file.string(), inUnit("mm")).parts.at(0)), 6e-9, 1e-14);
}

TEST(ImportErrors, MissingEmptyFolderAndUnknownAreOneLine) {
  const Folder folder;
  const fs::path garbage_step = folder.write("garbage.step", "ISO-10303-21;\nwhat?\nEND-ISO-10303-21;\n");
  for (const fs::path& file :
       {folder.path() / "missing.step", folder.path(), folder.write("empty.stl", ""),
        folder.write("notes.md", "# Notes"), folder.write("a.step", "hello"), garbage_step,
        folder.write("b.stl", std::string(300, 'x')), folder.write("c.obj", "hello"),
        folder.write("d.iv", "hello"), folder.write("e.wrl", "#VRML V2.0 utf8\nShape { geometry Bo"),
        folder.write("f.glb", "glTF....")}) {
    const std::string message = messageOf(file, inUnit("mm"));
    EXPECT_EQ(message.find(file.string() + ": "), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(ImportErrors, ANumberThatIsNoneIsRefused) {
  const Folder folder;
  std::string text = cubeObj(1, "cube");
  text.replace(text.find("v ") + 2, 8, "nan");
  EXPECT_NE(messageOf(folder.write("nan.obj", text), inUnit("m")), "");
}

/// Cuts a file at many lengths: each cut is refused in words or gives parts that can be used; none crashes.
void expectCutsAreCalm(const fs::path& source, const std::string& name, bool may_give_parts) {
  const Folder folder;
  const std::string whole = contents(source);
  ASSERT_FALSE(whole.empty()) << source;
  for (const double share : {0.0005, 0.003, 0.02, 0.1, 0.31, 0.5, 0.77, 0.95, 0.999}) {
    const auto size = std::size_t(double(whole.size()) * share);
    const fs::path file = folder.write(name, whole.substr(0, size));
    try {
      const ImportedCad cad = importCad(file.string(), inUnit("mm"));
      EXPECT_TRUE(may_give_parts) << "half a file was taken for a whole one, " << size << " bytes";
      EXPECT_FALSE(cad.parts.empty());
    } catch (const LoadError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
}

TEST(ImportErrors, CutStepIsRefused) {
  expectCutsAreCalm(kBlock / "bearing_block.step", "cut.step", false);
}
TEST(ImportErrors, CutGltfIsRefused) {
  expectCutsAreCalm(kBlock / "bearing_block.glb", "cut.glb", false);
}

TEST(ImportErrors, CutStlIsRefused) {
  expectCutsAreCalm(fs::path(VPS_SOURCE_DIR) / "scenes" / "peg_in_hole" / "peg.stl", "cut.stl", false);
}

TEST(ImportErrors, CutObjNeverCrashes) {
  const Folder folder;
  expectCutsAreCalm(folder.write("whole.obj", cubeObj(10, "cube") + cubeObj(10, "other", 9, 20)), "cut.obj",
                    true);
}

/// A STEP file that ends as it should but whose middle is missing or scrambled.
TEST(ImportErrors, DamagedStepNeverCrashes) {
  const Folder folder;
  const std::string whole = contents(kBlock / "bearing_block.step");
  for (int i = 1; i < 12; ++i) {
    std::string damaged = whole;
    const std::size_t at = whole.size() * std::size_t(i) / 12;
    if (i % 2 == 0) {
      damaged.erase(at, 2000);
    } else {
      std::replace(damaged.begin() + std::ptrdiff_t(at), damaged.begin() + std::ptrdiff_t(at) + 1000, '#',
                   '9');
    }
    ImportSettings coarse;
    coarse.deflection_m = 1e-4;
    try {
      EXPECT_FALSE(importCad(folder.write("damaged.step", damaged).string(), coarse).parts.empty());
    } catch (const LoadError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
}

TEST(ImportReal, As1HasEighteenClosedSolidsInPlace) {
  const fs::path file = cadFolder() / "step-as1" / "as1-oc-214.stp";
  SKIP_WITHOUT(file);
  ImportSettings settings;
  settings.deflection_m = 20e-6;
  IMPORT_OR_SKIP(cad, file, settings);
  EXPECT_EQ(cad.parts.size(), 18u);
  EXPECT_EQ(closedCount(cad), 18u);
  // Two levels of sub-assemblies: the rod's first nut lies 175 mm along x.
  EXPECT_NEAR(partNamed(cad, "nut_1").X_WP.p.x(), 0.175, 1e-9);
  EXPECT_NEAR(partNamed(cad, "nut_2").X_WP.p.x(), 0.002, 1e-9);
}

TEST(ImportReal, Dm1HasSevenClosedSolids) {
  const fs::path file = cadFolder() / "step-as1" / "dm1-id-214.stp";
  SKIP_WITHOUT(file);
  ImportSettings settings;
  settings.deflection_m = 20e-6;
  IMPORT_OR_SKIP(cad, file, settings);
  EXPECT_EQ(cad.parts.size(), 7u);
  EXPECT_EQ(closedCount(cad), 7u);
}

TEST(ImportReal, InchMeshAndMillimetreStepOfOnePartAgreeInSize) {
  const fs::path mesh = cadFolder() / "cad-trimesh" / "featuretype.STL";
  const fs::path step = cadFolder() / "cad-trimesh" / "featuretype.STEP";
  SKIP_WITHOUT(mesh);
  IMPORT_OR_SKIP(exact, step);
  const ImportedCad inch = importCad(mesh.string(), inUnit("inch"));
  const Vec3 a = bounds(inch.parts.at(0).mesh).size(), b = bounds(exact.parts.at(0).mesh).size();
  EXPECT_LT((a - b).norm(), 1e-6);  // floats of 5 inch
}

TEST(ImportReal, InventorLatheHasFiftyParts) {
  const fs::path file = cadFolder() / "inventor-machines" / "lathe.iv";
  SKIP_WITHOUT(file);
  IMPORT_OR_SKIP(cad, file);
  EXPECT_EQ(cad.parts.size(), 50u);
}

TEST(ImportReal, VrmlOfCadIsClosedOnceItsFacesAreJoined) {
  for (const char* name : {"vrml-doublearm/hand_base.wrl", "vrml-doublearm/hand_body.wrl",
                           "kicad-pinheader/PinHeader_1x04_P2.54mm_Vertical.wrl"}) {
    const fs::path file = cadFolder() / name;
    SKIP_WITHOUT(file);
    IMPORT_OR_SKIP(cad, file);
    EXPECT_EQ(closedCount(cad), cad.parts.size()) << name;
  }
}

TEST(ImportReal, OpenMeshesAreImportedWithAWarning) {
  const fs::path file = cadFolder() / "thread-m16-loose" / "factory_nut_m16_loose_subdiv_3x.obj";
  SKIP_WITHOUT(file);
  const ImportedCad cad = importCad(file.string(), inUnit("m"));
  ASSERT_EQ(cad.parts.size(), 1u);
  ASSERT_FALSE(cad.warnings.empty());
  EXPECT_NE(cad.warnings[0].find("open edges"), std::string::npos);
}

}  // namespace
}  // namespace vps

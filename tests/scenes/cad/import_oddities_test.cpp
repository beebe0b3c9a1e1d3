// SPDX-License-Identifier: BSD-3-Clause
// Valid but unusual OBJ, STL and glTF files are read with the right sizes, names, colours and volumes. Tests
// of 3MF are in import_3mf_test.cpp, tests of STEP and IGES in tests/cad_faces.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>

#include "assimp/mesh_text.h"
#include "import/readers.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes {
namespace {

struct ImportOddities : testing::Test {
  std::string written(const std::string& name, const std::string& text) {
    const std::string file = (folder_.path() / name).string();
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  test::TemporaryFolder folder_;
};

void expectBox(const ImportedCad& cad, std::size_t index, const std::string& name, const Vec3& size_m,
               const std::string& what) {
  ASSERT_GT(cad.parts.size(), index) << what;
  const ImportedPart& part = cad.parts[index];
  EXPECT_EQ(part.name, name) << what;
  EXPECT_LT((bounds(part.mesh).size() - size_m).norm(), 1e-6 * size_m.norm()) << what;
  EXPECT_NEAR(massProperties(part.mesh).volume_m3, size_m.prod(), 1e-5 * size_m.prod()) << what;
  EXPECT_TRUE(checkMesh(part.mesh).isClosed()) << what;
}

std::string replacedAll(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// A box of 4 x 3 x 2 as OBJ; `first` is the number of its first vertex.
std::string boxObj(const std::string& head, int first = 1, double x = 0) {
  std::string text = head;
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(4 * (i & 1) + x) + " " + std::to_string(3.0 * (i >> 1 & 1)) + " " +
            std::to_string(2.0 * (i >> 2)) + "\n";
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& quad : quads) {
    text += "f";
    for (const int i : quad) text.append(" ").append(std::to_string(i + first));
    text += "\n";
  }
  return text;
}

TEST_F(ImportOddities, OfObjChangeNothing) {
  const std::string plain = boxObj("o box\n");
  struct Odd {
    std::string name, text, part = "box";
  };
  const std::vector<Odd> all = {
      {"none", plain},
      {"line ends of two bytes", replacedAll(plain, "\n", "\r\n")},
      {"comments and empty lines", "# made by hand\n\n" + replacedAll(plain, "\nf", "\n\n# face\nf")},
      {"a library of materials that is missing",
       "mtllib missing.mtl\n" + replacedAll(plain, "\nf", "\nusemtl red\nf")},
      {"smoothing groups", replacedAll(plain, "\nf", "\ns off\nf")},
      {"numbers from the end",
       replacedAll(replacedAll(replacedAll(replacedAll(plain, "f 1 3 4 2", "f -8 -6 -5 -7"), "f 5 6 8 7",
                                           "f -4 -3 -1 -2"),
                               "f 1 2 6 5", "f -8 -7 -3 -4"),
                   "f 3 7 8 4", "f -6 -2 -1 -5")},
      {"normals and textures",
       "vn 0 0 1\nvt 0 0\n" + replacedAll(replacedAll(plain, "f 1 3 4 2", "f 1/1/1 3/1/1 4/1/1 2/1/1"),
                                          "f 5 6 8 7", "f 5//1 6//1 8//1 7//1")},
      {"colours of vertices", replacedAll(plain, ".000000\n", ".000000 1 0 0\n")},
      {"blanks before and after", replacedAll(replacedAll(plain, "\nv ", "\n  v\t"), "\nf ", "\n\tf  ")},
      {"lines that go on in the next",
       replacedAll(replacedAll(plain, "f 1 3 4 2", "f 1 3\\\n 4 2"), "f 5 6 8 7", "f 5 6 \\\n8 7")},
      {"lines and points", plain + "l 1 2\np 3\n"},
      {"a vertex that nothing uses", "v 900 900 900\n" + boxObj("o box\n", 2)},
      {"numbers with exponents", replacedAll(plain, "4.000000", "4.0e+0")},
      {"a name with blanks", boxObj("o head  cap M8 \n"), "head  cap M8"},
      {"a group in place of an object", boxObj("g box\n")},
      {"groups of faces", replacedAll(plain, "\nf 5", "\ng side\nf 5"), "odd"},
      {"no name", boxObj(""), "odd"},
      {"two names of a group", boxObj("g box lid\n"), "box lid"},
      {"a byte order mark", "\xef\xbb\xbf" + plain},
      {"a byte order mark before a vertex", "\xef\xbb\xbf" + boxObj(""), "odd"},
      {"numbers that begin with the point",
       "vt .5 .5\nvn 0 0 -.9\n" +
           replacedAll(replacedAll(plain, "4.000000", ".4e1"), "f 1 3 4 2", "f 1/1/1 3/1/1 4/1/1 2/1/1")},
      {"keywords that begin like keywords of elements", plain + "lod 1\nparm u 0 \\\n1\nlod 2\n"},
  };
  for (const auto& [unit, unit_m] :
       {std::pair("mm", 1e-3), std::pair("inch", 25.4e-3), std::pair("cm", 1e-2)})
    for (const Odd& odd : all) {
      ImportSettings settings;
      settings.unit_m = unitFromText(unit);
      try {
        const ImportedCad cad = importCad(written("odd.obj", odd.text), settings);
        EXPECT_EQ(cad.parts.size(), 1U) << odd.name;
        expectBox(cad, 0, odd.part, unit_m * Vec3(4, 3, 2), odd.name);
        if (odd.name == "colours of vertices") {
          EXPECT_NEAR(cad.parts[0].color[0], 1, 1e-5);
          EXPECT_NEAR(cad.parts[0].color[1], 0, 1e-5);
        }
      } catch (const LoadError& e) {
        ADD_FAILURE() << odd.name << ": " << e.what();
      }
    }
}

TEST_F(ImportOddities, OfObjFreeFormSurfacesAreToldOf) {
  ImportSettings settings;
  settings.unit_m = 1e-3;
  const std::string file = written("odd.obj", boxObj("o box\n") +
                                                  "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\n"
                                                  "parm u 0 1\nparm v 0 1\nend\n");
  const ImportedCad cad = importCad(file, settings);
  expectBox(cad, 0, "box", 1e-3 * Vec3(4, 3, 2), file);
  ASSERT_EQ(cad.warnings.size(), 1U);
  EXPECT_EQ(cad.warnings[0], "has 1 free-form surface ('surf') that is not read; export triangles");
  EXPECT_EQ(cad.missing, cad.warnings[0]);
  EXPECT_EQ(
      importCad(std::vector<std::string>{file, written("sound.obj", boxObj("o box\n"))}, settings).missing,
      file + ": " + cad.missing);
}

TEST_F(ImportOddities, OfStlAByteOrderMarkChangesNothing) {
  const Mesh box = makeBox(Vec3(4, 3, 2));
  std::string text = "\xef\xbb\xbfsolid box\n";
  for (const auto& t : box.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t i : t) {
      text += "vertex";
      for (int k = 0; k < 3; ++k) text.append(" ").append(std::to_string(box.vertices[i][k]));
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  ImportSettings settings;
  settings.unit_m = 1e-3;
  expectBox(importCad(written("odd.stl", text + "endsolid\n"), settings), 0, "odd", 1e-3 * Vec3(4, 3, 2),
            "mark");
}

TEST_F(ImportOddities, OfObjSeveralObjectsAreOnePartOrSeveralAsAskedFor) {
  const std::string two = written("two.obj", boxObj("o left\n") + boxObj("o right\n", 9, 10));
  // Each of two groups has half of the faces, so that each is open and both together are closed.
  const std::string halves =
      written("halves.obj", replacedAll(boxObj("o left\n"), "\nf 3", "\no right\nf 3"));
  ImportSettings settings;
  settings.unit_m = 1e-3;
  const auto namesOf = [&](const std::string& file, PartPer per) {
    settings.part_per = per;
    std::string names;
    for (const ImportedPart& part : importCad(file, settings).parts) names += part.name + " ";
    return names;
  };
  EXPECT_EQ(namesOf(two, PartPer::Body), "left right ");
  EXPECT_EQ(namesOf(two, PartPer::Object), "left right ");
  EXPECT_EQ(namesOf(two, PartPer::File), "two ");
  EXPECT_EQ(namesOf(halves, PartPer::Body), "halves ");
  EXPECT_EQ(namesOf(halves, PartPer::Object), "left right ");
  EXPECT_EQ(namesOf(halves, PartPer::File), "halves ");
  settings.part_per = PartPer::File;
  const ImportedCad both = importCad(std::vector<std::string>{two, halves}, settings);
  ASSERT_EQ(both.parts.size(), 2U);
  EXPECT_NEAR(massProperties(both.parts[0].mesh).volume_m3, 48e-9, 1e-13);
  EXPECT_NEAR(bounds(both.parts[0].mesh).size().x(), 14e-3, 1e-8);
}

std::string base64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 3; ++k)
      value = value << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (int k = 3; k >= 0; --k)
      text += i + 3 - static_cast<std::size_t>(k) > bytes.size() ? '=' : kDigits[value >> (6 * k) & 63];
  }
  return text;
}

/// A box of 4 x 3 x 2 in glTF, as node 0; the other members of the JSON text can be given.
std::string boxGltf(const std::string& node = R"("name":"box")", const std::string& scene = "[0]",
                    const std::string& more_nodes = "", const std::string& primitive = "",
                    const std::string& members = "", bool has_indices = true) {
  const Mesh box = makeBox(Vec3(4, 3, 2));
  std::string bytes;
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  std::size_t count = 0;
  if (has_indices) {
    count = box.vertices.size();
    for (const Vec3& p : box.vertices)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(p[k]));
    for (const auto& t : box.triangles)
      for (const std::uint32_t i : t) put(static_cast<std::uint16_t>(i));
  } else {
    for (const auto& t : box.triangles)
      for (const std::uint32_t i : t)
        for (int k = 0; k < 3; ++k) put(static_cast<float>(box.vertices[i][k]));
    count = 3 * box.triangles.size();
  }
  const std::string at = std::to_string(count * 12), n = std::to_string(3 * box.triangles.size());
  const std::string views =
      R"("bufferViews":[{"buffer":0,"byteLength":)" + at + "}" +
      (has_indices ? R"(,{"buffer":0,"byteOffset":)" + at + R"(,"byteLength":)" +
                         std::to_string(bytes.size() - count * 12) + "}"
                   : "") +
      R"(],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","min":[-2,-1.5,-1],"max":[2,1.5,1],"count":)" +
      std::to_string(count) + "}" +
      (has_indices ? R"(,{"bufferView":1,"componentType":5123,"type":"SCALAR","count":)" + n + "}" : "") +
      "]";
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + scene + R"(}],"nodes":[{"mesh":0,)" +
         node + "}" + more_nodes + R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" +
         (has_indices ? R"(,"indices":1)" : "") + primitive + "}]}]," + views +
         R"(,"buffers":[{"byteLength":)" + std::to_string(bytes.size()) +
         R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + "\"}]" + members + "}";
}

TEST_F(ImportOddities, OfGltfChangeNothing) {
  struct Odd {
    std::string name, text, part = "box";
    double scale = 1;
    Color color = {1, 1, 1};  // colour of glTF's default material
  };
  const std::string red = R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}])";
  const std::vector<Odd> all = {
      {"none", boxGltf()},
      {"no name", boxGltf(R"("extras":{})"), "odd"},
      {"a name of another script", boxGltf("\"name\":\"\xe6\x9d\xbf\""), "\xe6\x9d\xbf"},
      {"an escaped name", boxGltf(R"("name":"\u00e4 \"x\"")"), "\xc3\xa4 \"x\""},
      {"a scale", boxGltf(R"("name":"box","scale":[0.001,0.001,0.001])"), "box", 1e-3},
      {"a matrix", boxGltf(R"("name":"box","matrix":[0.01,0,0,0,0,0.01,0,0,0,0,0.01,0,0,0,0,1])"), "box",
       1e-2},
      {"a node above",
       boxGltf(R"("name":"box")", "[1]", R"(,{"children":[0],"scale":[0.1,0.1,0.1],"name":"rig"})"), "box",
       0.1},
      {"a mirror", boxGltf(R"("name":"box","scale":[-1,1,1])")},
      {"a material", boxGltf(R"("name":"box")", "[0]", "", R"(,"material":0)", red), "box", 1, {1, 0, 0}},
      {"a camera", boxGltf(R"("name":"box")", "[0,1]", R"(,{"camera":0,"name":"eye"})", "",
                           R"(,"cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])")},
      {"an extension that nobody knows", boxGltf(R"("name":"box","extensions":{"MY_thing":{"a":1}})", "[0]",
                                                 "", "", R"(,"extensionsUsed":["MY_thing"])")},
      {"no indices", boxGltf(R"("name":"box")", "[0]", "", "", "", false)},
      {"an empty node", boxGltf(R"("name":"box")", "[0,1]", R"(,{"name":"nothing"})")},
      {"a byte order mark", "\xef\xbb\xbf" + boxGltf()},
      {"extensions that are needed and change no geometry",
       boxGltf(R"("name":"box")", "[0]", "", "",
               R"(,"extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"])")},
      {"an extension that is needed elsewhere",
       boxGltf(R"("name":"box","extras":{"extensionsRequired":["MY_thing"]})")},
  };
  for (const bool has_unit : {false, true})  // glTF does not use the unit of the settings
    for (const Odd& odd : all) {
      ImportSettings settings;
      if (has_unit) settings.unit_m = 25.4e-3;
      try {
        const ImportedCad cad = importCad(written("odd.gltf", odd.text), settings);
        EXPECT_EQ(cad.parts.size(), 1U) << odd.name;
        // y is up in glTF, and z in the imported parts.
        expectBox(cad, 0, odd.part, odd.scale * Vec3(4, 2, 3), odd.name);
        EXPECT_TRUE(cad.states_unit);
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(cad.parts.at(0).color[k], odd.color[k], 1e-5) << odd.name;
      } catch (const LoadError& e) {
        ADD_FAILURE() << odd.name << ": " << e.what();
      }
    }
}

// assimp reads 16-bit positions, instances in a buffer, and compressed meshes wrongly or not at all.
TEST_F(ImportOddities, OfGltfANeededExtensionThatIsNotReadIsRefused) {
  const std::string text = boxGltf(R"("name":"box")", "[0]", "", "",
                                   R"(,"extensionsRequired" : [ "KHR_materials_unlit", "MY_\"thing" ])");
  std::string glb = "glTF";
  const auto put = [&](std::size_t value) {
    for (int byte = 0; byte < 4; ++byte) glb += static_cast<char>(value >> (8 * byte) & 0xFF);
  };
  const std::string json = text + std::string(3 - (text.size() + 3) % 4, ' ');
  put(2);
  put(20 + json.size());
  put(json.size());
  glb += "JSON" + json;
  for (const auto& [name, bytes] : {std::pair("odd.gltf", text), std::pair("odd.glb", glb)}) try {
      importCad(written(name, bytes));
      ADD_FAILURE() << name;
    } catch (const LoadError& e) {
      EXPECT_NE(std::string(e.what()).find("needs the extension 'MY_"), std::string::npos) << e.what();
    }
  for (const char* cut :
       {"", "{", R"({"extensionsRequired)", R"({"extensionsRequired":["a\)", "]]}}", "\"\\"})
    EXPECT_LE(import::requiredExtensions(cut).size(), 1U) << cut;
  EXPECT_EQ(import::unreadExtension({"KHR_draco_mesh_compression", "KHR_lights_punctual"}), "");
  EXPECT_EQ(import::unreadExtension({"KHR_mesh_quantization"}), "KHR_mesh_quantization");
}

// Three blocks, each modelled about the origin, and at their poses in the assembly.
TEST_F(ImportOddities, FilesInFramesOfTheirOwnAreToldOf) {
  ImportSettings settings;
  settings.unit_m = 1e-3;
  const auto warningOf = [&](const std::vector<std::string>& files) {
    std::string found;
    for (const std::string& warning : importCad(files, settings).warnings)
      if (warning.find("frames of their own") != std::string::npos) found = warning;
    return found;
  };
  const std::string a = written("a.obj", boxObj("o a\n", 1, -2)),
                    b = written("b.obj", boxObj("o b\n", 1, -2)), c = written("c.obj", boxObj("o c\n")),
                    away = written("away.obj", boxObj("o away\n", 1, 4));
  EXPECT_NE(warningOf({a, b}).find("the 2 files seem to lie in frames of their own"), std::string::npos);
  EXPECT_NE(warningOf({a, b, c}).find("'pose'"), std::string::npos);
  EXPECT_EQ(warningOf({c, away}), "");     // side by side
  EXPECT_EQ(warningOf({a, b, away}), "");  // two parts clash, and a third is in its place
  EXPECT_EQ(warningOf({a}), "");
  // A pin in its sleeve, both about the z axis. The sleeve has a square hole.
  const std::string pin = written("pin.obj", boxObj("o pin\n", 1, -2));
  std::string wall;
  int first = 1;
  for (const double x : {-7.0, 3.0}) {
    wall += boxObj("", first, x);
    first += 8;
  }
  EXPECT_EQ(warningOf({pin, written("sleeve.obj", "o sleeve\n" + wall)}), "");
}

/// A cube of 10 mm; an open one lacks its last facets.
ImportedPart cubeAt(const Vec3& p_m, bool is_open = false) {
  ImportedPart part;
  part.name = "cube";
  part.mesh = makeBox(Vec3::Constant(0.01));
  if (is_open) part.mesh.triangles.pop_back();
  part.X_WP.p = p_m;
  return part;
}

// The number of computed distances is bounded for any number of parts.
TEST(OwnFrames, ManyPartsAndOpenOnesCostFewDistances) {
  constexpr int kSide = 26;
  const auto gridAt = [](double z_m, double step_m) {
    std::vector<ImportedPart> parts;
    for (int i = 0; i < kSide * kSide; ++i)
      parts.push_back(
          cubeAt({step_m * (i % kSide - 0.5 * (kSide - 1)), step_m * (i / kSide - 0.5 * (kSide - 1)), z_m}));
    return parts;
  };
  const auto warningOf = [](std::vector<ImportedPart> parts, const std::vector<ImportedPart>& others,
                            std::size_t& queries) {
    const std::size_t end = parts.size();
    parts.insert(parts.end(), others.begin(), others.end());
    queries = 0;
    return import::ownFramesWarning(parts, {end, parts.size()}, &queries);
  };
  std::size_t queries = 0;
  const std::vector<ImportedPart> grid = gridAt(0, 0.02);
  EXPECT_NE(warningOf(grid, grid, queries).find("frames of their own"), std::string::npos);
  EXPECT_LT(queries, 100U);
  EXPECT_EQ(warningOf(grid, gridAt(0.02, 0.02), queries), "");  // one grid above the other
  EXPECT_EQ(queries, 0U);
  EXPECT_EQ(warningOf(grid, gridAt(0.0095, 0.02), queries), "");  // each overlaps by 0.5 mm
  EXPECT_EQ(queries, 0U);
  // Open cubes have no inside.
  EXPECT_EQ(warningOf({cubeAt(Vec3::Zero(), true)}, {cubeAt(Vec3::Zero(), true)}, queries), "");
  EXPECT_EQ(queries, 0U);
  EXPECT_NE(warningOf({cubeAt(Vec3::Zero())}, {cubeAt(Vec3::Zero())}, queries), "");
}

TEST(MissingLibrary, IsKnownByItsWords) {
  for (const char* library : {"Open CASCADE", "Coin", "lib3mf"})
    EXPECT_TRUE(import::isMissingLibrary(import::missingLibrary("a.x", "X", library, "x-dev"))) << library;
  EXPECT_STREQ(import::missingLibrary("a.3mf", "3MF", "lib3mf", "lib3mf-dev").what(),
               "a.3mf: 3MF needs lib3mf, which this build lacks; install lib3mf-dev and build again");
  EXPECT_FALSE(import::isMissingLibrary(LoadError("a.step", "", "Open CASCADE crashed while reading it")));
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// OBJ, STL and PLY files with one oddity each: a block and an L-shaped plate of known size are read with the
// right unit, place, name and colour.
#include <cstdint>
#include <cstring>

#include "support/odd_files.h"

namespace vps::scenes::odd {
namespace {

class OddObj : public OddFiles {};
class OddStl : public OddFiles {};
class OddPly : public OddFiles {};

constexpr double kObjUnit_m = 1e-3;

std::string objNumber(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  return text.ends_with('.') ? text + "0" : text;
}

/// Vertices and triangles; `first` is the number of the first vertex.
std::string objOf(const Mesh& mesh, std::size_t first, const std::string& color = "") {
  std::string text;
  for (const Vec3& p : mesh.vertices)
    text += "v " + objNumber(p.x()) + " " + objNumber(p.y()) + " " + objNumber(p.z()) + color + "\n";
  for (const auto& t : mesh.triangles) {
    text += "f";
    for (const std::uint32_t i : t) text.append(" ").append(std::to_string(i + first));
    text += "\n";
  }
  return text;
}
std::string objRig(const std::string& block = "o block\n", const std::string& ell = "o ell\n",
                   const std::string& red = "", const std::string& blue = "") {
  return block + objOf(oddBlockMesh(), 1, red) + ell + objOf(oddEllMesh(100), 9, blue);
}
/// The faces of the rig with numbers that count from the end.
std::string objFromEnd() {
  std::string text;
  for (const auto& [name, mesh] : {std::pair("block", oddBlockMesh()), std::pair("ell", oddEllMesh(100))}) {
    text += std::string("o ") + name + "\n" + objOf(mesh, 1).substr(0, objOf(mesh, 1).find("f "));
    for (const auto& t : mesh.triangles) {
      text += "f";
      for (const std::uint32_t i : t) text += " -" + std::to_string(mesh.vertices.size() - i);
      text += "\n";
    }
  }
  return text;
}
/// All vertices before all faces, as many exporters write, and the L as two hexagons and six rectangles.
std::string objPolygons() {
  const Mesh block = oddBlockMesh(), ell = oddEllMesh(100);
  const std::string a = objOf(block, 1), b = objOf(ell, 9);
  std::string text = a.substr(0, a.find("f ")) + b.substr(0, b.find("f ")) + "o block\n" +
                     a.substr(a.find("f ")) + "o ell\nf 14 13 12 11 10 9\nf 15 16 17 18 19 20\n";
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    text += "f " + std::to_string(9 + i) + " " + std::to_string(9 + next) + " " + std::to_string(15 + next) +
            " " + std::to_string(15 + i) + "\n";
  }
  return text;
}

std::vector<OddPart> objParts(double unit_m = kObjUnit_m, std::optional<Color> red = {},
                              std::optional<Color> blue = {}) {
  return {oddBlock(unit_m, "block", red), oddEll(unit_m, "ell", blue)};
}

TEST_F(OddObj, FilesAreReadAsTheyAreMeant) {
  const std::string rig = objRig();
  const std::string materials = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nd 0.5\n";
  const std::string colored = "mtllib rig.mtl\n" + objRig("o block\nusemtl red\n", "o ell\nusemtl blue\n");
  const std::optional<Color> red = kRed, blue = kBlue;
  std::vector<OddFile> all = {
      {"none", rig, objParts()},
      {"line ends of two bytes", replacedAll(rig, "\n", "\r\n"), objParts()},
      {"line ends of old computers", replacedAll(rig, "\n", "\r"), objParts()},
      {"no line end at the end", rig.substr(0, rig.size() - 1), objParts()},
      {"tabs", replacedAll(replacedAll(rig, "v ", "v\t"), " 0.0", "\t0.0"), objParts()},
      {"two blanks", replacedAll(rig, " ", "  "), objParts()},
      {"blanks at the end of lines", replacedAll(rig, "\n", "  \n"), objParts()},
      {"comments", "# by hand\n" + replacedAll(rig, "\nf", "\n# a face\nf"), objParts()},
      {"comments behind numbers", replacedAll(rig, "\no ", " # end\no "), objParts()},
      {"a comment of another encoding",
       "# Gr\xf6\xdf"
       "e\n" +
           rig,
       objParts()},
      {"a byte order mark", "\xef\xbb\xbf" + rig, objParts()},
      {"numbers from the end", objFromEnd(), objParts()},
      {"polygons that are not convex", objPolygons(), objParts()},
      {"normals", replacedAll("vn 0 0 1\n" + replacedAll(rig, "f 1 ", "f 1//1 "), "f 1//1 ", "f 1 "),
       objParts()},
      {"lines that go on", replacedAll(rig, "f 1 ", "f 1 \\\n "), objParts()},
      {"groups in place of objects", objRig("g block\n", "g ell\n"), objParts()},
      {"groups within objects",
       objRig("o block\ng a\n", "o ell\ng b\n"),
       {oddBlock(1e-3, "a"), oddEll(1e-3, "b")}},
      {"empty objects before", "o nothing\ng\n" + rig, objParts()},
      {"an empty object behind", rig + "o nothing\n", objParts()},
      {"a library that is missing",
       "mtllib gone.mtl\n" + objRig("o block\nusemtl red\n", "o ell\nusemtl blue\n"), objParts()},
      {"materials", colored, objParts(1e-3, red, blue), "", false, "", {}, {{"rig.mtl", materials}}},
      {"materials with line ends of two bytes",
       colored,
       objParts(1e-3, red, blue),
       "",
       false,
       "",
       {},
       {{"rig.mtl", replacedAll(materials, "\n", "\r\n")}}},
      {"materials whose picture is missing",
       colored,
       objParts(1e-3, red, blue),
       "",
       false,
       "",
       {},
       {{"rig.mtl", replacedAll(materials, "Kd 1 0 0", "Kd 1 0 0\nmap_Kd gone.png")}}},
      {"materials in a file with blanks in its name",
       replacedAll(colored, "rig.mtl", "my rig.mtl"),
       objParts(1e-3, red, blue),
       "",
       false,
       "",
       {},
       {{"my rig.mtl", materials}}},
      {"materials with a byte order mark",
       colored,
       objParts(1e-3, red, blue),
       "",
       false,
       "",
       {},
       {{"rig.mtl", "\xef\xbb\xbf" + materials}}},
      {"a material that is not in the library",
       replacedAll(colored, "usemtl blue", "usemtl gone"),
       objParts(1e-3, red),
       "",
       false,
       "",
       {},
       {{"rig.mtl", materials}}},
      {"colours of vertices", objRig("o block\n", "o ell\n", " 1.0 0.0 0.0", " 0.0 0.0 1.0"),
       objParts(1e-3, red, blue)},
      {"weights of vertices", objRig("o block\n", "o ell\n", " 1.0", " 1.0"), objParts()},
      {"texture points of one and three numbers", "vt 0.5\nvt 0.5 0.5 0.0\n" + rig, objParts()},
      {"smoothing and merging groups", replacedAll(rig, "\no ", "\ns 1\nmg off\no "), objParts()},
      {"points and lines", rig + "p 1\nl 1 2 3\n", objParts()},
      {"signs and exponents", replacedAll(replacedAll(rig, " 10.0", " +1.0E+01"), " 20.0", " 2e1"),
       objParts()},
      {"numbers without a point", replacedAll(rig, ".0", ""), objParts()},
      {"many digits", replacedAll(rig, ".0", ".000000000000000000000"), objParts()},
      {"a name with slashes and quotes",
       objRig("o a/b\\c \"d\"\n"),
       {oddBlock(1e-3, "a/b\\c \"d\""), oddEll(1e-3)}},
      {"a name of another script",
       objRig("o \xe6\x9d\xbf\n"),
       {oddBlock(1e-3, "\xe6\x9d\xbf"), oddEll(1e-3)}},
      {"a name of another encoding",
       objRig("o W\xe4lz\n"),
       {oddBlock(1e-3, "W\xef\xbf\xbdlz"), oddEll(1e-3)}},
      {"equal names", objRig("o block\n", "o block\n"), {oddBlock(1e-3), oddEll(1e-3, "block_2")}},
      {"no names", objRig("o\n", "o\n"), {oddBlock(1e-3, "odd"), oddEll(1e-3, "odd_2")}},
      {"a long name",
       objRig("o " + std::string(300, 'n') + "\n"),
       {oddBlock(1e-3, std::string(300, 'n')), oddEll(1e-3)}},
      {"a name with a sharp", objRig("o block #3\n"), {oddBlock(1e-3, "block #3"), oddEll(1e-3)}},
      {"an extension in capitals", rig, objParts(), "", false, "ODD.OBJ"},
      {"a file name with blanks and umlauts", rig, objParts(), "", false, "odd \xc3\xa4 (1).obj"},
      {"a triangle twice the same corner", rig + "f 1 1 2\n", objParts()},
      {"inside out",
       [] {
         Mesh m = oddBlockMesh();
         for (auto& t : m.triangles) std::swap(t[0], t[1]);
         return "o block\n" + objOf(m, 1);
       }(),
       {oddBlock(1e-3)},
       "",
       true},
      {"numbers that are vertices of later lines",
       "o block\n" + objOf(oddBlockMesh(), 1).substr(objOf(oddBlockMesh(), 1).find("f ")) +
           objOf(oddBlockMesh(), 1).substr(0, objOf(oddBlockMesh(), 1).find("f ")),
       {oddBlock(1e-3)}},
  };
  for (OddFile& odd : all) odd.unit_m = 1e-3;
  for (const double unit_m : {1e-6, 1e-2, 25.4e-3, 0.3048, 1.0})
    all.push_back({"a unit of " + std::to_string(unit_m), rig, objParts(unit_m), "", false, "", unit_m});
  // What is lost is told.
  all.push_back({"no unit", rig, {}, "do not state their unit"});
  for (const auto& [oddity, text, lost] :
       {std::tuple("a corner that is not there", rig + "f 1 2 99\n", "vertex"),
        std::tuple("no faces", rig.substr(0, rig.find("f ")), "no surfaces"),
        std::tuple("a coordinate that is no number", replacedOnce(rig, "v 10.0", "v nan"),
                   "is not a number")})
    all.push_back({oddity, text, {}, lost, false, "", 1e-3});
  expectAll(all, "odd.obj");
}

std::string asciiStl(const Mesh& mesh, const std::string& head) {
  std::string text = head + "\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const std::uint32_t i : t) {
      const Vec3& p = mesh.vertices[i];
      text += "  vertex " + objNumber(p.x()) + " " + objNumber(p.y()) + " " + objNumber(p.z()) + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}
std::string binaryStl(const Mesh& mesh, std::string head, std::uint16_t attribute = 0) {
  head.resize(80, ' ');
  const auto put = [&](auto value) { head.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0F);
    for (const std::uint32_t i : t)
      for (int k = 0; k < 3; ++k) put(static_cast<float>(mesh.vertices[i][k]));
    put(attribute);
  }
  return head;
}

TEST_F(OddStl, FilesAreReadAsTheyAreMeant) {
  const Mesh block = oddBlockMesh();
  const std::string text = asciiStl(block, "solid block");
  const std::vector<OddPart> truth = {oddBlock(1e-3, "odd")};
  std::vector<OddFile> all = {
      {"none", text, truth},
      {"capitals",
       replacedAll(replacedAll(replacedAll(replacedAll(replacedAll(text, "solid", "SOLID"), "facet normal",
                                                       "FACET NORMAL"),
                                           "vertex", "VERTEX"),
                               "outer loop", "OUTER LOOP"),
                   "endloop\nendfacet", "ENDLOOP\nENDFACET"),
       truth},
      {"a header in capitals", replacedAll(text, "solid", "SOLID"), truth},
      {"an extension in capitals", text, {oddBlock(1e-3, "ODD")}, "", false, "ODD.STL"},
      {"line ends of two bytes", replacedAll(text, "\n", "\r\n"), truth},
      {"tabs", replacedAll(text, " ", "\t"), truth},
      {"no name", asciiStl(block, "solid"), truth},
      {"a long name", asciiStl(block, "solid " + std::string(2000, 'n')), truth},
      {"a name that is a keyword", asciiStl(block, "solid facet"), truth},
      {"exponents", replacedAll(replacedAll(text, "10.0", "1.000000E+001"), "20.0", "2e1"), truth},
      {"blank lines at the end", text + std::string(3000, '\n'), truth},
      {"blank lines before", "\n \n" + text, truth},
      {"binary", binaryStl(block, "made by hand"), truth},
      {"binary that begins with solid", binaryStl(block, "solid block"), truth},
      {"binary with attributes", binaryStl(block, "x", 7), truth},
      {"binary with bytes behind", binaryStl(block, "x") + "end", truth},
      {"binary that begins with SOLID in capitals", binaryStl(block, "SOLID facet"), truth},
      {"binary that begins with solid and facet", binaryStl(block, "solid facet"), truth},
      {"cut", text.substr(0, 600), {}, "truncated"},
      {"binary that is cut", binaryStl(block, "x").substr(0, 300), {}, "truncated"},
  };
  for (OddFile& odd : all) odd.unit_m = 1e-3;
  expectAll(all, "odd.stl");
}

struct PlyForm {
  std::string coordinate = "float", more_of_vertex = {}, count = "uchar", index = "int";
  bool is_big = false;
};
std::string plyText(const Mesh& mesh, const PlyForm& form, bool is_ascii,
                    const std::string& vertex_end = "") {
  std::string text = std::string("ply\nformat ") +
                     (is_ascii      ? "ascii"
                      : form.is_big ? "binary_big_endian"
                                    : "binary_little_endian") +
                     " 1.0\ncomment made by hand\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + form.coordinate + " " + axis + "\n";
  text += form.more_of_vertex + "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list " +
          form.count + " " + form.index + " vertex_indices\nend_header\n";
  const auto put = [&](auto value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    text += form.is_big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
  };
  for (const Vec3& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      if (is_ascii)
        text += objNumber(p[k]) + " ";
      else if (form.coordinate == "double" || form.coordinate == "float64")
        put(p[k]);
      else
        put(static_cast<float>(p[k]));
    }
    text += vertex_end;
    if (is_ascii) text += "\n";
  }
  for (const auto& t : mesh.triangles) {
    if (is_ascii)
      text += "3";
    else
      put(static_cast<std::uint8_t>(3));
    for (const std::uint32_t i : t) {
      if (is_ascii)
        text.append(" ").append(std::to_string(i));
      else if (form.index == "ushort")
        put(static_cast<std::uint16_t>(i));
      else if (form.index == "uchar")
        put(static_cast<std::uint8_t>(i));
      else
        put(i);
    }
    if (is_ascii) text += "\n";
  }
  return text;
}

TEST_F(OddPly, FilesAreReadAsTheyAreMeant) {
  const Mesh block = oddBlockMesh();
  const std::vector<OddPart> truth = {oddBlock(1e-3, "odd")};
  const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                    text = plyText(block, {}, true);
  std::vector<OddFile> all = {
      {"none", text, truth},
      {"line ends of two bytes", replacedAll(text, "\n", "\r\n"), truth},
      {"comments and information", replacedAll(text, "element", "comment x\nobj_info made by hand\nelement"),
       truth},
      {"another name of the list", replacedAll(text, "vertex_indices", "vertex_index"), truth},
      {"names of types with their size", plyText(block, {"float32", "", "uint8", "int32"}, true), truth},
      {"doubles", plyText(block, {"double"}, true), truth},
      {"an element that nobody knows",
       replacedOnce(text, "end_header", "element my_thing 1\nproperty int a\nend_header") + "7\n", truth},
      {"colours", plyText(block, {"float", colors}, true, "255 0 0"), {oddBlock(1e-3, "odd", kRed)}},
      {"colours and opacity",
       plyText(block, {"float", colors + "property uchar alpha\n"}, true, "0 255 0 255"),
       {oddBlock(1e-3, "odd", kGreen)}},
      {"normals",
       plyText(block, {"float", "property float nx\nproperty float ny\nproperty float nz\n"}, true, "0 0 1"),
       truth},
      {"properties that nobody knows",
       plyText(block, {"float", "property float quality\nproperty uchar flags\n"}, true, "0.5 3"), truth},
      {"an extension in capitals", text, {oddBlock(1e-3, "ODD")}, "", false, "ODD.PLY"},
      {"edges",
       replacedOnce(text, "end_header",
                    "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header") +
           "0 1\n",
       truth},
  };
  for (const bool is_big : {false, true}) {
    const std::string which = is_big ? "binary, big: " : "binary, little: ";
    all.push_back({which + "floats", plyText(block, {"float", "", "uchar", "int", is_big}, false), truth});
    all.push_back({which + "doubles", plyText(block, {"double", "", "uchar", "uint", is_big}, false), truth});
    all.push_back(
        {which + "short indices", plyText(block, {"float", "", "uchar", "ushort", is_big}, false), truth});
    all.push_back(
        {which + "indices of a byte", plyText(block, {"float", "", "uchar", "uchar", is_big}, false), truth});
    all.push_back(
        {which + "colours",
         plyText(block, {"float", colors, "uchar", "int", is_big}, false, std::string("\xff\0\0", 3)),
         {oddBlock(1e-3, "odd", kRed)}});
  }
  for (OddFile& odd : all) odd.unit_m = 1e-3;
  expectAll(all, "odd.ply");
}

}  // namespace
}  // namespace vps::scenes::odd

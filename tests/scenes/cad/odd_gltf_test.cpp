// SPDX-License-Identifier: BSD-3-Clause
// glTF and Collada files with one oddity each: a block and an L-shaped plate of known size are read with the
// right unit, place, name and colour.
#include <cstdint>
#include <cstring>
#include <functional>

#include "support/odd_files.h"

namespace vps::scenes::odd {
namespace {

class OddGltf : public OddFiles {};
class OddCollada : public OddFiles {};

std::string gltfBase64(const std::string& bytes) {
  static const char* const kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 3; ++k)
      value = value << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 4; k-- > 0;) text += i + 3 - k > bytes.size() ? '=' : kDigits[value >> (6 * k) & 63];
  }
  return text;
}

template <class T>
void putBytes(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A glTF file of the two parts, whose members can be changed. glTF is in metres and has y up, so that the
/// parts' (x, y, z) are (x, z, -y) of the file.
struct GltfFile {
  std::string block = R"("name":"block")", ell = R"("name":"ell","translation":[100,0,0])";
  std::string scene = "[0,1]", more_nodes, more_primitive, ell_primitive, members;
  std::string attributes = R"("POSITION":0)";
  std::string accessor;     ///< more members of the block's positions
  int index_bytes = 2;      ///< 1, 2 or 4; 0: no indices
  std::size_t stride = 12;  ///< bytes from a position to the next
  std::size_t offset = 0;   ///< bytes before the first position
  int mode = 4;             ///< of the block: 4 triangles, 5 strip, 6 fan
  std::string uri;          ///< of the buffer; empty: it is in the text
  std::string buffer;       ///< the bytes, made by json()
  bool has_positions_view = true, is_binary = false;
  double scale = 1;

  std::string json() {
    buffer.clear();
    std::string views, accessors;
    int view = 0, accessor_number = 0;
    std::string primitives[2];
    int number = 0;
    for (const Mesh& mesh : {oddBlockMesh(), oddEllMesh()}) {
      std::vector<std::uint32_t> order;
      for (const auto& t : mesh.triangles) order.insert(order.end(), t.begin(), t.end());
      std::vector<Vec3> points = mesh.vertices;
      int this_mode = 4;
      if (number == 0 && mode != 4) {
        // A strip through all triangles: two corners of each are repeated, so that two triangles without area
        // lie between them. A fan has the triangles of the three faces at one corner; the other three are a
        // second fan.
        this_mode = mode;
        std::vector<std::uint32_t> strip;
        for (std::size_t k = 0; k < order.size(); k += 3) {
          if (!strip.empty()) strip.insert(strip.end(), {strip.back(), order[k]});
          if (strip.size() % 2 == 1) strip.push_back(order[k]);
          strip.insert(strip.end(), {order[k], order[k + 1], order[k + 2]});
        }
        order = strip;
      }
      if (index_bytes == 0) {
        points.clear();
        for (const std::uint32_t i : order) points.push_back(mesh.vertices[i]);
      }
      while (buffer.size() % 4 != 0) buffer += '\0';
      const std::size_t from = buffer.size();
      Vec3 low = Vec3::Constant(1e9), high = -low;
      buffer.append(offset, 'x');
      for (const Vec3& p : points) {
        const Vec3 q(scale * p.x(), scale * p.z(), -scale * p.y());
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
        for (int k = 0; k < 3; ++k) putBytes(buffer, static_cast<float>(q[k]));
        buffer.append(stride - 12, 'y');
      }
      const auto list = [](const Vec3& p) {
        return "[" + std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) + "]";
      };
      const auto addView = [&](std::size_t at, const std::string& more) {
        views += (views.empty() ? "" : ",") + std::string(R"({"buffer":0,"byteOffset":)") +
                 std::to_string(at) + R"(,"byteLength":)" + std::to_string(buffer.size() - at) + more + "}";
        return std::to_string(view++);
      };
      const std::string positions =
          addView(from, stride == 12 ? "" : R"(,"byteStride":)" + std::to_string(stride));
      accessors += (accessors.empty() ? "" : ",") + std::string(R"({"bufferView":)") + positions +
                   (offset > 0 ? R"(,"byteOffset":)" + std::to_string(offset) : "") +
                   R"(,"componentType":5126,"type":"VEC3","min":)" + list(low) + R"(,"max":)" + list(high) +
                   R"(,"count":)" + std::to_string(points.size()) + (number == 0 ? accessor : "") + "}";
      std::string primitive =
          R"({"attributes":{)" + replacedAll(attributes, "0", std::to_string(accessor_number++)) + "}";
      if (this_mode != 4) primitive += R"(,"mode":)" + std::to_string(this_mode);
      if (index_bytes > 0) {
        const std::size_t at = buffer.size();
        for (const std::uint32_t i : order) {
          if (index_bytes == 1) putBytes(buffer, static_cast<std::uint8_t>(i));
          if (index_bytes == 2) putBytes(buffer, static_cast<std::uint16_t>(i));
          if (index_bytes == 4) putBytes(buffer, i);
        }
        accessors += R"(,{"bufferView":)" + addView(at, "") + R"(,"componentType":)" +
                     (index_bytes == 1   ? "5121"
                      : index_bytes == 2 ? "5123"
                                         : "5125") +
                     R"(,"type":"SCALAR","count":)" + std::to_string(order.size()) + "}";
        primitive += R"(,"indices":)" + std::to_string(accessor_number++);
      }
      primitives[number] = primitive + (number == 0 ? more_primitive : ell_primitive) + "}";
      ++number;
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + scene +
           R"(}],"nodes":[{"mesh":0,)" + block + R"(},{"mesh":1,)" + ell + "}" + more_nodes +
           R"(],"meshes":[{"primitives":[)" + primitives[0] + R"(]},{"primitives":[)" + primitives[1] +
           R"(]}],"bufferViews":[)" + views + R"(],"accessors":[)" + accessors +
           R"(],"buffers":[{"byteLength":)" + std::to_string(buffer.size()) +
           (is_binary
                ? ""
                : R"(,"uri":")" +
                      (uri.empty() ? "data:application/octet-stream;base64," + gltfBase64(buffer) : uri) +
                      "\"") +
           "}]" + members + "}";
  }
  std::string glb(const std::string& more_chunk = "") {
    is_binary = true;
    std::string text = json(), bytes = buffer;
    text.append((4 - text.size() % 4) % 4, ' ');
    bytes.append((4 - bytes.size() % 4) % 4, '\0');
    std::string out = "glTF";
    putBytes(out, std::uint32_t{2});
    putBytes(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes.size() + more_chunk.size()));
    putBytes(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON" + text;
    putBytes(out, static_cast<std::uint32_t>(bytes.size()));
    out += std::string("BIN\0", 4) + bytes + more_chunk;
    return out;
  }
};

std::vector<OddPart> gltfParts(const std::string& block = "block", const std::string& ell = "ell",
                               std::optional<Color> color = {}) {
  return {oddBlock(1, block, color), oddEll(1, ell)};
}

TEST_F(OddGltf, FilesAreReadAsTheyAreMeant) {
  std::vector<OddFile> all;
  const auto add = [&](const std::string& oddity, const std::function<void(GltfFile&)>& change,
                       std::vector<OddPart> parts = gltfParts(), bool has_remark = false) -> OddFile& {
    GltfFile file;
    change(file);
    all.push_back({oddity, file.json(), std::move(parts), "", has_remark});
    return all.back();
  };
  add("none", [](GltfFile&) {});
  for (const int size : {1, 4, 0})
    add("indices of " + std::to_string(size) + " bytes", [&](GltfFile& f) { f.index_bytes = size; });
  add("a strip", [](GltfFile& f) { f.mode = 5; });
  add("a strip without indices", [](GltfFile& f) {
    f.mode = 5;
    f.index_bytes = 0;
  });
  add("positions among other data", [](GltfFile& f) { f.stride = 32; });
  add("positions behind other data", [](GltfFile& f) {
    f.stride = 32;
    f.offset = 12;
  });
  add("a scale of a node", [](GltfFile& f) {
    f.scale = 1000;
    f.block += R"(,"scale":[0.001,0.001,0.001])";
    f.ell += R"(,"scale":[0.001,0.001,0.001])";
  });
  add("a mirror", [](GltfFile& f) { f.block += R"(,"scale":[-1,1,1],"translation":[10,0,0])"; });
  add("a mirror of all axes",
      [](GltfFile& f) { f.block += R"(,"scale":[-1,-1,-1],"translation":[10,30,-20])"; });
  add("unequal scales", [](GltfFile& f) { f.block += R"(,"scale":[2,1,0.5])"; },
      {{"block", Vec3::Zero(), Vec3(20, 10, 30), 6000, {}}, oddEll(1)});
  add("a matrix",
      [](GltfFile& f) { f.ell = R"("name":"ell","matrix":[1,0,0,0,0,1,0,0,0,0,1,0,100,0,0,1])"; });
  add("a rotation", [](GltfFile& f) { f.block += R"(,"rotation":[0,1,0,0],"translation":[10,0,-20])"; });
  add("nodes in nodes", [](GltfFile& f) {
    f.scene = "[2]";
    f.more_nodes =
        R"(,{"name":"rig","children":[3],"scale":[10,10,10]},{"children":[0,1],"scale":[0.1,0.1,0.1]})";
  });
  add("a mirror in a mirror",
      [](GltfFile& f) {
        f.scene = "[1,2]";
        f.block += R"(,"scale":[1,-1,1])";
        f.more_nodes = R"(,{"children":[0],"scale":[1,-1,1]})";
      },
      {oddEll(1), oddBlock(1)});
  add("two nodes of one mesh",
      [](GltfFile& f) {
        f.scene = "[0,1,2]";
        f.more_nodes = R"(,{"name":"second","mesh":1,"translation":[100,50,0]})";
      },
      {oddBlock(1), oddEll(1), {"second", Vec3(100, 0, 50), Vec3(130, 30, 60), 5000, {}}});
  add(
      "equal names", [](GltfFile& f) { f.ell = replacedAll(f.ell, "ell", "block"); },
      gltfParts("block", "block_2"));
  add(
      "no names", [](GltfFile& f) { f.block = R"("extras":1)"; }, gltfParts("odd"));
  add(
      "an empty name", [](GltfFile& f) { f.block = R"("name":"")"; }, gltfParts("odd"));
  add(
      "escapes in a name", [](GltfFile& f) { f.block = R"("name":"a\/b \"c\" \\ \u00e4 \ud83d\ude00")"; },
      gltfParts("a/b \"c\" \\ \xc3\xa4 \xf0\x9f\x98\x80"));
  add(
      "a new line in a name", [](GltfFile& f) { f.block = R"("name":"a\nb")"; }, gltfParts("a b"));
  add(
      "a tab in a name", [](GltfFile& f) { f.block = R"("name":"a\tb")"; }, gltfParts("a b"));
  add(
      "a long name", [](GltfFile& f) { f.block = R"("name":")" + std::string(100, 'n') + '"'; },
      gltfParts(std::string(100, 'n')));
  add(
      "a name that begins with nodes", [](GltfFile& f) { f.block = R"("name":"nodes")"; },
      gltfParts("nodes"));
  const std::string red =
      R"(,"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.5]}}])";
  add(
      "a material",
      [&](GltfFile& f) {
        f.more_primitive = R"(,"material":0)";
        f.members = red;
      },
      gltfParts("block", "ell", kRed));
  add(
      "an unlit material",
      [&](GltfFile& f) {
        f.more_primitive = R"(,"material":0)";
        f.members = replacedAll(red, R"("name":"red")", R"("extensions":{"KHR_materials_unlit":{}})") +
                    R"(,"extensionsUsed":["KHR_materials_unlit"])";
      },
      gltfParts("block", "ell", kRed));
  add(
      "a texture that is missing",
      [&](GltfFile& f) {
        f.more_primitive = R"(,"material":0)";
        f.members =
            replacedAll(red, R"("baseColorFactor")", R"("baseColorTexture":{"index":0},"baseColorFactor")") +
            R"(,"textures":[{"source":0}],"images":[{"uri":"gone.png"}])";
      },
      gltfParts("block", "ell", kRed));
  add(
      "a material without a name",
      [&](GltfFile& f) {
        f.more_primitive = R"(,"material":0)";
        f.members = replacedAll(red, R"("name":"red",)", "");
      },
      gltfParts("block", "ell", kRed));
  add("a camera and a light", [](GltfFile& f) {
    f.scene = "[0,1,2]";
    f.more_nodes = R"(,{"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}})";
    f.members =
        R"(,"cameras":[{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0.1,"zfar":9}}],"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
  });
  add("an animation", [](GltfFile& f) { f.members = R"(,"animations":[])"; });
  add("an asset's words", [](GltfFile& f) { f.members = R"(,"extras":{"a":[1,{"b":null}],"c":"\"}"})"; });
  add("a second scene", [](GltfFile& f) { f.members = R"(,"extensionsUsed":[])"; });
  add(
      "a morph target at rest", [](GltfFile& f) { f.more_primitive = R"(,"targets":[{"POSITION":0}])"; },
      gltfParts(), true);
  add("lines beside triangles",
      [](GltfFile& f) { f.ell_primitive = R"(},{"attributes":{"POSITION":2},"mode":1,"indices":3)"; });
  add("sparse positions", [](GltfFile& f) {
    f.accessor =
        R"(,"sparse":{"count":1,"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0}})";
  });
  {
    GltfFile file;
    const std::string text = file.json();
    all.push_back({"blanks and lines", replacedAll(replacedAll(text, "\":", "\" :\r\n\t "), ",\"", " ,\n\""),
                   gltfParts()});
    all.push_back({"a byte order mark", "\xef\xbb\xbf" + text, gltfParts()});
    all.push_back({"blank lines around", "\n " + text + "\n\n", gltfParts()});
    all.push_back({"a unit of the settings", text, gltfParts(), "", false, "", 1e-3});
    all.push_back({"an extension in capitals", text, gltfParts(), "", false, "ODD.GLTF"});
    all.push_back({"another type of the data",
                   replacedAll(text, "application/octet-stream", "application/gltf-buffer"), gltfParts()});
    all.push_back({"no scene by default", replacedAll(text, "\"scene\":0,", ""), gltfParts()});
    all.push_back({"cut", text.substr(0, text.size() / 2), {}, "not a readable glTF"});
    all.push_back({"another version", replacedAll(text, "\"2.0\"", "\"3.0\""), {}, "odd.gltf"});
  }
  for (const auto& [uri, name] :
       {std::pair("data.bin", "data.bin"), std::pair("my%20data.bin", "my data.bin"),
        std::pair("my data.bin", "my data.bin"), std::pair("./data.bin", "data.bin"),
        std::pair("d%C3%A4ta.bin", "d\xc3\xa4ta.bin")}) {
    GltfFile file;
    file.uri = uri;
    const std::string text = file.json();
    all.push_back(
        {std::string("data in ") + uri, text, gltfParts(), "", false, "", {}, {{name, file.buffer}}});
  }
  GltfFile gone;
  gone.uri = "gone.bin";
  all.push_back({"data that are missing", gone.json(), {}, "gone.bin"});
  GltfFile quantized;
  quantized.members =
      R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
  all.push_back({"an extension that changes geometry", quantized.json(), {}, "KHR_mesh_quantization"});
  std::string chunk;
  putBytes(chunk, std::uint32_t{8});
  chunk += "ABCD12345678";
  all.push_back({"binary", GltfFile().glb(), gltfParts(), "", false, "odd.glb"});
  all.push_back({"binary with another chunk", GltfFile().glb(chunk), gltfParts(), "", false, "odd.glb"});
  all.push_back({"binary with the extension of text", GltfFile().glb(), gltfParts()});
  all.push_back({"binary in capitals", GltfFile().glb(), gltfParts(), "", false, "ODD.GLB"});
  all.push_back({"binary that is cut", GltfFile().glb().substr(0, 900), {}, "truncated", false, "odd.glb"});
  expectAll(all, "odd.gltf");
}

std::string colladaGeometry(const std::string& id, const Mesh& mesh, const std::string& material) {
  std::string numbers, faces;
  for (const Vec3& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) numbers += std::to_string(p[k]) + " ";
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) faces += std::to_string(i) + " ";
  const std::string n = std::to_string(mesh.vertices.size());
  return "<geometry id=\"" + id + "\"><mesh><source id=\"" + id + "-s\"><float_array id=\"" + id +
         "-a\" count=\"" + std::to_string(3 * mesh.vertices.size()) + "\">" + numbers +
         "</float_array><technique_common><accessor source=\"#" + id + "-a\" count=\"" + n +
         "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param "
         "name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"" +
         id + "-v\"><input semantic=\"POSITION\" source=\"#" + id + "-s\"/></vertices><triangles count=\"" +
         std::to_string(mesh.triangles.size()) + "\"" + material + "><input semantic=\"VERTEX\" source=\"#" +
         id + "-v\" offset=\"0\"/><p>" + faces + "</p></triangles></mesh></geometry>";
}
std::string colladaRig(const std::string& unit, const std::string& up = "<up_axis>Z_UP</up_axis>") {
  return R"(<?xml version="1.0" encoding="utf-8"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         unit + up +
         "</asset>"
         R"(<library_effects><effect id="red-fx"><profile_COMMON><technique sid="common"><lambert><diffuse><color>1 0 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>)"
         R"(<library_materials><material id="red"><instance_effect url="#red-fx"/></material></library_materials><library_geometries>)" +
         colladaGeometry("g1", oddBlockMesh(), " material=\"m\"") + colladaGeometry("g2", oddEllMesh(), "") +
         R"(</library_geometries><library_visual_scenes><visual_scene id="s"><node id="n1" name="block"><instance_geometry url="#g1"><bind_material><technique_common><instance_material symbol="m" target="#red"/></technique_common></bind_material></instance_geometry></node>)"
         R"(<node id="n2" name="ell"><translate>100 0 0</translate><instance_geometry url="#g2"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(OddCollada, FilesAreReadAsTheyAreMeant) {
  std::vector<OddFile> all;
  const auto parts = [](double unit_m, const std::string& block = "block", const std::string& ell = "ell") {
    return std::vector<OddPart>{oddBlock(unit_m, block, kRed), oddEll(unit_m, ell)};
  };
  for (const auto& [unit, unit_m] :
       {std::pair(R"(<unit name="millimeter" meter="0.001"/>)", 1e-3),
        std::pair(R"(<unit meter="0.01" name="centimeter"/>)", 1e-2),
        std::pair(R"(<unit meter="0.0254" name="inch"/>)", 25.4e-3), std::pair(R"(<unit meter="1"/>)", 1.0),
        std::pair(R"(<unit meter="1e-3"/>)", 1e-3), std::pair(R"(<unit meter="1.0E-06"/>)", 1e-6),
        std::pair(R"(<unit meter=" 0.001 "/>)", 1e-3),
        std::pair(R"(<unit name="millimeter" meter='0.001'></unit>)", 1e-3),
        std::pair(R"(<unit meter="+0.001"/>)", 1e-3),
        std::pair(R"(<unit meter="0.3048" name="Fu&#223;"/>)", 0.3048)})
    all.push_back({unit, colladaRig(unit), parts(unit_m)});
  for (const char* unit : {"", "<unit name=\"millimeter\"/>", "<unit meter=\"0\"/>", "<unit meter=\"-1\"/>",
                           "<unit meter=\"mm\"/>", "<unit meter=\"0,001\"/>"}) {
    all.push_back({std::string("assumed: ") + unit, colladaRig(unit), parts(1), "", true});
    all.push_back({std::string("given: ") + unit, colladaRig(unit), parts(1e-3), "", false, "", 1e-3});
  }
  const std::string s = colladaRig(R"(<unit meter="0.001"/>)");
  all.push_back({"line ends of two bytes", replacedAll(s, "><", ">\r\n<"), parts(1e-3)});
  all.push_back({"a byte order mark", "\xef\xbb\xbf" + s, parts(1e-3)});
  all.push_back({"a comment with a unit", replacedOnce(s, "<asset>", "<asset><!-- <unit meter=\"1\"/> -->"),
                 parts(1e-3)});
  all.push_back({"names of other scripts",
                 replacedAll(replacedAll(s, "\"block\"", "\"\xe6\x9d\xbf\""), "\"ell\"", "\"a &amp; b\""),
                 parts(1e-3, "\xe6\x9d\xbf", "a & b")});
  all.push_back({"no names", replacedAll(s, " name=\"block\"", ""), parts(1e-3, "n1")});
  all.push_back({"equal names", replacedAll(s, "\"ell\"", "\"block\""), parts(1e-3, "block", "block_2")});
  all.push_back({"an extension in capitals", s, parts(1e-3), "", false, "ODD.DAE"});
  all.push_back(
      {"no file at the end of a picture",
       replacedOnce(s, "<library_effects>",
                    "<library_images><image "
                    "id=\"i\"><init_from>gone.png</init_from></image></library_images><library_effects>"),
       parts(1e-3)});
  all.push_back(
      {"a matrix",
       replacedAll(s, "<translate>100 0 0</translate>", "<matrix>1 0 0 100 0 1 0 0 0 0 1 0 0 0 0 1</matrix>"),
       parts(1e-3)});
  all.push_back({"cut", s.substr(0, s.size() / 2), {}, "not a readable DAE"});
  all.push_back(
      {"a source that is missing", replacedOnce(s, "source=\"#g1-s\"", "source=\"#gone\""), {}, "odd.dae"});
  expectAll(all, "odd.dae");
}

}  // namespace
}  // namespace vps::scenes::odd

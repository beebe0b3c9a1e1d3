// SPDX-License-Identifier: BSD-3-Clause
#include "web/web_files.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "files/external.h"
#include "mesh/coarse_mesh.h"
#include "vps_device/detail/bytes.h"

namespace vps::viewer {
namespace {

using Json = nlohmann::ordered_json;

// Component types of the glTF standard.
enum GlbType : int { kFloat = 5126, kUnsigned = 5125 };
enum GlbMode : int { kLines = 1, kTriangles = 4 };
enum GlbTarget : int { kVertices = 34962, kIndices = 34963 };
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

/// The binary buffer of a glTF file, with its views and accessors.
class GlbBuffer {
 public:
  /// Adds vectors of three floats and returns the index of their accessor.
  int addVectors(const std::vector<float>& values, bool has_bounds) {
    std::string bytes;
    device::ByteWriter writer(bytes);
    for (const float value : values) writer.put(value);
    Json accessor = {{"componentType", kFloat}, {"count", values.size() / 3}, {"type", "VEC3"}};
    if (has_bounds) addBounds(accessor, values);
    return add(std::move(bytes), kVertices, std::move(accessor));
  }
  int addIndices(const std::vector<std::uint32_t>& values) {
    std::string bytes;
    device::ByteWriter writer(bytes);
    for (const std::uint32_t value : values) writer.put(value);
    return add(std::move(bytes), kIndices,
               {{"componentType", kUnsigned}, {"count", values.size()}, {"type", "SCALAR"}});
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] const Json& views() const { return views_; }
  [[nodiscard]] const Json& accessors() const { return accessors_; }

 private:
  static void addBounds(Json& accessor, const std::vector<float>& values) {
    std::array<float, 3> least, most;
    least.fill(std::numeric_limits<float>::max());
    most.fill(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < values.size(); ++i) {
      least[i % 3] = std::min(least[i % 3], values[i]);
      most[i % 3] = std::max(most[i % 3], values[i]);
    }
    accessor["min"] = least;
    accessor["max"] = most;
  }
  int add(std::string bytes, int target, Json accessor) {
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}, {"target", target}});
    accessor["bufferView"] = views_.size() - 1;
    accessors_.push_back(std::move(accessor));
    bytes_ += bytes;  // all data has words of four bytes, so each view stays aligned
    return static_cast<int>(accessors_.size()) - 1;
  }

  std::string bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

/// The primitive of the surface. The primitive has only the vertices that its triangles use, in the order of
/// their first use.
Json surface(const ShadingMesh& mesh, std::size_t wanted, GlbBuffer& buffer) {
  std::vector<std::uint32_t> triangles = CoarseMesh(mesh).indices(wanted);
  std::vector<std::uint32_t> number(mesh.vertices.size(), UINT32_MAX);
  std::vector<float> places, normals, colors;
  std::uint32_t count = 0;
  for (std::uint32_t& i : triangles) {
    if (number[i] == UINT32_MAX) {
      number[i] = count++;
      const ShadingVertex& vertex = mesh.vertices[i];
      places.insert(places.end(), vertex.p.begin(), vertex.p.end());
      normals.insert(normals.end(), vertex.n.begin(), vertex.n.end());
      if (!mesh.colors.empty()) colors.insert(colors.end(), mesh.colors[i].begin(), mesh.colors[i].end());
    }
    i = number[i];
  }
  const int place = buffer.addVectors(places, true), normal = buffer.addVectors(normals, false);
  Json attributes = {{"POSITION", place}, {"NORMAL", normal}};
  if (!colors.empty()) attributes["COLOR_0"] = buffer.addVectors(colors, false);
  return {{"attributes", attributes},
          {"indices", buffer.addIndices(triangles)},
          {"mode", static_cast<int>(kTriangles)}};
}

Json edges(const ShadingMesh& mesh, GlbBuffer& buffer) {
  std::vector<float> places;
  for (const ShadingEdge& edge : mesh.sharp_edges)
    for (const auto& end : {edge.a, edge.b}) places.insert(places.end(), end.begin(), end.end());
  return {{"attributes", {{"POSITION", buffer.addVectors(places, true)}}},
          {"mode", static_cast<int>(kLines)}};
}

std::string padded(std::string text, char with) {
  text.resize((text.size() + 3) / 4 * 4, with);
  return text;
}

}  // namespace

WebPage::WebPage() {
  constexpr const char* kScript = "text/javascript; charset=utf-8";
  files_["/"] = {"text/html; charset=utf-8", kPageHtml};
  files_["/page.css"] = {"text/css; charset=utf-8", kPageCss};
  files_["/page.js"] = {kScript, kPageScript};
  constexpr std::pair<const char*, const char*> kLibrary[] = {
      {"/three.js", "build/three.min.js"},
      {"/orbit_controls.js", "examples/js/controls/OrbitControls.js"},
      {"/gltf_loader.js", "examples/js/loaders/GLTFLoader.js"}};
  for (const auto& [path, file] : kLibrary) {
    std::string text = textOf(std::string(kThreeFolder) + file);
    if (text.empty())
      missing_ = std::string("three.js, which draws in the browser, is not in ") + kThreeFolder +
                 ": install libjs-three";
    files_[path] = {kScript, std::move(text)};
  }
}

const WebFile* WebPage::find(std::string_view path) const {
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

std::string partGlb(const ShadingMesh& mesh, std::size_t wanted, bool has_edges) {
  GlbBuffer buffer;
  Json primitives = Json::array();
  primitives.push_back(surface(mesh, wanted, buffer));
  if (has_edges && !mesh.sharp_edges.empty()) primitives.push_back(edges(mesh, buffer));
  const Json head = {
      {"asset", {{"version", "2.0"}, {"generator", "bullet-vps"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}, {"translation", {mesh.center.x(), mesh.center.y(), mesh.center.z()}}}}},
      {"meshes", {{{"primitives", primitives}}}},
      {"buffers", {{{"byteLength", buffer.bytes().size()}}}},
      {"bufferViews", buffer.views()},
      {"accessors", buffer.accessors()}};
  const std::string json = padded(head.dump(), ' '), bytes = padded(buffer.bytes(), '\0');
  std::string file;
  device::ByteWriter writer(file);
  writer.put(kMagic);
  writer.put(kVersion);
  writer.put(static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + bytes.size()));
  writer.put(static_cast<std::uint32_t>(json.size()));
  writer.put(kJsonChunk);
  writer.bytes(json);
  writer.put(static_cast<std::uint32_t>(bytes.size()));
  writer.put(kBinChunk);
  writer.bytes(bytes);
  return file;
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Reads mesh formats by assimp: STL, OBJ, PLY, glTF, Collada and others.
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>

#include "assimp/mesh_text.h"
#include "assimp/xml_tags.h"
#include "color/palette.h"
#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

Eigen::Affine3d affine(const aiMatrix4x4& m) {
  Eigen::Affine3d X;
  X.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return X;
}

void appendMesh(const aiMesh& from, Mesh& to) {
  const auto base = std::uint32_t(to.vertices.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    to.vertices.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    to.triangles.push_back({base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]});
  }
}

/// Appends the colours of the triangles that appendMesh() takes: the mean of the corners' colours if the file
/// has colours of vertices, else the colour of the mesh.
void appendColors(const aiMesh& from, const Color& of_mesh, bool is_gltf, FaceColors& to) {
  FaceColors own;
  std::size_t count = 0;
  Palette palette(own);
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;
    ++count;
    if (!from.HasVertexColors(0)) continue;
    aiColor4D mean;
    for (unsigned k = 0; k < 3; ++k) mean += from.mColors[0][face.mIndices[k]];
    Color color = {mean.r / 3, mean.g / 3, mean.b / 3};
    if (!is_gltf) color = linearFromSrgb(color);
    for (std::size_t k = 0; is_gltf && k < 3; ++k) color[k] *= of_mesh[k];  // as glTF specifies
    palette.add(color);
  }
  append(to, count, own, of_mesh);
}

std::array<float, 3> colorOf(const aiScene& scene, const aiMesh& mesh, bool is_gltf) {
  aiColor4D c;
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return ImportedPart().color;
  aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  // glTF's factor is linear by its specification; the other formats give the colour on the screen.
  if (is_gltf && material.Get(AI_MATKEY_BASE_COLOR, c) == AI_SUCCESS) return {c.r, c.g, c.b};
  if (std::string(material.GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME) {
    return ImportedPart().color;  // the material is assimp's default, not the file's
  }
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, c) == AI_SUCCESS) return linearFromSrgb({c.r, c.g, c.b});
  return ImportedPart().color;
}

/// Gives assimp other bytes in place of one file, if there are any; files that this file names are read from
/// disk, where their names may be written with "%20" for a blank.
class ReplacedFile : public Assimp::DefaultIOSystem {
 public:
  ReplacedFile(std::string file, const std::string* bytes) : file_(std::move(file)), bytes_(bytes) {}
  bool Exists(const char* name) const override {
    return (bytes_ != nullptr && name == file_) || DefaultIOSystem::Exists(name);
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (bytes_ != nullptr && name == file_)
      return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_->data()),
                                        bytes_->size());
    if (Assimp::IOStream* const stream = DefaultIOSystem::Open(name, mode); stream != nullptr) return stream;
    const std::size_t folder = file_.find_last_of('/') + 1;  // 0 without a folder
    if (std::string_view(name).substr(0, folder) != std::string_view(file_).substr(0, folder)) return nullptr;
    const std::string decoded =
        file_.substr(0, folder) + percentDecoded(std::string_view(name).substr(folder));
    return decoded == name ? nullptr : DefaultIOSystem::Open(decoded.c_str(), mode);
  }

 private:
  std::string file_;
  const std::string* bytes_;
};

/// The name of a node or mesh; empty for assimp's placeholders.
std::string nameFrom(const aiString& text) {
  const std::string name = text.C_Str();
  const bool is_placeholder = name.starts_with("<") || name.starts_with("nodes[") ||
                              name.starts_with("meshes[") || name.starts_with("$ColladaAutoName$") ||
                              name == "defaultobject" || name == "RootNode";
  return is_placeholder ? "" : name;
}

struct Walk {
  const aiScene& scene;
  bool is_gltf;
  RawCad& cad;

  void node(const aiNode& n, const Eigen::Affine3d& X_WParent) {
    const Eigen::Affine3d X_WP = X_WParent * affine(n.mTransformation);
    RawPart part;
    part.name = nameFrom(n.mName);
    part.X_WP = X_WP;
    for (unsigned i = 0; i < n.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene.mMeshes[n.mMeshes[i]];
      const Color color = colorOf(scene, mesh, is_gltf);
      if (i == 0) part.color = color;
      appendColors(mesh, color, is_gltf, part.face_colors);
      if (part.name.empty()) part.name = nameFrom(mesh.mName);
      appendMesh(mesh, part.mesh);
    }
    part.rounding = floatRounding(part.mesh, X_WP);
    if (n.mNumMeshes > 0) cad.parts.push_back(std::move(part));
    for (unsigned i = 0; i < n.mNumChildren; ++i) node(*n.mChildren[i], X_WP);
  }
};

/// Rotates glTF and Collada from y-up to z-up. glTF is y-up by its specification, and exporters rotate z-up
/// models with their meshes, so meshes are rotated back too, into the part's frame in CAD. assimp makes
/// Collada y-up through the root's transform alone, so only poses are rotated back.
void makeZUp(RawCad& cad, bool is_gltf) {
  const Eigen::Affine3d X_ZY(Eigen::AngleAxisd(0.5 * EIGEN_PI, Vec3::UnitX()));
  for (RawPart& part : cad.parts) {
    part.X_WP = X_ZY * part.X_WP;
    if (!is_gltf) continue;
    part.X_WP = part.X_WP * X_ZY.inverse();
    for (Vec3& p : part.mesh.vertices) p = Vec3(p.x(), -p.z(), p.y());
  }
}

/// The bytes to give to assimp for a binary PLY file whose first value begins with the byte '\n'; empty for
/// other files. assimp 5.2.5 takes that byte for the second half of a line end and drops it, so the header
/// gets a line end of two bytes.
std::optional<std::string> plyItReadsRight(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  bool is_binary = false;
  for (std::string line; std::getline(in, line) && line != "end_header";)
    is_binary = is_binary || line.starts_with("format binary");
  if (!in || !is_binary || in.peek() != '\n') return std::nullopt;
  const auto data_at = std::size_t(in.tellg());
  in.seekg(0);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  bytes.insert(data_at - 1, 1, '\r');
  return bytes;
}

/// The text in which each node without a name is named by its identifier.
std::string withNamesOfNodes(std::string_view collada) {
  std::string out;
  std::size_t copied = 0, at = 0;
  while (const std::optional<XmlTag> tag = nextTag(collada, at)) {
    if (tag->name != "node" || !tag->is_begin || tag->value("name")) continue;
    const std::string id(tag->value("id").value_or(""));
    if (id.empty() || id.find('"') != std::string::npos) continue;
    const auto end_of_name = static_cast<std::size_t>(tag->attributes.data() - collada.data());
    out.append(collada.substr(copied, end_of_name - copied)).append(" name=\"" + id + '"');
    copied = end_of_name;
  }
  return out.append(collada.substr(copied));
}

/// The text of a Collada file, to be given to assimp, which turns the file's unit into a scale of the root's
/// transform (1 if the unit is missing or not a number). If the unit is not a positive length, the unit of
/// the settings applies, or else the metre, which Collada defines for files without a unit, with a warning.
std::string colladaText(const std::string& file, const ImportSettings& settings, RawCad& cad) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  const std::optional<XmlTag> tag = tagAt(text, "COLLADA/asset/unit");
  const std::string meter(tag ? tag->value("meter").value_or("") : "");
  double unit_m = 0;
  const char *const from = meter.data() + meter.starts_with('+'), *const end = meter.data() + meter.size();
  const auto [rest, error] = std::from_chars(from, end, unit_m);
  cad.states_unit = error == std::errc() && rest == end && std::isfinite(unit_m) && unit_m > 0;
  if (cad.states_unit) {
    const std::string name(tag->value("name").value_or(""));
    const std::optional<double> named_m = unitFromText(name);
    if (named_m && std::abs(unit_m - *named_m) > 0.01 * *named_m)
      cad.warnings.push_back("calls its unit '" + name + "', but states that it has " + meter +
                             " m, which is used");
  } else {
    cad.unit_m = settings.unit_m.value_or(1.0);
    if (!settings.unit_m)
      cad.warnings.push_back(
          (tag ? "states a unit of '" + meter + "' m" : std::string("states no unit")) +
          ": metres are assumed, as Collada defines; set unit or --units for another unit");
  }
  // The unit is written anew, since assimp reads neither signs nor blanks in it.
  if (tag)
    text.replace(
        tag->from, tag->end - tag->from,
        "<unit meter='" + (cad.states_unit ? std::string(from, end) : "1") + (tag->is_end ? "'/>" : "'>"));
  return withNamesOfNodes(text);
}

/// The JSON text of a glTF file, be it text or binary.
std::string gltfJson(const std::string& file) {
  constexpr std::size_t kHeader = 20;  // "glTF", version, size; size of the first chunk, "JSON"
  std::ifstream in(file, std::ios::binary);
  std::string json(kHeader, '\0');
  in.read(json.data(), kHeader);
  std::uint32_t size = 0;
  std::memcpy(&size, &json[12], sizeof size);
  if (in && json.starts_with("glTF")) {
    const auto all = std::filesystem::file_size(file);
    json.resize(std::min<std::uintmax_t>(size, all));
    in.read(json.data(), std::ssize(json));
    json.resize(static_cast<std::size_t>(in.gcount()));
    return json;
  }
  json.resize(static_cast<std::size_t>(in.gcount()));
  json.append(std::istreambuf_iterator<char>(in), {});
  return json;
}

/// A glTF file as assimp reads it.
struct GltfInput {
  std::string name;                  ///< with the extension that fits the content
  std::optional<std::string> bytes;  ///< in place of those of the file; empty: the file is read as it is
};

/// Throws LoadError for a file that needs an extension that is not read.
GltfInput gltfInput(const std::string& file) {
  const std::string json = gltfJson(file);
  if (const std::string name = unreadExtension(requiredExtensions(json)); !name.empty())
    throw LoadError(
        file, "",
        "needs the extension '" + name + "' of glTF, which is not read; export it without this extension");
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> first{};
  in.read(first.data(), first.size());
  const bool is_binary = std::string_view(first.data(), first.size()) == "glTF";
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  const std::string right = is_binary ? ".glb" : ".gltf";
  GltfInput out{extension == right ? file : file + right, {}};
  std::string shown = json;
  hideOtherExtras(shown, 0);
  if (extension == right && shown == json && !json.starts_with(kByteOrderMark)) return out;
  if (!is_binary) {
    if (shown.starts_with(kByteOrderMark)) shown.erase(0, kByteOrderMark.size());
    out.bytes = std::move(shown);
    return out;
  }
  in.seekg(0);
  constexpr std::size_t kHeader = 20;
  out.bytes.emplace(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (out.bytes->size() >= kHeader + shown.size()) out.bytes->replace(kHeader, shown.size(), shown);
  return out;
}

/// A remark on meshes with morph targets or skins, which are read in their shape at rest; empty without.
std::string deformations(const aiScene& scene) {
  std::size_t count = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i)
    count += scene.mMeshes[i]->mNumAnimMeshes > 0 || scene.mMeshes[i]->mNumBones > 0 ? 1 : 0;
  if (count == 0) return "";
  return "has " + std::to_string(count) +
         (count == 1 ? " mesh with a deformation (morph targets or a skin) that is"
                     : " meshes with deformations (morph targets or skins) that are") +
         " not applied: the shape at rest is read";
}

/// Rotates the parts back to the axes of the file, since the user states which axis is up.
void keepFileAxes(RawCad& cad) {
  const Eigen::Affine3d X_YZ(Eigen::AngleAxisd(-0.5 * EIGEN_PI, Vec3::UnitX()));
  for (RawPart& part : cad.parts) part.X_WP = X_YZ * part.X_WP;
}

/// True if all vertices of the faces exist. assimp's readers do not check this, and its triangulation then
/// aborts.
bool hasAllVertices(const aiMesh& mesh) {
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices == 0) return false;
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) return false;
    }
  }
  return true;
}

}  // namespace

RawCad readAssimp(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                  const Progress&) {
  std::optional<MeshText> text;
  Assimp::Importer importer;  // assimp's logger is silent by default
  const bool is_gltf = format.id == CadFormat::Gltf, is_collada = format.id == CadFormat::Collada;
  if (format.name.empty() || (!is_gltf && !importer.IsExtensionSupported("." + format.name)) ||
      format.name == "IFC") {
    throw LoadError(file, "", "has an unknown format; export STEP, glTF, STL, OBJ or PLY");
  }
  RawCad cad;
  cad.states_unit = is_gltf;  // glTF is in metres by its specification
  std::optional<std::string> replaced;
  std::string read_name = file;
  if (is_gltf) {
    GltfInput input = gltfInput(file);
    read_name = std::move(input.name);
    replaced = std::move(input.bytes);
  }
  if (is_collada)
    replaced = colladaText(file, settings, cad);
  else if (!cad.states_unit)
    cad.unit_m = unitOf(file, format, settings);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES,
                           true);  // otherwise names are identifiers
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = nullptr;
  try {
    std::optional<std::string> ply;
    if (format.id == CadFormat::Ply) ply = plyItReadsRight(file);
    if (format.id == CadFormat::Obj) text = objText(file);
    if (format.id == CadFormat::Stl) text = stlText(file);
    const std::string* const bytes = text ? &text->bytes : replaced ? &*replaced : nullptr;
    if (bytes != nullptr || is_gltf)  // the importer deletes the handler
      importer.SetIOHandler(new ReplacedFile(read_name, bytes));
    scene = ply ? importer.ReadFileFromMemory(ply->data(), ply->size(), 0, "ply")
                : importer.ReadFile(read_name, 0);
    for (unsigned i = 0; scene && i < scene->mNumMeshes; ++i) {
      if (!hasAllVertices(*scene->mMeshes[i]))
        throw LoadError(file, scene->mMeshes[i]->mName.C_Str(),
                        "has a face with a vertex that does not exist; export it again");
    }
    if (scene) scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
  } catch (const LoadError&) {
    throw;
  } catch (const std::exception& e) {
    throw LoadError(
        file, "",
        std::string("is not a readable ") + format.name + " file (" + e.what() + "); export it again");
  }
  if (scene != nullptr && scene->mRootNode != nullptr && scene->mNumMeshes == 0)
    throw LoadError(file, "", "holds no surfaces; export solids or meshes");
  if (!scene || !scene->mRootNode || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE)) {
    std::string reason = importer.GetErrorString();
    for (char& c : reason) c = c == '\n' ? ' ' : c;
    throw LoadError(file, "", "is not a readable " + format.name + " file (" + reason + "); export it again");
  }
  if (const std::string remark = deformations(*scene); !remark.empty()) cad.warnings.push_back(remark);
  Walk{*scene, is_gltf, cad}.node(*scene->mRootNode, Eigen::Affine3d::Identity());
  if (is_gltf || is_collada) makeZUp(cad, is_gltf);
  if (is_gltf && settings.up) keepFileAxes(cad);
  if (format.id == CadFormat::Obj) cad.open_shapes = Shapes::BoundOne;
  if (text && text->surface_count > 0)
    cad.warnOfMissing("has " + std::to_string(text->surface_count) +
                      (text->surface_count == 1 ? " free-form surface ('surf') that is"
                                                : " free-form surfaces ('surf') that are") +
                      " not read; export triangles");
  for (RawPart& part : cad.parts) {
    if (text) {
      part.name = text->nameIn(part.name);
      for (Vec3& p : part.mesh.vertices) p += text->shift;
    }
    if (format.id == CadFormat::Stl && cad.parts.size() == 1)
      part.name.clear();  // the header of an STL file is not a name
  }
  return cad;
}

}  // namespace vps::scenes::import

// SPDX-License-Identifier: BSD-3-Clause
#include "input/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "vps/errors.h"

namespace vps::viewer {

std::string lowerExtension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool isCadExtension(const std::string& lower_extension) {
  static constexpr std::array<const char*, 20> kExtensions = {
      ".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".stl", ".obj", ".ply", ".gltf",
      ".glb",  ".dae", ".iv",   ".wrl", ".wrz",  ".3ds", ".3mf", ".off", ".x3d", ".fbx"};
  return std::find(kExtensions.begin(), kExtensions.end(), lower_extension) != kExtensions.end();
}

void requireSceneFile(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (isCadExtension(extension))
    throw LoadError(file, "",
                    "is a CAD file, not a scene; make a scene of it first: vps import " + file + " -o DIR");
  if (extension == ".vdb")
    throw LoadError(file, "", "is a level set, not a scene; vps query and vps export use level sets");
  if (extension == ".mcap")
    throw LoadError(file, "", "is a recording, not a scene; run it again with: vps replay " + file);
}

void requireCadFile(const std::string& file) {
  const std::string extension = lowerExtension(file);
  if (extension == ".vdb")
    throw LoadError(
        file, "",
        "is a level set and has no mesh; vps query takes it as the first part, and vps export writes "
        "such files from a mesh");
  if (extension == ".toml")
    throw LoadError(file, "", "is a scene already; vps assemble, vps simulate and vps explain read scenes");
}

}  // namespace vps::viewer

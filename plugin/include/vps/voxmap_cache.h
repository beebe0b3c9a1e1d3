// SPDX-License-Identifier: BSD-3-Clause
// A folder of voxmaps, so that each part is voxelised once.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "vps/export.h"
#include "vps/voxmap.h"

namespace vps::inline v0 {

/// A folder of voxmaps. Each file is named by a 128-bit hash (XXH3) of everything that determines the map:
/// every vertex and triangle to the bit, the settings, and the version of the file. A map from the folder has
/// the same bits as one from buildVoxMap() for the mesh's Solid.
///
/// A file is used only if it is whole, of this version and this byte order, and its content matches the hash
/// it ends with; otherwise the map is built again and the file replaced, with a warning. The hash detects
/// damage, not malice: use a folder that only your own account can write. Several threads and programs may
/// share the folder. Files are never removed: delete the folder or any file in it at any time.
class VPS_API VoxMapCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param folder  created when the first map is written
  /// @param warn    called with one line of text if a file could not be read or written
  explicit VoxMapCache(std::filesystem::path folder, Warn warn = {});

  /// As vps::buildVoxMap() for the mesh's Solid, but reads the map from the folder if it is there: O(bytes)
  /// of mesh and map. Throws LoadError for the same reasons, never for a fault of the folder.
  VoxMap build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part = "",
               const Progress& progress = {}, MeshReport* report = nullptr) const;

  /// As above, where the mesh's Solid exists already.
  VoxMap build(const Mesh& mesh, const Solid& solid, const VoxMapSettings& settings,
               const std::string& part = "", const Progress& progress = {},
               MeshReport* report = nullptr) const;

  /// The path of this mesh's map, whether the file exists or not.
  [[nodiscard]] std::filesystem::path fileOf(const Mesh& mesh, const VoxMapSettings& settings) const;

 private:
  VoxMap readOrBuild(const Mesh& mesh, const VoxMapSettings& settings, MeshReport* report,
                     const std::function<VoxMap(MeshReport&)>& make) const;
  std::filesystem::path folder_;
  Warn warn_;
};

}  // namespace vps::inline v0

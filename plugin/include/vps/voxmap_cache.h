// SPDX-License-Identifier: BSD-3-Clause
// A folder of voxmaps and pointshells, so that the models of each part are built once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "vps/export.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

class CacheFolder;

/// A folder of voxmaps and pointshells. Each file is named by a 128-bit hash (XXH3) of everything that
/// determines the model: every vertex and triangle to the bit, the settings, and the version of the file. A
/// model from the folder has the same bits as one that is built from the mesh's Solid.
///
/// A file is used only if it is complete, has this version and byte order, and its content matches the hash
/// at its end; otherwise the model is built again and the file replaced, with a warning. The hash detects
/// damage, not malice: use a folder that only your own account can write, such as one that the cache created.
/// Several threads and programs may share the folder. If there is a limit and the folder exceeds it, the
/// files that were not used for the longest time are removed. The folder or any file in it may be deleted at
/// any time. If a file cannot be written (full or read-only disk), there is one warning, and no other file is
/// written.
class VPS_API VoxMapCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param folder  created when the first map is written
  /// @param warn    called with one line of text if a file could not be read or written; by one thread at a
  ///                time
  /// @param limit_bytes  limit of the total size of all files; 0: no limit
  explicit VoxMapCache(std::filesystem::path folder, Warn warn = {}, std::uint64_t limit_bytes = 0);

  /// As vps::buildVoxMap() for the mesh's Solid, but reads the map from the folder if it is there: O(bytes)
  /// of mesh and map. Throws LoadError for the same reasons, never for a fault of the folder.
  VoxMap build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part = "",
               const Progress& progress = {}, MeshReport* report = nullptr) const;

  /// build() for callers that already have the mesh's Solid.
  VoxMap build(const Mesh& mesh, const Solid& solid, const VoxMapSettings& settings,
               const std::string& part = "", const Progress& progress = {},
               MeshReport* report = nullptr) const;

  /// As vps::buildPointShell() of the mesh's Solid, but reads the shell from the folder if it is there.
  /// Throws LoadError for the same reasons, never for a fault of the folder.
  PointShell buildShell(const Mesh& mesh, const Solid& solid, const PointShellSettings& settings,
                        const std::string& part = "") const;

  /// The paths of this mesh's models, whether the files exist or not.
  [[nodiscard]] std::filesystem::path fileOf(const Mesh& mesh, const VoxMapSettings& settings) const;
  [[nodiscard]] std::filesystem::path shellFileOf(const Mesh& mesh, const PointShellSettings& settings) const;

 private:
  VoxMap readOrBuild(const Mesh& mesh, const VoxMapSettings& settings, MeshReport* report,
                     const std::function<VoxMap(MeshReport&)>& make) const;
  std::shared_ptr<CacheFolder> folder_;
};

}  // namespace vps

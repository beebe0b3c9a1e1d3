// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps kept on disk, so that a part is built once.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "vps/export.h"
#include "vps/voxmap.h"

namespace vps {

/// A folder of voxmaps, each named by a 128-bit hash (XXH3) of all that it is built from: every vertex and
/// triangle to the bit, the settings, and the version of the file. What comes out is to the bit what
/// buildVoxMap() makes.
///
/// A file is trusted only if it is whole, of this version and this kind of machine, and its content matches
/// its own hash; any other is built again and replaced, with a warning. The hash finds damage, not malice:
/// the folder is for your own account. Several threads and programs may share it; files appear whole or not
/// at all. Nothing is ever removed: delete the folder, or any file in it, whenever you like.
class VPS_API VoxMapCache {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// @param folder  made when the first map is written
  /// @param warn    told, in one line, what could not be read or written and what was done instead
  explicit VoxMapCache(std::filesystem::path folder, Warn warn = {});

  /// As vps::buildVoxMap(), from the folder where it has been built before: O(bytes) of the mesh and the map.
  /// Throws LoadError as that does, never for what is wrong with the folder.
  VoxMap build(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part = "",
               const Progress& progress = {}, MeshReport* report = nullptr) const;

  /// Where the map of this mesh is kept, whether there is one or not.
  [[nodiscard]] std::filesystem::path fileOf(const Mesh& mesh, const VoxMapSettings& settings) const;

 private:
  std::filesystem::path folder_;
  Warn warn_;
};

}  // namespace vps

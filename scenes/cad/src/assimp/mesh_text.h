// SPDX-License-Identifier: BSD-3-Clause
// Texts of mesh files that assimp 5.2.5 misreads: OBJ and STL are changed, glTF is checked.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vps/pose.h"

namespace vps::scenes::import {

struct MeshText {
  std::string bytes;
  /// Subtracted from all vertices, in file units, because assimp keeps coordinates as 32-bit floats, which
  /// are 15 um apart at 300 m. Zero where a shift would not help.
  Vec3 shift = Vec3::Zero();
  /// Names of the objects, by number. assimp cuts names at their first space and merges two objects of the
  /// same name, so each name is replaced by a unique word, see nameIn().
  std::vector<std::string> names;
  std::size_t surface_count = 0;  ///< free-form surfaces of an OBJ file, which assimp does not read

  /// The name that was replaced by this word, or the word itself if it replaces no name.
  [[nodiscard]] std::string nameIn(const std::string& word) const;
};

/// The text of an OBJ file, to be given to assimp.
MeshText objText(const std::string& file);
/// The text of an STL file, to be given to assimp; empty for a binary file.
std::optional<MeshText> stlText(const std::string& file);

/// The names in "extensionsRequired", the extensions that a glTF file cannot be read without, from its JSON
/// text. assimp reads a file with required extensions as if it required none. O(n).
std::vector<std::string> requiredExtensions(std::string_view json);

/// The first of `names` that may change geometry and is not read; empty if there is none. Materials,
/// textures, lights and metadata do not change geometry, and assimp reads or refuses compression by Draco.
std::string unreadExtension(const std::vector<std::string>& names);

/// Renames each "extras" from `from` on whose value is no object: glTF allows any value, and assimp 5.2.5
/// refuses the file. The text keeps its length.
void hideOtherExtras(std::string& json, std::size_t from);

/// The text in which each "%20" is the byte of this hexadecimal number, as in names of files in glTF.
std::string percentDecoded(std::string_view text);

}  // namespace vps::scenes::import

// SPDX-License-Identifier: BSD-3-Clause
// OBJ and STL files of text, changed so that assimp reads them as they are meant.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps/pose.h"

namespace vps::scenes::import {

struct MeshText {
  std::string bytes;
  /// Taken off all vertices, in file units: assimp keeps coordinates as 32-bit floats, which are 15 um apart
  /// at 300 m. Zero where that would not help.
  Vec3 shift = Vec3::Zero();
  /// By number: assimp 5.2.5 cuts names at their first space and makes one object of two of the same name, so
  /// each name is replaced by a word of its own, see nameIn().
  std::vector<std::string> names;
  std::size_t surface_count = 0;  ///< free-form surfaces of an OBJ file, which assimp does not read

  /// The name that was replaced by this word; the word itself where it is none.
  [[nodiscard]] std::string nameIn(const std::string& word) const;
};

MeshText objText(const std::string& file);
/// Empty for a binary file.
std::optional<MeshText> stlText(const std::string& file);

}  // namespace vps::scenes::import

// SPDX-License-Identifier: BSD-3-Clause
// A scene of any number of turned parts: one pin is put into its bush, the others stand around them.
#pragma once

#include <cstddef>
#include <filesystem>

namespace vps::bench {

struct ManyParts {
  std::size_t parts = 1000;      ///< 2 or more
  std::size_t triangles = 5000;  ///< of each part, about
  std::size_t shapes = 0;        ///< how many different ones stand around; 0: each part is of its own
};

/// Writes scene.toml and a mesh for each shape (STL, metres), and returns the scene file.
std::filesystem::path writeManyParts(const std::filesystem::path& folder, const ManyParts& size);

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
// The products whose loading is measured.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vps::bench {

/// The size of a scene of turned parts: one pin is put into its bush, and other parts stand around them.
struct ManyParts {
  std::size_t parts = 1000;      ///< 2 or more
  std::size_t triangles = 5000;  ///< triangles of each part, approximately
  std::size_t shapes = 0;        ///< number of different shapes of the other parts; 0: each part differs
};

/// Writes scene.toml and a mesh for each shape (STL, metres), and returns the scene file.
std::filesystem::path writeManyParts(const std::filesystem::path& folder, const ManyParts& size);

/// The size of the product of writeProduct().
struct ProductSize {
  int solids = 0, faces = 0;
};

/// @param is_shared  equal solids refer to one product of the file; otherwise each has faces of its own, as
/// in the files of many exporters
///                   the files of many exporters
ProductSize writeProduct(const std::string& file, bool is_shared);

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
// The products whose loading is measured.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace vps::bench {

/// The size of a scene of turned parts: one pin is put into its bush, the others stand around them.
struct ManyParts {
  std::size_t parts = 1000;      ///< 2 or more
  std::size_t triangles = 5000;  ///< of each part, about
  std::size_t shapes = 0;        ///< how many different ones stand around; 0: each part is of its own
};

/// Writes scene.toml and a mesh for each shape (STL, metres), and returns the scene file.
std::filesystem::path writeManyParts(const std::filesystem::path& folder, const ManyParts& size);

/// The size of a product: a gearbox of 67 solids with its fasteners, as a STEP file.
struct ProductSize {
  int solids = 0, faces = 0;
};

/// @param is_shared  equal solids refer to one product of the file; otherwise each has faces of its own, as
/// in
///                   the files of many exporters
ProductSize writeProduct(const std::string& file, bool is_shared);

}  // namespace vps::bench

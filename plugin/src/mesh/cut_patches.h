// SPDX-License-Identifier: BSD-3-Clause
// Patches of facets that were cut where shells cross or touch. Each patch lies on one side of every other
// shell.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"

namespace vps {

struct CutPatches {
  std::vector<std::uint32_t> patch_of;  ///< by piece: its patch, counted from 0
  std::vector<std::uint32_t> widest;    ///< by patch: its widest piece, where rounding matters least
};

/// Joins pieces across edges that have exactly two pieces; each connected set is a patch. O(n log n).
CutPatches patchesOf(const Mesh& pieces);

Vec3 middleOf(const Mesh& mesh, std::uint32_t triangle);

}  // namespace vps

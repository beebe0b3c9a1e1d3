// SPDX-License-Identifier: BSD-3-Clause
// Facets of different shells that are near each other, and the patches into which such facets are cut. Each
// patch lies on one side of every other shell.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/box.h"
#include "vps/mesh.h"

namespace vps {

using FacetPair = std::array<std::uint32_t, 2>;

/// If there are more pairs of near facets than this, they are not cut. Assumed: cutting them takes a minute.
inline constexpr std::size_t kMostPairs = 4'000'000;

/// The box of one facet, grown by a margin on every side.
Box boxOf(const Mesh& mesh, std::uint32_t triangle, double margin_m);

/// The box of each shell, grown by a margin on every side.
std::vector<Box> boxesOf(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of, double margin_m);

/// Pairs of facets of different shells that may touch, in ascending order. The list is cut off after more
/// than kMostPairs.
/// @param shell_of  by triangle: its shell, counted from 0
std::vector<FacetPair> nearPairs(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of,
                                 double touch_m);

struct CutPatches {
  std::vector<std::uint32_t> patch_of;  ///< by piece: its patch, counted from 0
  std::vector<std::uint32_t> widest;    ///< by patch: its widest piece, where rounding matters least
};

/// Joins pieces across edges that have exactly two pieces; each connected set is a patch. O(n log n).
CutPatches patchesOf(const Mesh& pieces);

Vec3 middleOf(const Mesh& mesh, std::uint32_t triangle);

}  // namespace vps

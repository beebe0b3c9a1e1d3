// SPDX-License-Identifier: BSD-3-Clause
// The union of shells that touch or cross each other.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// Facets of different shells touch if they are nearer to each other than this share of the greatest
/// coordinate: four roundings of a float. Larger gaps may be intended.
inline constexpr double kTouchShare = 0x1p-22;
double touchDistance(const Mesh& mesh);

/// Limit of work for all attempts to unite shells, in steps of about a microsecond on one core: half a
/// minute.
inline constexpr std::int64_t kMostUnionWork = 30'000'000;

struct ShellUnion {
  Mesh mesh;                       ///< closed, without facets inside; empty if no union was found
  std::size_t united_shells = 0;   ///< shells that touch or cross others; 0: there is nothing to unite
  std::size_t covered_shells = 0;  ///< shells that lose surface
  std::size_t covered_facets = 0;  ///< facets of which nothing is left
};

/// The surface across which the winding number of all shells passes 0.5. Facets are cut where shells cross or
/// touch [arrangement; Zhou, Grinspun, Zorin and Jacobson 2016]; the pieces form patches, bounded by edges
/// where more than two pieces meet, and one point of each patch decides whether it is kept. Of flush pieces
/// one is kept if they face the same way, and none if two shells touch there. The result is checked: its
/// edges are closed, and at spread points that are not on a surface it has the same inside as the shells.
/// Shells that touch no other are not changed. Parallel; the same bits for any number of threads. O(n log n)
/// for the boxes of shells that overlap, and one winding number for each patch. The work is counted, and no
/// union is returned if it would take more than about half a minute.
/// @param shell_of  by triangle: its shell, counted from 0; each shell is closed and has one orientation
ShellUnion unite(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of);

/// True if facets of different shells touch or cross each other, and also if it is not known whether they do.
/// The shells need not be closed.
bool haveContact(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of);

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// The union of shells that touch or cross each other.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// Facets of different shells that are nearer to each other than this share of the greatest coordinate touch:
/// four roundings of a float. Larger gaps may be meant.
inline constexpr double kTouchShare = 0x1p-22;
double touchDistance(const Mesh& mesh);

/// Steps of about a microsecond on one core: half a minute, for all tries to unite shells together.
inline constexpr std::int64_t kMostUnionWork = 30'000'000;

struct ShellUnion {
  Mesh mesh;                       ///< closed, without facets inside; empty if it was not found
  std::size_t united_shells = 0;   ///< that touch or cross others; 0: there is nothing to unite
  std::size_t covered_shells = 0;  ///< that lose surface
  std::size_t covered_facets = 0;  ///< of which nothing is left
};

/// The surface on which the winding number of all shells changes between above 0.5 and below. Facets are cut
/// where shells cross or touch [arrangement; Zhou, Grinspun, Zorin and Jacobson 2016]; the pieces fall into
/// patches, between edges where more than two pieces meet; of each patch one point decides. Of flush pieces
/// one is kept where they face the same way, and none where two shells touch. The result is checked: its
/// edges are closed, and at spread points that are not on a surface it is inside where the shells are. Much
/// is left as it is: shells that touch nothing are only looked at. Parallel; the same bits for any number of
/// threads. O(n log n) for the boxes of shells that overlap, and one winding number for each patch. The work
/// is counted, and none is found where it would take more than about half a minute.
/// @param shell_of  by triangle, counted from 0; each shell is closed and has one orientation
ShellUnion unite(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of);

/// Whether facets of different shells touch or cross each other, which need not be closed here. True too
/// where that is not known.
bool haveContact(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of);

}  // namespace vps

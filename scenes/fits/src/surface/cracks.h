// SPDX-License-Identifier: BSD-3-Clause
// Which facets lie beside each other, and the cracks where none does.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"

namespace vps::scenes {

/// The facet beyond each edge of each triangle (edge i from corner i to the next); kNoFacet at an edge that
/// does not have exactly two facets.
inline constexpr std::uint32_t kNoFacet = ~std::uint32_t{0};
std::vector<std::array<std::uint32_t, 3>> neighboursOf(const Mesh& mesh);

struct Crack {
  Vec3 p_P;        ///< a corner of an open edge
  double width_m;  ///< to the nearest other open edge
};

/// Cracks are narrow beside the edges that they part, and beside the part; anything wider is a hole. A corner
/// in which a crack ends has none. O(n log n).
std::vector<Crack> cracksOf(const Mesh& mesh, const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                            const BoxTree& tree);

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The edges of a mesh, each with the triangles that share it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "vps/mesh.h"

namespace vps {

/// One side of a triangle: vertices low < high, which triangle, which of its sides (0 ab, 1 bc, 2 ca).
struct HalfEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint8_t side;
  bool is_forward;  ///< the triangle runs from low to high
};

/// All sides of all triangles, those of one edge together and by triangle. Triangles with a repeated corner
/// have none. O(n log n).
inline std::vector<HalfEdge> sortedHalfEdges(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::uint8_t side = 0; side < 3; ++side) {
      const std::uint32_t from = t[side], to = t[(side + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), i, side, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return edges;
}

/// Calls visit with the half-edges of each edge in turn.
template <typename Visit>
void forEachEdge(const std::vector<HalfEdge>& edges, Visit visit) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    visit(std::span<const HalfEdge>(edges).subspan(i, end - i));
    i = end;
  }
}

}  // namespace vps

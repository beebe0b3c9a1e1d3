// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/flat_facets.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/mesh_edges.h"

namespace vps {
namespace {

using FacetCorners = std::array<std::uint32_t, 3>;

double sideLength2(const Mesh& mesh, const FacetCorners& t, std::size_t k) {
  return (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).squaredNorm();
}
std::size_t longestSide(const Mesh& mesh, const FacetCorners& t) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (sideLength2(mesh, t, k) > sideLength2(mesh, t, longest)) longest = k;
  return longest;
}

/// True if the facet counts as degenerate in checkMesh().
bool hasNoArea(const Mesh& mesh, const FacetCorners& t) {
  const Vec3& a = mesh.vertices[t[0]];
  const Vec3 n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
  return hasRepeatedCorner(t) || n.norm() <= 1e-12 * sideLength2(mesh, t, longestSide(mesh, t));
}

/// One round of leaving out facets without area. Each round splits a facet at most once.
class FlatFacets {
 public:
  explicit FlatFacets(Mesh& mesh)
      : mesh_(mesh), edges_(sortedHalfEdges(mesh)), is_done_(mesh.triangles.size(), 0) {}

  /// False if there were no facets without area.
  bool leaveOut() {
    const std::size_t count = mesh_.triangles.size();
    bool has_any = false;
    for (std::uint32_t i = 0; i < count; ++i)
      if (hasNoArea(mesh_, mesh_.triangles[i])) has_any = true, leaveOut(i);
    std::erase_if(mesh_.triangles, hasRepeatedCorner);
    return has_any;
  }

 private:
  /// A facet that is left out gets the same vertex for all three corners.
  void leaveOut(std::uint32_t i) {
    const FacetCorners t = mesh_.triangles[i];
    if (hasRepeatedCorner(t) || is_done_[i] != 0) return;
    const std::size_t k = longestSide(mesh_, t);
    const std::uint32_t from = t[k], to = t[(k + 1) % 3], middle = t[(k + 2) % 3];
    const HalfEdge* const across = facetAcross(from, to);
    if (across != nullptr) {
      if (is_done_[across->triangle] != 0) return;  // in the next round
      split(*across, middle);
    }
    mesh_.triangles[i] = {from, from, from};
    is_done_[i] = 1;
  }

  /// A facet whose side runs from `to` to `from`, or null; if possible one that was not split in this round.
  [[nodiscard]] const HalfEdge* facetAcross(std::uint32_t from, std::uint32_t to) const {
    const std::uint32_t low = std::min(from, to), high = std::max(from, to);
    auto e = std::lower_bound(edges_.begin(), edges_.end(), low, [&](const HalfEdge& edge, std::uint32_t) {
      return edge.low != low ? edge.low < low : edge.high < high;
    });
    const HalfEdge* found = nullptr;
    for (; e != edges_.end() && e->low == low && e->high == high; ++e)
      if (e->is_forward == (to < from) && (found == nullptr || is_done_[found->triangle] != 0)) found = &*e;
    return found;
  }

  void split(const HalfEdge& side, std::uint32_t at) {
    const FacetCorners t = mesh_.triangles[side.triangle];
    const std::uint32_t a = t[side.side], b = t[(side.side + 1u) % 3], apex = t[(side.side + 2u) % 3];
    mesh_.triangles[side.triangle] = {a, at, apex};
    mesh_.triangles.push_back({at, b, apex});
    is_done_[side.triangle] = 1;
  }

  Mesh& mesh_;
  const std::vector<HalfEdge> edges_;
  std::vector<char> is_done_;  // by given facet: left out, or split
};

}  // namespace

std::optional<Mesh> withoutFlatFacets(Mesh mesh) {
  constexpr int kRounds = 64;  // a fan of facets without area needs one round for each of them
  for (int round = 0; round < kRounds; ++round)
    if (!FlatFacets(mesh).leaveOut()) return mesh;
  return std::nullopt;
}

}  // namespace vps

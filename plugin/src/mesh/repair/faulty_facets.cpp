// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/repair/mesh_faults.h"

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/mesh_edges.h"
#include "vps/stoppable.h"

namespace vps {

std::vector<std::uint8_t> findDuplicates(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                         const std::vector<HalfEdge>& edges) {
  // In each set of duplicates the first triangle of the majority orientation is kept; if the two orientations
  // balance, the first triangle is kept for now, and the code below decides about it.
  std::vector<std::uint8_t> is_dropped(triangles.size(), 0), is_pair(triangles.size(), 0);
  forEachTwin(triangles, [&](std::span<const Twin> same) {
    const auto& corners = same[0].corners;
    if (corners[0] == corners[1] || corners[1] == corners[2]) return;
    const auto even = static_cast<std::size_t>(
        std::count_if(same.begin(), same.end(), [](const Twin& t) { return t.is_even; }));
    const bool is_balanced = 2 * even == same.size();
    bool has_kept = false;
    for (const Twin& t : same) {
      const bool is_first = !has_kept && (is_balanced || t.is_even == (2 * even > same.size()));
      has_kept |= is_first;
      is_dropped[t.triangle] = !is_first;
      is_pair[t.triangle] = is_balanced;
    }
  });
  Groups groups(triangles.size());  // connected pairs
  std::vector<std::uint8_t> ends_at_even(triangles.size(), 0), ends_at_odd(triangles.size(), 0);
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    std::uint32_t first = UINT32_MAX;
    std::size_t others = 0;
    for (const HalfEdge& e : same) {
      others += !is_pair[e.triangle] && !is_dropped[e.triangle];
      if (!is_pair[e.triangle]) continue;
      if (first == UINT32_MAX) first = e.triangle;
      groups.join(e.triangle, first);
    }
    if (first == UINT32_MAX || others == 0) return;
    (others % 2 == 0 ? ends_at_even : ends_at_odd)[first] = 1;
  });
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t root = groups.find(i);
    ends_at_even[root] |= ends_at_even[i];
    ends_at_odd[root] |= ends_at_odd[i];
  }
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t root = groups.find(i);
    is_dropped[i] |= is_pair[i] && ends_at_even[root] && !ends_at_odd[root];
  }
  return is_dropped;
}

void surveyOpenEdges(const Mesh& mesh, const std::vector<HalfEdge>& edges, MeshReport& report) {
  std::vector<std::array<std::uint32_t, 2>> open;
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    if (same.size() == 1) open.push_back({same[0].low, same[0].high});
  });
  std::vector<std::uint32_t> corners;
  for (const auto& e : open) corners.insert(corners.end(), e.begin(), e.end());
  const auto x = [&](std::uint32_t v) { return mesh.vertices[v].x(); };
  std::sort(corners.begin(), corners.end(),
            [&](std::uint32_t a, std::uint32_t b) { return x(a) != x(b) ? x(a) < x(b) : a < b; });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  // Exporters round to floats: 1e-7 of the size, and somewhat more after a rotation.
  const double tolerance_m = 1e-6 * bounds(mesh).size().norm();
  Groups groups(mesh.vertices.size());
  for (const auto& [a, b] : open) {
    pollStop();
    groups.join(a, b);
    const Vec3 &from = mesh.vertices[a], &to = mesh.vertices[b];
    const auto first =
        std::lower_bound(corners.begin(), corners.end(), std::min(from.x(), to.x()) - tolerance_m,
                         [&](std::uint32_t v, double at) { return x(v) < at; });
    for (auto v = first; v != corners.end() && x(*v) <= std::max(from.x(), to.x()) + tolerance_m; ++v) {
      if (*v == a || *v == b) continue;
      const Vec3 along = to - from, p = mesh.vertices[*v] - from;
      const double t = p.dot(along) / along.squaredNorm();
      const double ends = tolerance_m / along.norm();
      report.t_junctions += t > ends && t < 1 - ends && (p - t * along).norm() < tolerance_m;
    }
  }
  for (const std::uint32_t v : corners) report.holes += groups.find(v) == v;
}

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

/// One pass that leaves out facets without area. Each pass splits a facet at most once.
class FlatFacets {
 public:
  explicit FlatFacets(Mesh& mesh)
      : mesh_(mesh), edges_(sortedHalfEdges(mesh)), is_done_(mesh.triangles.size(), 0) {}

  /// Returns false if there were no facets without area.
  bool leaveOut() {
    const std::size_t count = mesh_.triangles.size();
    bool has_any = false;
    StridedPoll poll;
    for (std::uint32_t i = 0; i < count; ++i, poll())
      if (isDegenerate(mesh_, mesh_.triangles[i])) has_any = true, leaveOut(i);
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
      if (is_done_[across->triangle] != 0) return;  // in the next pass
      split(*across, middle);
    }
    mesh_.triangles[i] = {from, from, from};
    is_done_[i] = 1;
  }

  /// A facet whose side runs from `to` to `from`, or null; if possible one that was not split in this pass.
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
  constexpr int kRounds = 64;  // a fan of facets without area needs one pass for each of its facets
  for (int round = 0; round < kRounds; ++round)
    if (!FlatFacets(mesh).leaveOut()) return mesh;
  return std::nullopt;
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// The edges of a mesh with the triangles that share them, and triangles with equal corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "vps/mesh.h"
#include "vps/stoppable.h"

namespace vps {

inline bool hasRepeatedCorner(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// One side of a triangle: vertices low < high, the triangle, and the side's number in it (0 ab, 1 bc, 2 ca).
struct HalfEdge {
  std::uint32_t low, high;
  std::uint32_t triangle;
  std::uint8_t side;
  bool is_forward;  ///< the triangle's side runs from low to high
};

/// All half-edges of all triangles, grouped by edge and sorted by triangle. Triangles with a repeated corner
/// have no half-edges. O(n): a counting sort by low vertex, then a sort of the few edges of each low vertex.
inline std::vector<HalfEdge> sortedHalfEdges(const Mesh& mesh) {
  const auto forEachSide = [&](auto visit) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto& t = mesh.triangles[i];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      for (std::uint8_t side = 0; side < 3; ++side) {
        const std::uint32_t from = t[side], to = t[(side + 1) % 3];
        visit(HalfEdge{std::min(from, to), std::max(from, to), i, side, from < to});
      }
    }
  };
  // For each low vertex: first the start of the vertex's edges, later their end.
  std::vector<std::size_t> end(mesh.vertices.size() + 1, 0);
  forEachSide([&](const HalfEdge& e) { ++end[e.low + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<HalfEdge> edges(end.back());
  forEachSide([&](const HalfEdge& e) { edges[end[e.low]++] = e; });
  std::size_t first = 0;
  StridedPoll poll;
  for (std::size_t vertex = 0; vertex + 1 < end.size(); first = end[vertex++]) {
    poll();
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(first),
              edges.begin() + static_cast<std::ptrdiff_t>(end[vertex]), [](const auto& a, const auto& b) {
                return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
              });
  }
  return edges;
}

/// Disjoint sets; the root of a set is its lowest member. With path halving O(log n) a call, amortised.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  [[nodiscard]] std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }
  /// The number of each member's set; sets are counted from 0 in the order of their lowest members.
  [[nodiscard]] std::vector<std::uint32_t> numbered() {
    std::vector<std::uint32_t> number(parent_.size());
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
      const std::uint32_t root = find(i);
      number[i] = root == i ? next++ : number[root];
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// True for a triangle that checkMesh() counts as degenerate: its height is below 1e-12 of its longest edge.
bool isDegenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& t);

/// checkMesh() for callers that already have the edges.
/// @param shell_of  if given, receives each triangle's shell, counted from 0; undefined for triangles with
/// repeated corners
MeshReport checkMesh(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                     std::vector<std::uint32_t>* shell_of = nullptr);

/// A triangle by its corners in ascending order.
struct Twin {
  std::array<std::uint32_t, 3> corners;
  std::uint32_t triangle;
  bool is_even;  ///< the triangle runs through its corners in that order
};

/// Calls visit for each set of corners that has more than one triangle, with these triangles in ascending
/// order. O(n log n).
template <typename Visit>
void forEachTwin(const std::vector<std::array<std::uint32_t, 3>>& triangles, Visit visit) {
  std::vector<Twin> twins;
  twins.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    auto corners = triangles[i];
    bool is_even = true;
    const auto order = [&](int a, int b) {
      if (corners[a] < corners[b]) return;
      std::swap(corners[a], corners[b]);
      is_even = !is_even;
    };
    order(0, 1), order(1, 2), order(0, 1);
    twins.push_back({corners, i, is_even});
  }
  std::sort(twins.begin(), twins.end(), [](const Twin& a, const Twin& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.triangle < b.triangle;
  });
  StridedPoll poll;
  for (std::size_t i = 0; i < twins.size();) {
    poll();
    std::size_t end = i + 1;
    while (end < twins.size() && twins[end].corners == twins[i].corners) ++end;
    if (end - i > 1) visit(std::span<const Twin>(twins).subspan(i, end - i));
    i = end;
  }
}

/// Number of facets that run from the lower to the higher vertex of an edge, minus those that run back.
inline int surplusOf(std::span<const HalfEdge> same) {
  int surplus = 0;
  for (const HalfEdge& e : same) surplus += e.is_forward ? 1 : -1;
  return surplus;
}

/// Calls visit for each edge, with its half-edges.
template <typename Visit>
void forEachEdge(std::span<const HalfEdge> edges, Visit visit) {
  StridedPoll poll;
  for (std::size_t i = 0; i < edges.size();) {
    poll();
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    visit(edges.subspan(i, end - i));
    i = end;
  }
}

}  // namespace vps

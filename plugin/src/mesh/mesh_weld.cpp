// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mesh/mesh_edges.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

struct CellHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& k) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : k) {
      // Multiply-xorshift mixing (constant: 2^64 / golden ratio, odd).
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
};

using CellKey = std::array<std::int64_t, 3>;

/// Gives every vertex the index of the first vertex equal to it, and the list of such first vertices.
struct Merger {
  const Mesh& mesh;
  std::vector<Vec3> kept;
  std::vector<std::uint32_t> index_of;

  explicit Merger(const Mesh& m) : mesh(m) {
    kept.reserve(m.vertices.size());
    index_of.reserve(m.vertices.size());
  }

  std::uint32_t keep(const Vec3& p) {
    kept.push_back(p);
    return static_cast<std::uint32_t>(kept.size() - 1);
  }

  /// Finds vertices that are equal to the bit, in a hash table of indices that is at most half full.
  void exact() {
    std::size_t size = 16;
    while (size < 2 * mesh.vertices.size()) size *= 2;
    std::vector<std::uint32_t> table(size, UINT32_MAX);
    StridedPoll poll;
    for (const Vec3& p : mesh.vertices) {
      poll();
      // Squares of numbers below 1e-150 underflow, so lengths would be zero. Adding +0 turns -0 into +0.
      const Vec3 q = (p.array().abs() < 1e-150).select(0.0, p.array()).matrix() + Vec3::Zero();
      CellKey key;
      for (int i = 0; i < 3; ++i) key[i] = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(q[i]));
      std::size_t at = CellHash()(key) & (size - 1);
      while (table[at] != UINT32_MAX && kept[table[at]] != q) at = (at + 1) & (size - 1);
      if (table[at] == UINT32_MAX) table[at] = keep(q);
      index_of.push_back(table[at]);
    }
  }

  /// Finds vertices in cells as wide as the tolerance: all near vertices are in the 27 cells around a vertex.
  void within(double tolerance_m) {
    std::unordered_map<CellKey, std::vector<std::uint32_t>, CellHash> cells(mesh.vertices.size());
    StridedPoll poll;
    for (const Vec3& p : mesh.vertices) {
      poll();
      const CellKey home = {static_cast<std::int64_t>(std::floor(p.x() / tolerance_m)),
                            static_cast<std::int64_t>(std::floor(p.y() / tolerance_m)),
                            static_cast<std::int64_t>(std::floor(p.z() / tolerance_m))};
      std::uint32_t found = UINT32_MAX;
      for (int n = 0; n < 27; ++n) {
        const auto cell = cells.find({home[0] + n / 9 - 1, home[1] + n / 3 % 3 - 1, home[2] + n % 3 - 1});
        if (cell == cells.end()) continue;
        for (const std::uint32_t i : cell->second)
          if ((kept[i] - p).squaredNorm() <= tolerance_m * tolerance_m) found = std::min(found, i);
      }
      if (found == UINT32_MAX) {
        found = keep(p);
        cells[home].push_back(found);
      }
      index_of.push_back(found);
    }
  }
};

}  // namespace

WeldedMesh weldedWithSources(const Mesh& mesh, double tolerance_m) {
  Merger merger(mesh);
  if (tolerance_m > 0)
    merger.within(tolerance_m);
  else
    merger.exact();
  WeldedMesh out;
  out.mesh.triangles.reserve(mesh.triangles.size());
  out.sources.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& t = mesh.triangles[i];
    const std::array<std::uint32_t, 3> merged = {merger.index_of[t[0]], merger.index_of[t[1]],
                                                 merger.index_of[t[2]]};
    if (hasRepeatedCorner(merged)) continue;
    out.mesh.triangles.push_back(merged);
    out.sources.push_back(i);
  }
  out.mesh.vertices = std::move(merger.kept);
  return out;
}

Mesh welded(const Mesh& mesh, double tolerance_m) {
  return weldedWithSources(mesh, tolerance_m).mesh;
}

}  // namespace vps

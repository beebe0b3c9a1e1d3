// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "mesh/mesh_edges.h"
#include "vps/load_error.h"
#include "vps/mesh_weld.h"

namespace vps::inline v0 {
namespace {

Vec3 areaVector(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

bool hasRepeatedCorner(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool isDegenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  if (hasRepeatedCorner(t)) return true;
  double longest_m2 = 0;
  for (int i = 0; i < 3; ++i)
    longest_m2 = std::max(longest_m2, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).squaredNorm());
  // Height below 1e-12 of the longest edge: the normal is rounding noise.
  return 2 * areaVector(mesh, t).norm() <= 1e-12 * longest_m2;
}

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

/// Gives every vertex the index of the first vertex equal to it, and that list. Exact case: the key is the
/// value.
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

  /// A table of indices, open addressing: half full at most, so that a search ends soon.
  void exact() {
    std::size_t size = 16;
    while (size < 2 * mesh.vertices.size()) size *= 2;
    std::vector<std::uint32_t> table(size, UINT32_MAX);
    for (const Vec3& p : mesh.vertices) {
      // Squares of numbers below 1e-150 underflow, and lengths with them. Adding +0 turns -0 into +0.
      const Vec3 q = (p.array().abs() < 1e-150).select(0.0, p.array()).matrix() + Vec3::Zero();
      CellKey key;
      for (int i = 0; i < 3; ++i) key[i] = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(q[i]));
      std::size_t at = CellHash()(key) & (size - 1);
      while (table[at] != UINT32_MAX && kept[table[at]] != q) at = (at + 1) & (size - 1);
      if (table[at] == UINT32_MAX) table[at] = keep(q);
      index_of.push_back(table[at]);
    }
  }

  /// Cells as wide as the tolerance: all near vertices are in the 27 cells around a vertex.
  void within(double tolerance_m) {
    std::unordered_map<CellKey, std::vector<std::uint32_t>, CellHash> cells(mesh.vertices.size());
    for (const Vec3& p : mesh.vertices) {
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

Box bounds(const Mesh& mesh) {
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) box.add(mesh.vertices[i]);
  return box;
}

double area(const Mesh& mesh) {
  double sum_m2 = 0;
  for (const auto& t : mesh.triangles) sum_m2 += areaVector(mesh, t).norm();
  return sum_m2;
}

MassProperties massProperties(const Mesh& mesh) {
  // Tetrahedra from a point in the middle of the body to each triangle: far from the origin the sums would
  // cancel.
  const Vec3 o = bounds(mesh).center();
  double det_sum = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
    const double det = a.dot(b.cross(c));  // six times the signed volume
    const Vec3 s = a + b + c;
    det_sum += det;
    first += det * s;
    second += det * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  MassProperties mass;
  mass.volume_m3 = det_sum / 6;
  if (mass.volume_m3 == 0) return mass;
  const Vec3 com = first / 24 / mass.volume_m3;
  const Mat3 moments = second / 120 - mass.volume_m3 * com * com.transpose();
  mass.com = o + com;
  mass.inertia_m5 = moments.trace() * Mat3::Identity() - moments;
  return mass;
}

Mesh transformed(const Mesh& mesh, const Pose& X_AB) {
  Mesh moved = mesh;
  for (Vec3& p : moved.vertices) p = X_AB * p;
  return moved;
}

void append(Mesh& a, const Mesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  a.triangles.reserve(a.triangles.size() + b.triangles.size());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

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

MeshReport checkMesh(const Mesh& mesh) {
  return checkMesh(mesh, sortedHalfEdges(mesh));
}

MeshReport checkMesh(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                     std::vector<std::uint32_t>* shell_of) {
  MeshReport report;
  report.triangles = mesh.triangles.size();
  for (const auto& t : mesh.triangles) report.degenerate_triangles += isDegenerate(mesh, t);

  const auto opposite = [&](const HalfEdge& e) { return mesh.triangles[e.triangle][(e.side + 2) % 3]; };
  bool has_duplicates = false;
  Groups groups(mesh.triangles.size());
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    for (const HalfEdge& e : same.subspan(1)) groups.join(e.triangle, same.front().triangle);
    if (same.size() == 1) ++report.open_edges;
    if (same.size() == 2 && same[0].is_forward == same[1].is_forward) ++report.flipped_edges;
    if (same.size() > 2) ++report.non_manifold_edges;
    // Duplicates share their edges, so most meshes need no second sort.
    for (std::size_t i = 1; i < same.size(); ++i)
      has_duplicates |= opposite(same[i]) == opposite(same[i - 1]) || same.size() > 2;
  });
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    report.shells += groups.find(i) == i && !hasRepeatedCorner(mesh.triangles[i]);
  if (shell_of != nullptr && report.shells > 1) *shell_of = groups.numbered();
  if (shell_of != nullptr && report.shells <= 1) shell_of->assign(mesh.triangles.size(), 0);
  if (has_duplicates)
    forEachTwin(mesh.triangles,
                [&](std::span<const Twin> same) { report.duplicate_triangles += same.size() - 1; });
  return report;
}

void requireUsable(const Mesh& mesh, const std::string& file, const std::string& part) {
  if (mesh.triangles.empty()) throw LoadError(file, part, "has no triangles; export it as a triangle mesh");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw LoadError(file, part,
                      "vertex " + std::to_string(i) +
                          (mesh.vertices[i].hasNaN() ? " is not a number" : " is infinite") +
                          "; export it again");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v >= mesh.vertices.size())
        throw LoadError(file, part,
                        "triangle " + std::to_string(i) + " names vertex " + std::to_string(v) + " of " +
                            std::to_string(mesh.vertices.size()) + "; export it again");
  const double area_m2 = area(mesh);
  if (!std::isfinite(area_m2))
    throw LoadError(file, part, "is too large for its area to be a number; check its unit");
  if (!(area_m2 > 0))
    throw LoadError(file, part, "has zero area: all triangles are points or lines; export it again");
}

}  // namespace vps::inline v0

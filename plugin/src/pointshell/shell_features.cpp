// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "mesh/mesh_edges.h"
#include "mesh/normals.h"
#include "pointshell/shell_samples.h"

namespace vps {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;

/// An edge sharper than the limit, or an edge that does not join exactly two triangles.
struct SharpEdge {
  std::uint32_t low, high;
  Vec3 normal;  ///< pseudonormal: the mean of its triangles' normals
  bool is_visited = false;
};

/// A chain of vertices with the sharp edges between them. A closed chain repeats its first vertex.
struct Chain {
  std::vector<std::uint32_t> vertices, edges;
};

class FeatureSampler {
 public:
  FeatureSampler(const Mesh& mesh, const std::vector<Vec3>& normals, double step_m, double tolerance_m,
                 double edge_angle_rad)
      : mesh_(mesh),
        normals_(normals),
        step_m_(step_m),
        tolerance_m_(tolerance_m),
        cos_limit_(std::cos(edge_angle_rad)) {
    vertex_normals_ = angleWeightedNormals(mesh, normals);
    for (Vec3& n : vertex_normals_)
      if (n.norm() > 0) n.normalize();
    findSharpEdges();
    findCorners();
  }

  std::vector<ShellSample> run() {
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
      if (is_corner_[v]) addVertex(v);
    // First chains between corners; the edges that remain form loops without a corner.
    for (const bool starts_at_corner : {true, false})
      for (std::uint32_t e = 0; e < edges_.size(); ++e)
        for (const std::uint32_t start : {edges_[e].low, edges_[e].high})
          if (!edges_[e].is_visited && (is_corner_[start] || !starts_at_corner)) sample(walk(start, e));
    return std::move(samples_);
  }

 private:
  void findSharpEdges() {
    forEachEdge(sortedHalfEdges(mesh_), [this](std::span<const HalfEdge> sides) {
      Vec3 sum = Vec3::Zero();
      for (const HalfEdge& side : sides) sum += normals_[side.triangle];
      // A triangle without a normal hides the facet behind it; therefore its edges count as sharp.
      if (sides.size() == 2 && normals_[sides[0].triangle].dot(normals_[sides[1].triangle]) >= cos_limit_)
        return;
      edges_.push_back({sides[0].low, sides[0].high, unitOr(sum, normals_[sides[0].triangle])});
    });
    edges_of_.assign(mesh_.vertices.size(), {0, 0});
    for (const SharpEdge& e : edges_) {
      ++edges_of_[e.low].count;
      ++edges_of_[e.high].count;
    }
    std::uint32_t first = 0;
    for (EdgeRange& range : edges_of_) {
      range.first = first;
      first += range.count;
      range.count = 0;
    }
    edge_list_.resize(first);
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      for (const std::uint32_t v : {edges_[e].low, edges_[e].high})
        edge_list_[edges_of_[v].first + edges_of_[v].count++] = e;
  }

  void findCorners() {
    is_corner_.assign(mesh_.vertices.size(), false);
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      const EdgeRange& range = edges_of_[v];
      if (range.count == 0) continue;
      is_corner_[v] = range.count != 2 || turnsAt(v);
    }
    // Tips: vertices without a sharp edge whose normal differs much from that of a triangle around them.
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t])
        if (edges_of_[v].count == 0 && !normals_[t].isZero(0) &&
            vertex_normals_[v].dot(normals_[t]) < cos_limit_)
          is_corner_[v] = true;
  }

  [[nodiscard]] bool turnsAt(std::uint32_t v) const {
    const std::uint32_t* pair = &edge_list_[edges_of_[v].first];
    const Vec3 in = mesh_.vertices[v] - mesh_.vertices[otherEnd(pair[0], v)];
    const Vec3 out = mesh_.vertices[otherEnd(pair[1], v)] - mesh_.vertices[v];
    return in.dot(out) < cos_limit_ * in.norm() * out.norm();
  }

  [[nodiscard]] Chain walk(std::uint32_t start, std::uint32_t first_edge) {
    Chain chain;
    chain.vertices.push_back(start);
    for (std::uint32_t e = first_edge, v = start; e != kNone;) {
      edges_[e].is_visited = true;
      v = otherEnd(e, v);
      chain.edges.push_back(e);
      chain.vertices.push_back(v);
      e = is_corner_[v] ? kNone : unvisitedEdgeAt(v);
    }
    return chain;
  }

  /// Adds points along a chain. The next point after each point is the farthest vertex that step and
  /// tolerance allow.
  void sample(const Chain& chain) {
    addVertex(chain.vertices.front());
    for (std::size_t i = 0; i + 1 < chain.vertices.size();) {
      std::size_t next = i + 1;
      double length_m = edgeLength(chain, i);
      while (next + 1 < chain.vertices.size()) {
        length_m += edgeLength(chain, next);
        if (length_m > step_m_ || !isNearChord(chain, i, next + 1)) break;
        ++next;
      }
      if (next == i + 1) addBetween(chain, i);
      addVertex(chain.vertices[next]);
      i = next;
    }
  }

  [[nodiscard]] bool isNearChord(const Chain& chain, std::size_t from, std::size_t to) const {
    const Vec3& a = mesh_.vertices[chain.vertices[from]];
    const Vec3 chord = mesh_.vertices[chain.vertices[to]] - a;
    for (std::size_t k = from + 1; k < to; ++k)
      if (chord.cross(mesh_.vertices[chain.vertices[k]] - a).norm() > tolerance_m_ * chord.norm())
        return false;
    return true;
  }

  /// Adds evenly spaced points inside one long segment.
  void addBetween(const Chain& chain, std::size_t i) {
    const Vec3 &a = mesh_.vertices[chain.vertices[i]], &b = mesh_.vertices[chain.vertices[i + 1]];
    const double parts = std::ceil((b - a).norm() / step_m_ * (1 - 1e-9));  // rounding must not add a point
    for (double k = 1; k < parts; ++k)
      samples_.push_back({a + (k / parts) * (b - a), edges_[chain.edges[i]].normal});
  }

  void addVertex(std::uint32_t v) {
    if (is_added_.empty()) is_added_.assign(mesh_.vertices.size(), false);
    if (is_added_[v]) return;
    is_added_[v] = true;
    const std::uint32_t e = edges_of_[v].count > 0 ? edge_list_[edges_of_[v].first] : kNone;
    samples_.push_back(
        {mesh_.vertices[v], unitOr(vertex_normals_[v], e == kNone ? Vec3::UnitZ() : edges_[e].normal)});
  }

  [[nodiscard]] const Vec3& corner(std::size_t t, int k) const {
    return mesh_.vertices[mesh_.triangles[t][k]];
  }
  [[nodiscard]] std::uint32_t otherEnd(std::uint32_t e, std::uint32_t v) const {
    return edges_[e].low == v ? edges_[e].high : edges_[e].low;
  }
  [[nodiscard]] std::uint32_t unvisitedEdgeAt(std::uint32_t v) const {
    for (std::uint32_t k = 0; k < edges_of_[v].count; ++k) {
      const std::uint32_t e = edge_list_[edges_of_[v].first + k];
      if (!edges_[e].is_visited) return e;
    }
    return kNone;
  }
  [[nodiscard]] double edgeLength(const Chain& chain, std::size_t i) const {
    return (mesh_.vertices[chain.vertices[i + 1]] - mesh_.vertices[chain.vertices[i]]).norm();
  }
  /// Normalises v; returns the fallback if v is too short to have a direction (two faces back to back).
  static Vec3 unitOr(const Vec3& v, const Vec3& fallback) {
    const double length = v.norm();
    if (length > 1e-9) return v / length;
    return fallback.isZero(0) ? Vec3(Vec3::UnitZ()) : fallback;
  }

  struct EdgeRange {
    std::uint32_t first, count;
  };
  const Mesh& mesh_;
  const std::vector<Vec3>& normals_;
  double step_m_, tolerance_m_, cos_limit_;
  std::vector<Vec3> vertex_normals_;
  std::vector<SharpEdge> edges_;
  std::vector<EdgeRange> edges_of_;  ///< by vertex: its range of edge_list_
  std::vector<std::uint32_t> edge_list_;
  std::vector<bool> is_corner_, is_added_;
  std::vector<ShellSample> samples_;
};

}  // namespace

std::vector<ShellSample> sampleFeatures(const Mesh& mesh, const std::vector<Vec3>& normals, double step_m,
                                        double tolerance_m, double edge_angle_rad) {
  return FeatureSampler(mesh, normals, step_m, tolerance_m, edge_angle_rad).run();
}

namespace {

/// Appends samples of the border. A sample at a corner faces the mean of the directions out of its edges.
/// Each sample represents a square of step_m.
void addBorder(const Mesh& mesh, double step_m, std::vector<ShellSample>& samples) {
  std::map<std::uint32_t, Vec3> corners;
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    if (same.size() != 1) return;
    const HalfEdge& e = same[0];
    const Vec3 &a = mesh.vertices[e.low], way = mesh.vertices[e.high] - a;
    const Vec3 to_apex = mesh.vertices[mesh.triangles[e.triangle][(e.side + 2U) % 3]] - a;
    const Vec3 into = to_apex - way * (to_apex.dot(way) / way.squaredNorm());
    if (!(into.norm() > 0)) return;
    const Vec3 outward = -into.normalized();
    const int pieces = static_cast<int>(std::ceil(way.norm() / step_m));
    for (int k = 1; k < pieces; ++k)
      samples.push_back({a + (double(k) / pieces) * way, outward, step_m * step_m});
    for (const std::uint32_t v : {e.low, e.high})
      corners.try_emplace(v, Vec3::Zero()).first->second += outward;
  });
  for (const auto& [v, sum] : corners)
    if (sum.norm() > 1e-6) samples.push_back({mesh.vertices[v], sum.normalized(), step_m * step_m});
}

}  // namespace

void addOtherSides(const Mesh& mesh, double step_m, std::vector<ShellSample>& samples) {
  const std::size_t count = samples.size();
  for (std::size_t i = 0; i < count; ++i)
    samples.push_back({samples[i].p, -samples[i].outward, samples[i].area_m2});
  addBorder(welded(mesh), step_m, samples);
}

}  // namespace vps

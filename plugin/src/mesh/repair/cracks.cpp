// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/repair/mesh_faults.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

constexpr double kNarrowest = 1e-7;
/// A gap may be at most this share of the edges beside it; a wider gap may be the part's shape.
constexpr double kMaxGapShare = 0.25;

/// Calls visit with every edge that has exactly one facet.
template <typename Visit>
void forEachOpenEdge(const std::vector<HalfEdge>& edges, Visit visit) {
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    if (same.size() == 1) visit(same[0]);
  });
}

double lengthOf(const Mesh& mesh, const HalfEdge& e) {
  return (mesh.vertices[e.high] - mesh.vertices[e.low]).norm();
}

double openLength(const Mesh& mesh, const std::vector<HalfEdge>& edges) {
  double sum_m = 0;
  forEachOpenEdge(edges, [&](const HalfEdge& e) { sum_m += lengthOf(mesh, e); });
  return sum_m;
}

class Joiner {
 public:
  Joiner(const Mesh& mesh, const std::vector<HalfEdge>& edges)
      : mesh_(mesh),
        edges_(edges),
        is_open_(mesh.vertices.size(), 0),
        reach_m_(mesh.vertices.size(), 1e300),
        points_(pointsOf(mesh)),
        tree_(points_) {
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const double reach_m = kMaxGapShare * (mesh.vertices[b] - mesh.vertices[a]).norm();
        reach_m_[a] = std::min(reach_m_[a], reach_m);
        reach_m_[b] = std::min(reach_m_[b], reach_m);
      }
    forEachOpenEdge(edges, [&](const HalfEdge& e) { is_open_[e.low] = is_open_[e.high] = 1; });
  }

  [[nodiscard]] JoinedFacets within(double tolerance_m) const {
    Groups groups(mesh_.vertices.size());
    bool has_joined = false;
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (!is_open_[v]) continue;
      pollStop();
      forEachNear(mesh_.vertices[v], mesh_.vertices[v], tolerance_m, [&](std::uint32_t other) {
        const double gap_m = (mesh_.vertices[other] - mesh_.vertices[v]).norm();
        if (other == v || gap_m > std::min({tolerance_m, reach_m_[v], reach_m_[other]})) return;
        groups.join(v, other);
        has_joined = true;
      });
    }
    Mesh merged{mesh_.vertices, mesh_.triangles};
    for (auto& t : merged.triangles)
      for (std::uint32_t& v : t) v = groups.find(v);
    JoinedFacets joined;
    joined.edges = cut(has_joined ? sortedHalfEdges(merged) : edges_, groups, tolerance_m);
    joined.triangles = std::move(merged.triangles);
    joined.open_m = openLength(mesh_, joined.edges);
    return joined;
  }

 private:
  static std::vector<Box> pointsOf(const Mesh& mesh) {
    std::vector<Box> points;
    for (const Vec3& p : mesh.vertices) points.push_back({p, p});
    return points;
  }

  /// Calls visit with the vertices near segment ab.
  template <typename Visit>
  void forEachNear(const Vec3& a, const Vec3& b, double tolerance_m, Visit visit) const {
    Box box;
    box.add(a), box.add(b);
    box.min.array() -= tolerance_m;
    box.max.array() += tolerance_m;
    tree_.forEachOverlap(points_, box, [&](std::uint32_t v) { return visit(v), true; });
  }

  /// Cuts open edges at vertices of other open edges that lie on them.
  std::vector<HalfEdge> cut(const std::vector<HalfEdge>& edges, Groups& groups, double tolerance_m) const {
    std::vector<std::uint8_t> has_open(mesh_.vertices.size(), 0);  // of merged vertices
    forEachOpenEdge(edges, [&](const HalfEdge& e) { has_open[e.low] = has_open[e.high] = 1; });
    std::vector<HalfEdge> pieces;
    pieces.reserve(edges.size());
    bool has_cut = false;
    std::vector<std::pair<double, std::uint32_t>> on;  // place along the edge, vertex
    forEachEdge(edges, [&](std::span<const HalfEdge> same) {
      const HalfEdge& e = same[0];
      on.clear();
      if (same.size() == 1) {
        pollStop();
        const Vec3 &from = mesh_.vertices[e.low], along = mesh_.vertices[e.high] - from;
        forEachNear(from, mesh_.vertices[e.high], tolerance_m, [&](std::uint32_t v) {
          if (!has_open[v] || groups.find(v) != v || v == e.low || v == e.high) return;
          const double t = (mesh_.vertices[v] - from).dot(along) / along.squaredNorm();
          const double gap_m = (mesh_.vertices[v] - from - t * along).norm();
          if (t > 0 && t < 1 && gap_m <= std::min(tolerance_m, reach_m_[v])) on.emplace_back(t, v);
        });
      }
      if (on.empty()) {
        pieces.insert(pieces.end(), same.begin(), same.end());
        return;
      }
      has_cut = true;
      std::sort(on.begin(), on.end());
      on.emplace_back(1, e.high);
      std::uint32_t from = e.low;
      for (const auto& [t, to] : on) {
        pieces.push_back(
            {std::min(from, to), std::max(from, to), e.triangle, e.side, (from < to) == e.is_forward});
        from = to;
      }
    });
    if (!has_cut) return pieces;
    std::sort(pieces.begin(), pieces.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
    });
    return pieces;
  }

  const Mesh& mesh_;
  const std::vector<HalfEdge>& edges_;
  std::vector<std::uint8_t> is_open_;  // by vertex: ends an edge that has one facet
  std::vector<double> reach_m_;        // by vertex: the widest gap across which it may be joined
  const std::vector<Box> points_;      // by vertex
  const BoxTree tree_;                 // of points_
};

}  // namespace

JoinedFacets joinFacets(const Mesh& mesh, const std::vector<HalfEdge>& edges, double widest) {
  JoinedFacets best{mesh.triangles, edges, openLength(mesh, edges)};
  if (!(best.open_m > 0)) return best;
  const Joiner joiner(mesh, edges);
  const double size_m = bounds(mesh).size().norm();
  for (double share = kNarrowest; share <= 1.001 * widest && best.open_m > 0; share *= 4) {
    JoinedFacets joined = joiner.within(share * size_m);
    if (joined.open_m < best.open_m) best = std::move(joined);
  }
  return best;
}

LinkedPatches linkPatches(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                          const std::vector<std::uint32_t>& patch_of,
                          const std::vector<std::uint8_t>& is_turned) {
  std::uint32_t count = 0;
  for (const std::uint32_t patch : patch_of) count = std::max(count, patch + 1);
  struct Link {
    std::uint32_t a, b;
    double agree_m;  // length of edges that agree minus length of edges that disagree
  };
  std::vector<Link> links;
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    if (same.size() != 2) return;
    const std::uint32_t a = patch_of[same[0].triangle], b = patch_of[same[1].triangle];
    if (a == b) return;
    const double length_m = lengthOf(mesh, same[0]);
    const bool agrees = (same[0].is_forward != is_turned[same[0].triangle]) !=
                        (same[1].is_forward != is_turned[same[1].triangle]);
    links.push_back({std::min(a, b), std::max(a, b), agrees ? length_m : -length_m});
  });
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return std::tie(a.a, a.b) < std::tie(b.a, b.b); });
  std::size_t last = 0;  // one link for each pair of patches
  for (std::size_t i = 1; i < links.size(); ++i)
    if (links[i].a == links[last].a && links[i].b == links[last].b)
      links[last].agree_m += links[i].agree_m;
    else
      links[++last] = links[i];
  if (!links.empty()) links.resize(last + 1);
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return std::abs(a.agree_m) > std::abs(b.agree_m); });
  // Every patch has two numbers in the groups: 2 patch as given, and 2 patch + 1 turned.
  Groups groups(2 * std::size_t{count});
  for (const Link& link : links) {
    if (groups.find(2 * link.a) == groups.find(2 * link.b) ||
        groups.find(2 * link.a) == groups.find(2 * link.b + 1))
      continue;
    const std::uint32_t opposed = link.agree_m < 0;
    groups.join(2 * link.a, 2 * link.b + opposed);
    groups.join(2 * link.a + 1, 2 * link.b + 1 - opposed);
  }
  LinkedPatches linked;
  linked.group_of.resize(count);
  linked.is_opposed.resize(count);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    // The root is the lowest member, so it belongs to the first patch of the group.
    const std::uint32_t root = groups.find(2 * i);
    linked.is_opposed[i] = root % 2;
    linked.group_of[i] = root / 2 == i ? next++ : linked.group_of[root / 2];
  }
  return linked;
}

namespace {

/// For each vertex the number of facets that have it as a corner.
std::vector<std::uint32_t> usesOf(const Mesh& mesh) {
  std::vector<std::uint32_t> uses(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) ++uses[v];
  return uses;
}

/// For each vertex the vertex with which it is joined; its own number if it is joined with none.
std::vector<std::uint32_t> groupsOf(const Mesh& mesh, const JoinedFacets& joined) {
  std::vector<std::uint32_t> group(mesh.vertices.size());
  std::iota(group.begin(), group.end(), 0U);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) group[mesh.triangles[i][k]] = joined.triangles[i][k];
  return group;
}

}  // namespace

ClosedCracks closeCracks(const Mesh& mesh, const std::vector<HalfEdge>& edges) {
  ClosedCracks closed{mesh};
  const double size_m = bounds(mesh).size().norm();
  const double widest = size_m > 0 ? std::min(kClosedCrackShare, kClosedCrack_m / size_m) : 0;
  const std::vector<std::uint32_t> group = groupsOf(mesh, joinFacets(mesh, edges, widest)),
                                   uses = usesOf(mesh);
  std::vector<std::uint32_t> place(mesh.vertices.size());  // by group: the vertex with the most facets
  std::iota(place.begin(), place.end(), 0U);
  for (std::uint32_t v = 0; v < group.size(); ++v)
    if (uses[v] > uses[place[group[v]]]) place[group[v]] = v;
  for (std::uint32_t v = 0; v < group.size(); ++v) {
    if (place[group[v]] == v || uses[v] == 0) continue;
    ++closed.corners;
    closed.widest_m = std::max(closed.widest_m, (mesh.vertices[v] - mesh.vertices[place[group[v]]]).norm());
  }
  if (closed.corners == 0) return closed;
  closed.mesh.triangles.clear();
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> moved = {place[group[t[0]]], place[group[t[1]]], place[group[t[2]]]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0])
      closed.mesh.triangles.push_back(moved);
  }
  return closed;
}

}  // namespace vps

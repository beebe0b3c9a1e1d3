// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/union/facet_arrangement.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/normals.h"
#include "mesh/triangle_distance.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Vec3 normalOf(const Mesh& mesh, std::uint32_t facet) {
  const Corners& t = mesh.triangles[facet];
  const Vec3& a = mesh.vertices[t[0]];
  return unitOrZero((mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a));
}

/// A straight edge with the points that lie on it: a side of facets, or a line along which facets meet.
struct Segment {
  std::uint32_t a = 0, b = 0;
  std::vector<std::uint32_t> points;  ///< points between its ends, not sorted
};

/// The nearest points of lines ab and cd, as fractions of ab and cd; nothing if the lines are parallel.
std::optional<std::array<double, 2>> nearestOnLines(const Vec3& a, const Vec3& b, const Vec3& c,
                                                    const Vec3& d) {
  constexpr double kParallel = 1e-12;  // the square of a sine
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
  if (!(det > kParallel * uu * vv)) return std::nullopt;
  return std::array{(uv * v.dot(w) - vv * u.dot(w)) / det, (uu * v.dot(w) - uv * u.dot(w)) / det};
}

class Arranger {
 public:
  Arranger(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> pairs, double touch_m,
           std::int64_t& work_left)
      : mesh_(mesh), points_(mesh.vertices), touch_m_(touch_m), work_left_(work_left) {
    mergeVertices(pairs);
    for (const auto& [f, g] : pairs)
      if (!isGone(f) && !isGone(g)) pairs_.push_back({f, g});
    for (std::uint32_t i = 0; i < points_.size(); ++i) alias_.push_back(i);
  }

  std::optional<Arrangement> run() {
    for (const auto& [f, g] : pairs_) prepare(f), prepare(g);
    forEachOrderedPair([&](std::uint32_t f, std::uint32_t g) { verticesOnSides(f, g); });
    for (const auto& [f, g] : pairs_) pollStop(), crossSides(f, g);
    forEachOrderedPair([&](std::uint32_t f, std::uint32_t g) { verticesInFacet(f, g); });
    forEachOrderedPair([&](std::uint32_t f, std::uint32_t g) { sidesThroughFacet(f, g); });
    addSections();
    if (!settleSections()) return std::nullopt;
    return triangulated();
  }

 private:
  struct Facet {
    Corners corners{};
    std::array<std::uint32_t, 3> sides{};  ///< segments
    std::vector<std::uint32_t> inner;      ///< points
    std::vector<std::uint32_t> sections;   ///< segments
    Vec3 n = Vec3::Zero();
  };

  template <typename Visit>
  void forEachOrderedPair(Visit visit) {
    for (const auto& [f, g] : pairs_) pollStop(), visit(f, g), visit(g, f);
  }

  // ---- vertices

  void mergeVertices(std::span<const std::array<std::uint32_t, 2>> pairs) {
    Groups groups(mesh_.vertices.size());
    for (const auto& [f, g] : pairs)
      for (const std::uint32_t v : mesh_.triangles[f])
        for (const std::uint32_t w : mesh_.triangles[g])
          if (v != w && (mesh_.vertices[v] - mesh_.vertices[w]).norm() <= touch_m_) groups.join(v, w);
    for (Corners& t : mesh_.triangles)
      for (std::uint32_t& v : t) v = groups.find(v);
  }
  [[nodiscard]] bool isGone(std::uint32_t f) const { return hasRepeatedCorner(mesh_.triangles[f]); }

  [[nodiscard]] std::uint32_t find(std::uint32_t p) const {
    while (alias_[p] != p) p = alias_[p];
    return p;
  }
  void join(std::uint32_t p, std::uint32_t q) {
    p = find(p), q = find(q);
    if (p != q) alias_[std::max(p, q)] = std::min(p, q);
  }
  /// An existing point near p, or a new one: where three sides meet, the point may have been found before.
  std::uint32_t newPoint(const Vec3& p) {
    if (const auto near = nearPoint(p)) return *near;
    points_.push_back(p);
    alias_.push_back(static_cast<std::uint32_t>(points_.size() - 1));
    keep(alias_.back());
    return alias_.back();
  }
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cellOf(const Vec3& p) const {
    const Vec3 cell = (p / touch_m_).array().floor();
    return {std::llround(cell.x()), std::llround(cell.y()), std::llround(cell.z())};
  }
  static std::uint64_t hashOf(const Cell& cell, std::uint64_t hash = 0) {
    for (const std::int64_t k : cell) hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15u;
    return hash;
  }
  void keep(std::uint32_t p) { cells_[hashOf(cellOf(points_[p]))].push_back(p); }
  [[nodiscard]] std::optional<std::uint32_t> nearPoint(const Vec3& p) const {
    std::optional<std::uint32_t> near;
    forEachCellAround(p, [&](const Cell& at) {
      const auto cell = near ? cells_.end() : cells_.find(hashOf(at));
      if (cell == cells_.end()) return;
      const auto found = std::find_if(cell->second.begin(), cell->second.end(),
                                      [&](std::uint32_t q) { return isNear(q, p); });
      if (found != cell->second.end()) near = *found;
    });
    return near;
  }
  template <typename Visit>
  void forEachCellAround(const Vec3& p, Visit visit) const {
    const Cell home = cellOf(p);
    for (int n = 0; n < 27; ++n)
      visit(Cell{home[0] + n / 9 - 1, home[1] + n / 3 % 3 - 1, home[2] + n % 3 - 1});
  }
  [[nodiscard]] bool isNear(std::uint32_t p, const Vec3& q) const {
    return (points_[p] - q).norm() <= touch_m_;
  }

  // ---- segments and facets

  std::uint32_t segment(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    const auto [at, is_new] = segment_of_.try_emplace(key, static_cast<std::uint32_t>(segments_.size()));
    if (is_new) segments_.push_back({std::min(a, b), std::max(a, b), {}});
    return at->second;
  }
  [[nodiscard]] bool isOn(const Segment& s, std::uint32_t p) const {
    p = find(p);
    return find(s.a) == p || find(s.b) == p ||
           std::any_of(s.points.begin(), s.points.end(), [&](std::uint32_t q) { return find(q) == p; });
  }
  bool put(std::uint32_t s, std::uint32_t p) {
    if (isOn(segments_[s], p)) return false;
    segments_[s].points.push_back(p);
    return true;
  }
  /// A point on the segment that is near p.
  [[nodiscard]] std::optional<std::uint32_t> pointAt(const Segment& s, const Vec3& p) const {
    if (isNear(s.a, p)) return s.a;
    if (isNear(s.b, p)) return s.b;
    for (const std::uint32_t q : s.points)
      if (isNear(q, p)) return q;
    return std::nullopt;
  }
  [[nodiscard]] bool isNearSegment(const Segment& s, const Vec3& p) const {
    return distanceToSegment(p, points_[s.a], points_[s.b]) <= touch_m_;
  }

  void prepare(std::uint32_t f) {
    const auto [at, is_new] = facet_of_.try_emplace(f, static_cast<std::uint32_t>(facets_.size()));
    if (!is_new) return;
    Facet facet;
    facet.corners = mesh_.triangles[f];
    facet.n = normalOf(mesh_, f);
    for (const std::uint32_t v : facet.corners)
      if (nearPoint(points_[v]) != v) keep(v);
    for (std::size_t k = 0; k < 3; ++k)
      facet.sides[k] = segment(facet.corners[k], facet.corners[(k + 1) % 3]);
    facets_.push_back(std::move(facet));
  }
  Facet& facet(std::uint32_t f) { return facets_[facet_of_.at(f)]; }
  [[nodiscard]] std::uint64_t numberOf(const Facet& f) const {
    return static_cast<std::uint64_t>(&f - facets_.data());
  }
  [[nodiscard]] std::uint64_t keyOf(const Facet& f, std::uint32_t of) const { return numberOf(f) << 32 | of; }
  [[nodiscard]] double height(const Facet& f, const Vec3& p) const {
    return f.n.dot(p - points_[f.corners[0]]);
  }
  [[nodiscard]] bool isNearSide(const Facet& f, const Vec3& p) const {
    return std::any_of(f.sides.begin(), f.sides.end(),
                       [&](std::uint32_t s) { return isNearSegment(segments_[s], p); });
  }
  [[nodiscard]] bool isAbove(const Facet& f, const Vec3& p) const {  // within the prism over the facet
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = points_[f.corners[k]], &b = points_[f.corners[(k + 1) % 3]];
      if (f.n.dot((b - a).cross(p - a)) < 0) return false;
    }
    return true;
  }

  // ---- common points of two facets

  void verticesOnSides(std::uint32_t f, std::uint32_t g) {
    for (const std::uint32_t v : facet(f).corners)
      for (const std::uint32_t s : facet(g).sides)
        if (isNearSegment(segments_[s], points_[v])) put(s, v);
  }

  void crossSides(std::uint32_t f, std::uint32_t g) {
    for (const std::uint32_t s : facet(f).sides)
      for (const std::uint32_t r : facet(g).sides)
        if (s != r && areNear(segments_[s], segments_[r]) &&
            crossed_.insert((std::uint64_t{std::min(s, r)} << 32) | std::max(s, r)).second)
          crossSegments(std::min(s, r), std::max(s, r));
  }
  [[nodiscard]] bool areNear(const Segment& s, const Segment& r) const {
    const auto low = [&](const Segment& of) { return points_[of.a].cwiseMin(points_[of.b]).eval(); };
    const auto high = [&](const Segment& of) { return points_[of.a].cwiseMax(points_[of.b]).eval(); };
    return (low(s).array() <= high(r).array() + touch_m_).all() &&
           (low(r).array() <= high(s).array() + touch_m_).all();
  }

  /// Gives two segments a common point at the place where they nearly meet.
  bool crossSegments(std::uint32_t s, std::uint32_t r) {
    const Segment &of_s = segments_[s], &of_r = segments_[r];
    if (isOn(of_s, of_r.a) || isOn(of_s, of_r.b) || isOn(of_r, of_s.a) || isOn(of_r, of_s.b)) return false;
    const auto at = nearestOnLines(points_[of_s.a], points_[of_s.b], points_[of_r.a], points_[of_r.b]);
    if (!at || (*at)[0] < 0 || (*at)[0] > 1 || (*at)[1] < 0 || (*at)[1] > 1) return false;
    const Vec3 p = points_[of_s.a] + (*at)[0] * (points_[of_s.b] - points_[of_s.a]),
               q = points_[of_r.a] + (*at)[1] * (points_[of_r.b] - points_[of_r.a]);
    if ((p - q).norm() > touch_m_) return false;
    const auto on_s = pointAt(of_s, p), on_r = pointAt(of_r, p);
    if (on_s && on_r) {
      const bool is_new = find(*on_s) != find(*on_r);
      join(*on_s, *on_r);
      return is_new;
    }
    const std::uint32_t point = on_s ? *on_s : on_r ? *on_r : newPoint(p);
    put(s, point);
    put(r, point);
    return true;
  }

  void verticesInFacet(std::uint32_t f, std::uint32_t g) {
    Facet& in = facet(g);
    for (const std::uint32_t v : facet(f).corners) {
      const Vec3& p = points_[v];
      if (std::abs(height(in, p)) <= touch_m_ && isAbove(in, p) && !isNearSide(in, p)) putInner(in, v);
    }
  }
  void putInner(Facet& f, std::uint32_t p) {
    if (!inner_.insert(keyOf(f, find(p))).second) return;
    inner_near_[hashOf(cellOf(points_[p]), numberOf(f))].push_back(
        static_cast<std::uint32_t>(f.inner.size()));
    f.inner.push_back(p);
  }
  /// The first of the facet's inner points near p.
  [[nodiscard]] std::optional<std::uint32_t> innerNear(const Facet& f, const Vec3& p) const {
    std::uint32_t first = UINT32_MAX;
    forEachCellAround(p, [&](const Cell& cell) {
      const auto found = inner_near_.find(hashOf(cell, numberOf(f)));
      if (found == inner_near_.end()) return;
      for (const std::uint32_t i : found->second)
        if (i < first && i < f.inner.size() && isNear(f.inner[i], p)) first = i;
    });
    if (first == UINT32_MAX) return std::nullopt;
    return f.inner[first];
  }

  void sidesThroughFacet(std::uint32_t f, std::uint32_t g) {
    Facet& in = facet(g);
    for (const std::uint32_t s : facet(f).sides) {
      const Vec3 a = points_[segments_[s].a], b = points_[segments_[s].b];
      const double at_a = height(in, a), at_b = height(in, b);
      if (std::abs(at_a) <= touch_m_ || std::abs(at_b) <= touch_m_ || (at_a > 0) == (at_b > 0)) continue;
      const Vec3 p = a + at_a / (at_a - at_b) * (b - a);
      if (!isAbove(in, p) || isNearSide(in, p)) continue;
      std::optional<std::uint32_t> point = pointAt(segments_[s], p);
      if (!point) point = innerNear(in, p);
      if (!point) point = newPoint(p);
      put(s, *point);
      putInner(in, *point);
    }
  }

  // ---- segments within facets

  [[nodiscard]] std::vector<std::uint32_t> pointsOf(const Facet& f) const {
    std::vector<std::uint32_t> all(f.corners.begin(), f.corners.end());
    all.insert(all.end(), f.inner.begin(), f.inner.end());
    for (const auto* list : {f.sides.data(), f.sections.data()})
      for (std::size_t k = 0, n = list == f.sides.data() ? 3 : f.sections.size(); k < n; ++k) {
        const Segment& s = segments_[list[k]];
        all.insert(all.end(), {s.a, s.b});
        all.insert(all.end(), s.points.begin(), s.points.end());
      }
    for (std::uint32_t& p : all) p = find(p);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  void addSection(std::uint32_t f, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t s = segment(a, b);
    Facet& in = facet(f);
    if (std::find(in.sides.begin(), in.sides.end(), s) != in.sides.end()) return;
    if (sections_.insert(keyOf(in, s)).second) in.sections.push_back(s);
  }

  /// True if all corners of one facet lie in the plane of the other.
  [[nodiscard]] bool areFlush(const Facet& f, const Facet& g) const {
    const auto isFlat = [&](const Facet& in, const Facet& of) {
      return std::all_of(of.corners.begin(), of.corners.end(),
                         [&](std::uint32_t v) { return std::abs(height(in, points_[v])) <= touch_m_; });
    };
    return isFlat(f, g) || isFlat(g, f);
  }

  void addRow(std::uint32_t f, std::uint32_t g, std::vector<std::uint32_t> row, const Vec3& along) {
    std::sort(row.begin(), row.end(), [&](std::uint32_t p, std::uint32_t q) {
      return along.dot(points_[p]) < along.dot(points_[q]);
    });
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      addSection(f, row[i], row[i + 1]);
      addSection(g, row[i], row[i + 1]);
    }
  }

  /// Uses the common points found so far; adding sections does not change them.
  void addSections() {
    std::vector<std::vector<std::uint32_t>> own;
    for (const Facet& f : facets_) own.push_back(pointsOf(f));
    for (const auto& [f, g] : pairs_)
      pollStop(), addSections(f, g, own[facet_of_.at(f)], own[facet_of_.at(g)]);
  }
  void addSections(std::uint32_t f, std::uint32_t g, const std::vector<std::uint32_t>& of_f,
                   const std::vector<std::uint32_t>& of_g) {
    const auto& [few, many] = of_f.size() < of_g.size() ? std::tie(of_f, of_g) : std::tie(of_g, of_f);
    std::vector<std::uint32_t> common;
    for (const std::uint32_t p : few)
      if (std::binary_search(many.begin(), many.end(), p)) common.push_back(p);
    if (common.size() < 2) return;
    if (areFlush(facet(f), facet(g))) {
      for (const std::uint32_t of : {f, g})
        for (const std::uint32_t s : facet(of).sides) {
          std::vector<std::uint32_t> row;
          for (const std::uint32_t p : common)
            if (isOn(segments_[s], p)) row.push_back(p);
          addRow(f, g, row, points_[segments_[s].b] - points_[segments_[s].a]);
        }
      return;
    }
    Vec3 along = Vec3::Zero();
    for (const std::uint32_t p : common) {
      const Vec3 way = points_[p] - points_[common[0]];
      if (way.squaredNorm() > along.squaredNorm()) along = way;
    }
    addRow(f, g, common, along);
  }

  /// Gives sections that cross or touch within a facet common points; such places occur where three facets
  /// meet.
  bool settleSections() {
    constexpr int kRounds = 8;
    for (int round = 0; round < kRounds; ++round) {
      bool has_changed = false;
      for (std::size_t i = 0; i < facets_.size() && work_left_ >= 0; ++i)
        if (!facets_[i].sections.empty()) has_changed |= settle(facets_[i]);
      if (work_left_ < 0) return false;
      if (!has_changed) return true;
    }
    return false;
  }

  bool settle(const Facet& f) {
    bool has_changed = false;
    std::vector<std::uint32_t> all(f.sides.begin(), f.sides.end());
    all.insert(all.end(), f.sections.begin(), f.sections.end());
    std::vector<Box> boxes;
    for (const std::uint32_t s : all) {
      Box box;
      for (const std::uint32_t p : {segments_[s].a, segments_[s].b}) box.add(points_[p]);
      boxes.push_back({box.min.array() - touch_m_, box.max.array() + touch_m_});
    }
    const std::vector<std::uint32_t> points = pointsOf(f);
    std::vector<Box> places;
    for (const std::uint32_t p : points) places.push_back({points_[p], points_[p]});
    const BoxTree tree_of_points(places), tree(boxes);
    std::vector<std::uint32_t> near;
    for (std::size_t i = 0; i < all.size(); ++i) {
      pollStop();
      findOverlaps(tree_of_points, places, boxes[i], near);
      for (const std::uint32_t k : near)
        if (isNearSegment(segments_[all[i]], points_[points[k]])) has_changed |= put(all[i], points[k]);
    }
    for (std::size_t i = 3; i < all.size(); ++i) {
      pollStop();
      findOverlaps(tree, boxes, boxes[i], near);
      for (const std::uint32_t k : near)
        if (k >= 3 && k < i) has_changed |= crossSegments(all[k], all[i]);
    }
    return has_changed;
  }
  /// The boxes of a tree that overlap `box`, in ascending order. Counts these boxes as work.
  void findOverlaps(const BoxTree& tree, const std::vector<Box>& boxes, const Box& box,
                    std::vector<std::uint32_t>& found) {
    found.clear();
    tree.forEachOverlap(boxes, box, [&](std::uint32_t i) {
      found.push_back(i);
      return true;
    });
    std::sort(found.begin(), found.end());
    work_left_ -= static_cast<std::int64_t>(found.size() + 1);
  }

  // ---- pieces

  /// The points of a segment in order from `from` to its other end.
  [[nodiscard]] std::vector<std::uint32_t> inOrder(const Segment& s, std::uint32_t from) const {
    std::vector<std::uint32_t> row = {find(s.a), find(s.b)};
    for (const std::uint32_t p : s.points) row.push_back(find(p));
    const Vec3 along = points_[row[1]] - points_[row[0]];
    std::sort(row.begin(), row.end(), [&](std::uint32_t p, std::uint32_t q) {
      const double at_p = along.dot(points_[p]), at_q = along.dot(points_[q]);
      return at_p != at_q ? at_p < at_q : p < q;
    });
    row.erase(std::unique(row.begin(), row.end()), row.end());
    if (row.front() != find(from)) std::reverse(row.begin(), row.end());
    return row;
  }

  std::optional<Arrangement> triangulated() {
    Arrangement out;
    for (std::uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      pollStop();
      if (!isGone(f) && !appendPieces(f, out)) return std::nullopt;
    }
    out.mesh.vertices = std::move(points_);
    return out;
  }

  bool appendPieces(std::uint32_t f, Arrangement& out) const {
    Corners t = mesh_.triangles[f];
    CutFacet cut;
    bool is_cut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const auto side = segment_of_.find((std::uint64_t{std::min(a, b)} << 32) | std::max(a, b));
      cut.sides[k] = {find(a)};
      if (side == segment_of_.end()) continue;
      cut.sides[k] = inOrder(segments_[side->second], a);
      cut.sides[k].pop_back();
      is_cut |= cut.sides[k].size() > 1;
    }
    if (const auto at = facet_of_.find(f); at != facet_of_.end()) {
      const Facet& facet = facets_[at->second];
      is_cut |= !facet.inner.empty() || !facet.sections.empty();
      cut.inner = innerPoints(facet, cut);
      for (const std::uint32_t s : facet.sections) {
        const std::vector<std::uint32_t> row = inOrder(segments_[s], segments_[s].a);
        for (std::size_t i = 0; i + 1 < row.size(); ++i) cut.segments.push_back({row[i], row[i + 1]});
      }
    }
    for (std::uint32_t& v : t) v = find(v);
    if (hasRepeatedCorner(t)) return !is_cut;
    std::vector<Corners> pieces = {t};
    if (is_cut) {
      auto found = triangulate(cut, points_);
      if (!found) return false;
      pieces = std::move(*found);
    }
    for (const Corners& piece : pieces) {
      out.mesh.triangles.push_back(piece);
      out.source.push_back(f);
    }
    return true;
  }

  [[nodiscard]] std::vector<std::uint32_t> innerPoints(const Facet& facet, const CutFacet& cut) const {
    std::vector<std::uint32_t> on_sides, inner;
    for (const auto& side : cut.sides) on_sides.insert(on_sides.end(), side.begin(), side.end());
    std::sort(on_sides.begin(), on_sides.end());
    for (const std::uint32_t p : pointsOf(facet))
      if (!std::binary_search(on_sides.begin(), on_sides.end(), p)) inner.push_back(p);
    return inner;
  }

  Mesh mesh_;  // with merged vertices
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> alias_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;  // of points, by place
  const double touch_m_;
  std::int64_t& work_left_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
  std::vector<Segment> segments_;
  std::unordered_map<std::uint64_t, std::uint32_t> segment_of_;
  std::unordered_set<std::uint64_t> crossed_;
  std::unordered_map<std::uint32_t, std::uint32_t> facet_of_;
  std::vector<Facet> facets_;
  std::unordered_set<std::uint64_t> inner_, sections_;                        // of facets, by keyOf()
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> inner_near_;  // by facet and place
};

}  // namespace

bool mayTouch(const Mesh& mesh, std::uint32_t f, std::uint32_t g, double touch_m) {
  const auto isBeside = [&](std::uint32_t of, std::uint32_t other) {
    const Vec3 n = normalOf(mesh, of);
    double low_m = 1e300, high_m = -1e300;
    for (const std::uint32_t v : mesh.triangles[other]) {
      const double at_m = n.dot(mesh.vertices[v] - mesh.vertices[mesh.triangles[of][0]]);
      low_m = std::min(low_m, at_m), high_m = std::max(high_m, at_m);
    }
    return low_m > touch_m || high_m < -touch_m;
  };
  return !isBeside(f, g) && !isBeside(g, f);
}

std::optional<Arrangement> arrange(const Mesh& mesh, std::span<const std::array<std::uint32_t, 2>> pairs,
                                   double touch_m, std::int64_t& work_left) {
  return Arranger(mesh, pairs, touch_m, work_left).run();
}

}  // namespace vps

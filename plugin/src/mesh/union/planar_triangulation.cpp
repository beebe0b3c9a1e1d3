// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/union/facet_arrangement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace vps {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< directed

/// Barycentric weights of the facet's second and third corner, times kWhole: points on sides are exactly on
/// them.
struct GridPoint {
  std::int64_t second, third;
};
constexpr std::int64_t kWhole = std::int64_t{1} << 40;

/// Positive if a, b, c run counter-clockwise. Barycentric weights tell this as well as coordinates do.
int turn(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  const __int128 twice = static_cast<__int128>(b.second - a.second) * (c.third - a.third) -
                         static_cast<__int128>(b.third - a.third) * (c.second - a.second);
  return twice > 0 ? 1 : twice < 0 ? -1 : 0;
}

/// The cotangent of the angle at p between a and b.
double cotangent(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - p, v = b - p;
  return u.dot(v) / u.cross(v).norm();
}

class Triangulation {
 public:
  Triangulation(const CutFacet& facet, std::span<const Vec3> points) : facet_(facet), points_(points) {
    placeOnGrid();
  }

  bool build() {
    if (!cutSides()) return false;
    for (const std::uint32_t p : facet_.inner)
      if (!insert(p)) return false;
    makeDelaunay();
    for (const auto& [a, b] : facet_.segments)
      if (!constrain(a, b)) return false;
    makeDelaunay();
    return true;
  }

  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles() const {
    std::vector<std::array<std::uint32_t, 3>> all;
    // Each triangle is listed once, at the side that begins at its lowest corner.
    for (const auto& [edge, c] : third_)
      if (edge.first < edge.second && edge.first < c) all.push_back({edge.first, edge.second, c});
    return all;
  }

 private:
  void placeOnGrid() {
    const std::uint32_t corner[3] = {facet_.sides[0][0], facet_.sides[1][0], facet_.sides[2][0]};
    const GridPoint grid[3] = {{0, 0}, {kWhole, 0}, {0, kWhole}};
    const auto rounded = [](double share) { return std::llround(share * static_cast<double>(kWhole)); };
    for (int k = 0; k < 3; ++k) {
      const GridPoint &a = grid[k], &b = grid[(k + 1) % 3];
      const Vec3 &from = points_[corner[k]], along = points_[corner[(k + 1) % 3]] - from;
      for (const std::uint32_t p : facet_.sides[k]) {
        const std::int64_t t = rounded((points_[p] - from).dot(along) / along.squaredNorm());
        const auto between = [t](std::int64_t at_a, std::int64_t at_b) {
          return at_a == at_b ? at_a : at_a == 0 ? t : kWhole - t;
        };
        at_[p] = {between(a.second, b.second), between(a.third, b.third)};
      }
    }
    const Vec3& a = points_[corner[0]];
    const Vec3 ab = points_[corner[1]] - a, ac = points_[corner[2]] - a, n = ab.cross(ac);
    for (const std::uint32_t p : facet_.inner) {
      const Vec3 ap = points_[p] - a;
      at_[p] = {rounded(n.dot(ap.cross(ac)) / n.squaredNorm()),
                rounded(n.dot(ab.cross(ap)) / n.squaredNorm())};
    }
  }

  [[nodiscard]] int turnOf(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return turn(at_.at(a), at_.at(b), at_.at(c));
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    third_[{a, b}] = c, third_[{b, c}] = a, third_[{c, a}] = b;
  }
  void remove(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    third_.erase({a, b}), third_.erase({b, c}), third_.erase({c, a});
  }
  [[nodiscard]] const std::uint32_t* across(const Edge& edge) const {
    const auto found = third_.find(edge);
    return found == third_.end() ? nullptr : &found->second;
  }

  bool cutSides() {
    const std::uint32_t corner[3] = {facet_.sides[0][0], facet_.sides[1][0], facet_.sides[2][0]};
    if (turnOf(corner[0], corner[1], corner[2]) <= 0) return false;
    add(corner[0], corner[1], corner[2]);
    for (int k = 0; k < 3; ++k) {
      const std::vector<std::uint32_t>& side = facet_.sides[k];
      const std::uint32_t end = corner[(k + 1) % 3];
      for (std::size_t i = 0; i + 1 < side.size(); ++i) {
        const std::uint32_t from = side[i], middle = side[i + 1], apex = third_.at({from, end});
        if (turnOf(from, middle, apex) <= 0 || turnOf(middle, end, apex) <= 0) return false;
        remove(from, end, apex);
        add(from, middle, apex);
        add(middle, end, apex);
      }
    }
    return true;
  }

  /// A triangle that holds p, found by walking, or by trying all triangles if walking fails.
  [[nodiscard]] std::optional<std::array<std::uint32_t, 3>> holder(std::uint32_t p) const {
    std::array<std::uint32_t, 3> t = {last_.first, last_.second, 0};
    const std::uint32_t* c = across(last_);
    if (c == nullptr)
      t[0] = third_.begin()->first.first, t[1] = third_.begin()->first.second, c = &third_.begin()->second;
    t[2] = *c;
    for (std::size_t step = 0; step < third_.size(); ++step) {
      bool has_left = false;
      for (int k = 0; k < 3 && !has_left; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if (turnOf(a, b, p) >= 0) continue;
        const std::uint32_t* next = across({b, a});
        if (next == nullptr) continue;
        t = {b, a, *next};
        has_left = true;
      }
      if (!has_left) break;
    }
    const auto holds = [&](std::uint32_t a, std::uint32_t b, std::uint32_t d) {
      return turnOf(a, b, p) >= 0 && turnOf(b, d, p) >= 0 && turnOf(d, a, p) >= 0;
    };
    if (holds(t[0], t[1], t[2])) return t;
    for (const auto& [edge, d] : third_)
      if (holds(edge.first, edge.second, d)) return std::array{edge.first, edge.second, d};
    return std::nullopt;
  }

  bool insert(std::uint32_t p) {
    const auto t = holder(p);
    if (!t) return false;
    int on = -1;
    for (int k = 0; k < 3; ++k)
      if (turnOf((*t)[k], (*t)[(k + 1) % 3], p) == 0) {
        if (on >= 0) return false;  // on a corner
        on = k;
      }
    remove((*t)[0], (*t)[1], (*t)[2]);
    for (int k = 0; k < 3; ++k)
      if (k != on) add((*t)[k], (*t)[(k + 1) % 3], p);
    if (on >= 0) {
      const std::uint32_t a = (*t)[on], b = (*t)[(on + 1) % 3];
      const std::uint32_t* beyond = across({b, a});
      if (beyond == nullptr) return false;  // on the border, where only points of sides may lie
      const std::uint32_t d = *beyond;
      remove(b, a, d);
      add(a, d, p);
      add(d, b, p);
    }
    last_ = {p, on == 1 ? (*t)[0] : (*t)[1]};
    return true;
  }

  /// Replaces the diagonal ab of a strictly convex quadrangle by the other one, cd.
  bool flip(const Edge& ab, Edge& cd) {
    const auto [a, b] = ab;
    const std::uint32_t *left = across({a, b}), *right = across({b, a});
    if (left == nullptr || right == nullptr) return false;
    const std::uint32_t c = *left, d = *right;
    if (turnOf(a, d, c) <= 0 || turnOf(d, b, c) <= 0) return false;
    remove(a, b, c);
    remove(b, a, d);
    add(a, d, c);
    add(d, b, c);
    cd = {c, d};
    return true;
  }

  static Edge undirected(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

  [[nodiscard]] bool crosses(std::uint32_t a, std::uint32_t b, const Edge& e) const {
    const auto& [c, d] = e;
    if (c == a || c == b || d == a || d == b) return false;
    const int at_c = turnOf(a, b, c), at_d = turnOf(a, b, d), at_a = turnOf(c, d, a), at_b = turnOf(c, d, b);
    return ((at_c > 0) != (at_d > 0)) && ((at_a > 0) != (at_b > 0));
  }

  /// The edges that segment ab crosses, in ascending order, found by walking along it.
  [[nodiscard]] std::vector<Edge> crossed(std::uint32_t a, std::uint32_t b) const {
    std::vector<Edge> found;
    Edge next = {a, a};
    for (auto side = third_.lower_bound({a, 0}); side != third_.end() && side->first.first == a; ++side)
      if (crosses(a, b, {side->first.second, side->second})) next = {side->first.second, side->second};
    while (next.first != a && found.size() < third_.size()) {
      found.push_back(undirected(next.first, next.second));
      const std::uint32_t* apex = across({next.second, next.first});
      if (apex == nullptr || *apex == b) break;
      const Edge left = {next.first, *apex}, right = {*apex, next.second};
      next = crosses(a, b, left) ? left : crosses(a, b, right) ? right : Edge{a, a};
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  bool constrain(std::uint32_t a, std::uint32_t b) {
    fixed_.insert(undirected(a, b));
    if (across({a, b}) != nullptr || across({b, a}) != nullptr) return true;
    std::vector<Edge> crossing = crossed(a, b);
    const std::size_t most = 64 + 16 * crossing.size() * crossing.size();
    for (std::size_t i = 0; i < crossing.size(); ++i) {
      if (i > most || fixed_.count(crossing[i]) > 0) return false;
      Edge other;
      if (!flip(crossing[i], other))
        crossing.push_back(crossing[i]);
      else if (crosses(a, b, other))
        crossing.push_back(undirected(other.first, other.second));
    }
    return across({a, b}) != nullptr;
  }

  void makeDelaunay() {
    constexpr double kRounding = 1e-9;
    std::vector<Edge> open;
    for (const auto& [edge, c] : third_)
      if (edge.first < edge.second) open.push_back(edge);
    // The number of flips is limited, because rounding might turn an edge back and forth.
    for (std::size_t left_to_do = 64 * third_.size(); !open.empty() && left_to_do > 0; --left_to_do) {
      const Edge e = open.back();
      open.pop_back();
      const std::uint32_t *left = across(e), *right = across({e.second, e.first});
      if (left == nullptr || right == nullptr || fixed_.count(undirected(e.first, e.second)) > 0) continue;
      const std::uint32_t c = *left, d = *right;
      const Vec3 &a = points_[e.first], &b = points_[e.second];
      if (!(cotangent(points_[c], a, b) + cotangent(points_[d], a, b) < -kRounding)) continue;
      Edge other;
      if (!flip(e, other)) continue;
      for (const Edge& side : {Edge{e.first, d}, Edge{d, e.second}, Edge{e.second, c}, Edge{c, e.first}})
        open.push_back(side);
    }
  }

  const CutFacet& facet_;
  const std::span<const Vec3> points_;
  std::unordered_map<std::uint32_t, GridPoint> at_;
  std::map<Edge, std::uint32_t> third_;  ///< for each side of each triangle, the corner to its left
  std::set<Edge> fixed_;                 ///< the smaller end first
  Edge last_ = {0, 0};
};

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate(const CutFacet& facet,
                                                                     std::span<const Vec3> points) {
  Triangulation triangulation(facet, points);
  if (!triangulation.build()) return std::nullopt;
  return triangulation.triangles();
}

}  // namespace vps

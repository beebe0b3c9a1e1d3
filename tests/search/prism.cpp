// SPDX-License-Identifier: BSD-3-Clause
#include "prism.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

namespace vps::search {

namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
/// Twice the area of triangle abc, positive if counter-clockwise.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(b - a, c - a);
}

bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

using Loop = std::vector<std::uint32_t>;

/// Points of all loops, and the loops as indices: the outline counter-clockwise, holes clockwise.
struct Region {
  std::vector<Vec2> points;
  std::vector<Loop> loops;
};

Region regionOf(const Polygon& outline, const std::vector<Polygon>& holes) {
  Region region;
  const auto add = [&](auto first, auto last) {
    Loop loop;
    for (; first != last; ++first) {
      loop.push_back(static_cast<std::uint32_t>(region.points.size()));
      region.points.push_back(*first);
    }
    region.loops.push_back(std::move(loop));
  };
  add(outline.begin(), outline.end());
  for (const Polygon& hole : holes) add(hole.rbegin(), hole.rend());
  return region;
}

bool isFree(const Region& region, std::uint32_t from, std::uint32_t to) {
  for (const Loop& loop : region.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      if (a == from || a == to || b == from || b == to) continue;
      if (cross(region.points[from], region.points[to], region.points[a], region.points[b])) return false;
    }
  return true;
}

/// One loop around the region. The shortest bridges that cross no side join the holes to the outline.
Loop bridged(const Region& region) {
  Loop outline = region.loops.front();
  for (std::size_t h = 1; h < region.loops.size(); ++h) {
    const Loop& hole = region.loops[h];
    std::size_t best_o = 0, best_k = 0;
    double best_m = 1e300;
    for (std::size_t o = 0; o < outline.size(); ++o)
      for (std::size_t k = 0; k < hole.size(); ++k) {
        const double length_m = (region.points[outline[o]] - region.points[hole[k]]).norm();
        if (length_m < best_m && isFree(region, outline[o], hole[k]))
          best_m = length_m, best_o = o, best_k = k;
      }
    Loop joined(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(best_o) + 1);
    for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(best_k + k) % hole.size()]);
    joined.insert(joined.end(), outline.begin() + static_cast<std::ptrdiff_t>(best_o), outline.end());
    outline = std::move(joined);
  }
  return outline;
}

/// True if corner i can be cut off: it is convex and no other point lies in its triangle.
bool isEar(const std::vector<Vec2>& points, const Loop& loop, std::size_t i) {
  const std::size_t n = loop.size();
  const Vec2 &a = points[loop[(i + n - 1) % n]], &b = points[loop[i]], &c = points[loop[(i + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (const std::uint32_t k : loop) {
    const Vec2& p = points[k];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

std::vector<std::array<std::uint32_t, 3>> triangulated(const Region& region) {
  Loop loop = bridged(region);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (loop.size() > 3) {
    std::size_t i = 0;
    while (i < loop.size() && !isEar(region.points, loop, i)) ++i;
    if (i == loop.size()) throw NotSimple();
    const std::size_t n = loop.size();
    triangles.push_back({loop[(i + n - 1) % n], loop[i], loop[(i + 1) % n]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
  }
  triangles.push_back({loop[0], loop[1], loop[2]});
  return triangles;
}

}  // namespace

Polygon rectangle(const Vec2& low, const Vec2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

Polygon regularPolygon(int sides, double inner_m) {
  Polygon polygon;
  const double half_rad = std::numbers::pi / sides;
  for (int i = 0; i < sides; ++i)
    polygon.emplace_back(inner_m / std::cos(half_rad) * std::cos((2 * i + 1) * half_rad),
                         inner_m / std::cos(half_rad) * std::sin((2 * i + 1) * half_rad));
  return polygon;
}

Polygon enlarged(const Polygon& polygon, double by_m) {
  const auto outward = [&](std::size_t i) -> Vec2 {
    const Vec2 side = polygon[(i + 1) % polygon.size()] - polygon[i];
    return Vec2(side.y(), -side.x()).normalized();
  };
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 before = outward((i + polygon.size() - 1) % polygon.size()), after = outward(i);
    result.push_back(polygon[i] + by_m / (1 + before.dot(after)) * (before + after));
  }
  return result;
}

Mesh makePrism(const Polygon& outline, const std::vector<Polygon>& holes, double low_m, double high_m) {
  const Region region = regionOf(outline, holes);
  const auto count = static_cast<std::uint32_t>(region.points.size());
  Mesh mesh;
  for (const double z_m : {low_m, high_m})
    for (const Vec2& p : region.points) mesh.vertices.emplace_back(p.x(), p.y(), z_m);
  for (const auto& [a, b, c] : triangulated(region)) {
    mesh.triangles.push_back({c, b, a});
    mesh.triangles.push_back({a + count, b + count, c + count});
  }
  for (const Loop& loop : region.loops)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const std::uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      mesh.triangles.push_back({a, b, b + count});
      mesh.triangles.push_back({a, b + count, a + count});
    }
  return mesh;
}

Mesh alongX(const Mesh& prism) {
  Mesh mesh = prism;
  for (Vec3& p : mesh.vertices) p = Vec3(p.z(), p.x(), p.y());
  return mesh;
}

Mesh makeTetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Mesh mesh{{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  if ((b - a).cross(c - a).dot(d - a) < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace vps::search

// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "vps/errors.h"
#include "vps/mesh.h"

namespace vps {
namespace {

constexpr double kPi = std::numbers::pi;

/// Adds a circle of vertices at height z; returns the first index.
std::uint32_t addRing(Mesh& mesh, double radius_m, double z_m, int segments) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < segments; ++i) {
    const double angle_rad = 2 * kPi * i / segments;
    mesh.vertices.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
  }
  return first;
}

/// Joins two rings by a band of triangles. Seen from outside, `low` runs counter-clockwise below `high`.
void joinRings(Mesh& mesh, std::uint32_t low, std::uint32_t high, int segments) {
  for (int i = 0; i < segments; ++i) {
    const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>((i + 1) % segments);
    mesh.triangles.push_back({low + a, low + b, high + b});
    mesh.triangles.push_back({low + a, high + b, high + a});
  }
}

/// Closes a ring by a fan about its centre, which faces up or down.
void capRing(Mesh& mesh, std::uint32_t ring, double z_m, int segments, bool is_up) {
  const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, z_m);
  for (int i = 0; i < segments; ++i) {
    std::uint32_t a = ring + static_cast<std::uint32_t>(i);
    std::uint32_t b = ring + static_cast<std::uint32_t>((i + 1) % segments);
    if (!is_up) std::swap(a, b);
    mesh.triangles.push_back({center, a, b});
  }
}

}  // namespace

Mesh makeBox(const Vec3& size_m) {
  VPS_ASSERT(size_m.minCoeff() > 0);
  Mesh mesh;
  for (int i = 0; i < 8; ++i)  // bits of i: x, y, z high
    mesh.vertices.push_back(0.5 * size_m.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

Mesh makeCylinder(double radius_m, double height_m, int segments) {
  VPS_ASSERT(radius_m > 0 && height_m > 0 && segments >= 3);
  Mesh mesh;
  const std::uint32_t low = addRing(mesh, radius_m, -height_m / 2, segments);
  const std::uint32_t high = addRing(mesh, radius_m, height_m / 2, segments);
  joinRings(mesh, low, high, segments);
  capRing(mesh, low, -height_m / 2, segments, false);
  capRing(mesh, high, height_m / 2, segments, true);
  return mesh;
}

Mesh makeTube(double outer_m, double inner_m, double height_m, int segments) {
  VPS_ASSERT(outer_m > inner_m && inner_m > 0 && height_m > 0 && segments >= 3);
  Mesh mesh;
  const std::uint32_t outer_low = addRing(mesh, outer_m, -height_m / 2, segments);
  const std::uint32_t outer_high = addRing(mesh, outer_m, height_m / 2, segments);
  const std::uint32_t inner_low = addRing(mesh, inner_m, -height_m / 2, segments);
  const std::uint32_t inner_high = addRing(mesh, inner_m, height_m / 2, segments);
  // The rings are joined in the order around the section, so that every band faces out: outside, top, bore,
  // bottom.
  joinRings(mesh, outer_low, outer_high, segments);
  joinRings(mesh, outer_high, inner_high, segments);
  joinRings(mesh, inner_high, inner_low, segments);
  joinRings(mesh, inner_low, outer_low, segments);
  return mesh;
}

Mesh makeSphere(double radius_m, int level) {
  VPS_ASSERT(radius_m > 0 && level >= 0);
  // Icosahedron: cyclic permutations of (0, +-1, +-golden ratio).
  const double g = std::numbers::phi;
  Mesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& p : mesh.vertices) p = radius_m * p.normalized();
  for (int n = 0; n < level; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(radius_m * (mesh.vertices[a] + mesh.vertices[b]).normalized());
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace vps

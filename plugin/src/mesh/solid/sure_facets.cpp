// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/solid/interior.h"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_edges.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Limit of the margin: crossing facets inside the solid may change the winding number by more, from 2 to 1.
constexpr double kMaxMargin = 0.5;
/// The distances that are tried: 1/16 of the mesh's size, then a quarter of the previous distance each time.
constexpr double kWidest = 1.0 / 16;
constexpr int kTries = 6;

std::vector<std::uint8_t> isFacetRegular(const MeshDistance& surface) {
  const Mesh& mesh = surface.mesh();
  std::vector<std::uint8_t> is_good = regularVertices(mesh);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (surface.featureNormal(i, 0).isZero(0))
      for (const std::uint32_t v : mesh.triangles[i]) is_good[v] = 0;
  std::vector<std::uint8_t> is_regular(mesh.triangles.size());
  for (std::size_t i = 0; i < is_regular.size(); ++i) {
    const auto& t = mesh.triangles[i];
    is_regular[i] = is_good[t[0]] != 0 && is_good[t[1]] != 0 && is_good[t[2]] != 0;
  }
  return is_regular;
}

/// Tests the surface's facets against all facets on which the winding number jumps or to which distances are
/// measured. Surface and solid share their vertices.
std::vector<Crossed> crossedBySolid(const MeshDistance& surface, const Mesh& solid) {
  const std::size_t count = surface.mesh().triangles.size();
  if (surface.mesh().triangles == solid.triangles) return crossedFacets(surface, count);
  Mesh all = surface.mesh();
  all.triangles.insert(all.triangles.end(), solid.triangles.begin(), solid.triangles.end());
  return crossedFacets(MeshDistance(all), count);
}

double sureDistance(const Mesh& mesh, std::uint32_t triangle, const Vec3& n, const Interior& interior,
                    double size_m) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3 middle = (a + b + c) / 3;
  const double radius_m = std::max({(a - middle).norm(), (b - middle).norm(), (c - middle).norm()});
  const Vec3 off = 1e-5 * std::sqrt(0.5 * (b - a).cross(c - a).norm()) * n;
  const double in_front = interior.windingNumber(middle + off), behind = interior.windingNumber(middle - off);
  const double margin = std::min({0.5 - in_front, behind - 0.5, kMaxMargin}) - Interior::kDoubt;
  if (!(margin > 0)) return 0;
  Box box;
  for (const Vec3& p : {a, b, c}) box.add(p);
  double reach_m = kWidest * size_m;
  for (int i = 0; i < kTries; ++i, reach_m /= 4) {
    const Box near = {box.min.array() - reach_m, box.max.array() + reach_m};
    if (interior.slope().bound(near) * (radius_m + reach_m) <= margin) return reach_m;
  }
  return 0;
}

}  // namespace

std::vector<std::uint8_t> regularVertices(const Mesh& mesh) {
  std::vector<std::uint8_t> is_regular(mesh.vertices.size(), 1);
  // Corners, numbered 3 triangle + k, are joined across edges; a fan's corners at a vertex become one group.
  Groups fans(3 * mesh.triangles.size());
  const auto cornerAt = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const auto& t = mesh.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0u : t[1] == vertex ? 1u : 2u);
  };
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    const std::uint32_t ends[2] = {same[0].low, same[0].high};
    if (same.size() == 2 && same[0].is_forward != same[1].is_forward) {
      for (const std::uint32_t v : ends)
        fans.join(cornerAt(same[0].triangle, v), cornerAt(same[1].triangle, v));
    } else {
      for (const std::uint32_t v : ends) is_regular[v] = 0;
    }
  });
  std::vector<std::uint32_t> fan_of(mesh.vertices.size(), UINT32_MAX);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) {
      const std::uint32_t fan = fans.find(cornerAt(i, v));
      if (fan_of[v] != UINT32_MAX && fan_of[v] != fan) is_regular[v] = 0;
      fan_of[v] = fan;
    }
  return is_regular;
}

std::vector<float> sureDistances(const MeshDistance& surface, const Interior& interior) {
  const Mesh& mesh = surface.mesh();
  const std::vector<std::uint8_t> is_regular = isFacetRegular(surface);
  const std::vector<Crossed> crossed = crossedBySolid(surface, interior.mesh());
  const double size_m = bounds(mesh).size().norm();
  std::vector<float> sure_m(mesh.triangles.size(), 0);
  onAllCores(sure_m.size(), [&](std::size_t i) {
    if (is_regular[i] == 0 || crossed[i] != Crossed::No) return;
    const auto triangle = static_cast<std::uint32_t>(i);
    // The distance is rounded down, because the conversion to float may round up.
    sure_m[i] = static_cast<float>(
        (1 - 1e-6) * sureDistance(mesh, triangle, surface.featureNormal(triangle, 0), interior, size_m));
  });
  return sure_m;
}

}  // namespace vps

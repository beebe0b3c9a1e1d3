// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/cut_patches.h"

#include <algorithm>
#include <span>

#include "mesh/mesh_edges.h"

namespace vps {
namespace {

/// The height of a triangle over its longest side.
double width(const Mesh& mesh, std::uint32_t i) {
  const auto& t = mesh.triangles[i];
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double longest_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return longest_m > 0 ? (b - a).cross(c - a).norm() / longest_m : 0;
}

}  // namespace

CutPatches patchesOf(const Mesh& pieces) {
  Groups groups(pieces.triangles.size());
  forEachEdge(sortedHalfEdges(pieces), [&](std::span<const HalfEdge> same) {
    if (same.size() == 2) groups.join(same[0].triangle, same[1].triangle);
  });
  CutPatches patches{groups.numbered(), {}};
  std::vector<double> width_m;
  for (std::uint32_t i = 0; i < patches.patch_of.size(); ++i) {
    const std::uint32_t patch = patches.patch_of[i];
    const double own_m = width(pieces, i);
    if (patch == width_m.size()) patches.widest.push_back(i), width_m.push_back(own_m);
    if (own_m > width_m[patch]) patches.widest[patch] = i, width_m[patch] = own_m;
  }
  return patches;
}

Vec3 middleOf(const Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

}  // namespace vps

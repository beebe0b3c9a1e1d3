// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/union/shell_pieces.h"

#include <algorithm>
#include <span>

#include "mesh/mesh_edges.h"
#include "mesh/union/facet_arrangement.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/stoppable.h"

namespace vps {

Box boxOf(const Mesh& mesh, std::uint32_t triangle, double margin_m) {
  Box box;
  for (const std::uint32_t v : mesh.triangles[triangle]) box.add(mesh.vertices[v]);
  return {box.min.array() - margin_m, box.max.array() + margin_m};
}

std::vector<Box> boxesOf(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of, double margin_m) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < shell_of.size(); ++i) {
    if (shell_of[i] >= boxes.size()) boxes.resize(shell_of[i] + 1);
    const Box own = boxOf(mesh, i, margin_m);
    boxes[shell_of[i]].add(own.min);
    boxes[shell_of[i]].add(own.max);
  }
  return boxes;
}

std::vector<FacetPair> nearPairs(const Mesh& mesh, const std::vector<std::uint32_t>& shell_of,
                                 double touch_m) {
  const std::vector<Box> shells = boxesOf(mesh, shell_of, touch_m);
  const BoxTree tree(shells);
  std::vector<std::uint32_t> near;  // facets in the box of another shell
  std::vector<Box> boxes;
  StridedPoll poll;
  for (std::uint32_t i = 0; i < shell_of.size(); ++i) {
    poll();
    const Box box = boxOf(mesh, i, touch_m);
    if (tree.forEachOverlap(shells, box, [&](std::uint32_t shell) { return shell == shell_of[i]; })) continue;
    near.push_back(i);
    boxes.push_back(box);
  }
  const BoxTree facets(boxes);
  std::vector<FacetPair> pairs;
  for (std::uint32_t k = 0; k < near.size() && pairs.size() <= kMostPairs; ++k) {
    poll();
    facets.forEachOverlap(boxes, boxes[k], [&](std::uint32_t other) {
      const std::uint32_t f = near[k], g = near[other];
      if (f < g && shell_of[f] != shell_of[g] && mayTouch(mesh, f, g, touch_m)) pairs.push_back({f, g});
      return pairs.size() <= kMostPairs;
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

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

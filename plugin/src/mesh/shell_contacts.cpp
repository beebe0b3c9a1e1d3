// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shell_contacts.h"

#include <algorithm>

#include "mesh/box_tree.h"
#include "mesh/facet_arrangement.h"

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
  for (std::uint32_t i = 0; i < shell_of.size(); ++i) {
    const Box box = boxOf(mesh, i, touch_m);
    if (tree.forEachOverlap(box, [&](std::uint32_t shell) { return shell == shell_of[i]; })) continue;
    near.push_back(i);
    boxes.push_back(box);
  }
  const BoxTree facets(boxes);
  std::vector<FacetPair> pairs;
  for (std::uint32_t k = 0; k < near.size() && pairs.size() <= kMostPairs; ++k)
    facets.forEachOverlap(boxes[k], [&](std::uint32_t other) {
      const std::uint32_t f = near[k], g = near[other];
      if (f < g && shell_of[f] != shell_of[g] && mayTouch(mesh, f, g, touch_m)) pairs.push_back({f, g});
      return pairs.size() <= kMostPairs;
    });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace vps

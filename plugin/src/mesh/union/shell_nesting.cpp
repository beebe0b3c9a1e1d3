// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/union/shell_nesting.h"

#include <cmath>
#include <utility>

#include "mesh/triangle_distance.h"
#include "mesh/union/facet_arrangement.h"
#include "mesh/union/shell_pieces.h"
#include "mesh/union/shell_union.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Work that may be spent on cutting facets to find the nesting.
constexpr std::int64_t kMostNestingWork = kMostUnionWork / 2;

}  // namespace

ShellNesting::ShellNesting(Mesh mesh, std::vector<std::uint32_t> shell_of)
    : mesh_(std::move(mesh)),
      shell_of_(std::move(shell_of)),
      touch_m_(touchDistance(mesh_)),
      facet_boxes_(triangleBoxes(mesh_)),
      facets_(facet_boxes_) {
  for (std::uint32_t i = 0; i < shell_of_.size(); ++i) {
    if (shell_of_[i] >= triangles_.size()) triangles_.resize(shell_of_[i] + 1);
    triangles_[shell_of_[i]].push_back(i);
  }
  points_.resize(triangles_.size());
  windings_.resize(triangles_.size());
  addPatches();
}

void ShellNesting::addPatches() {
  const std::vector<FacetPair> pairs = nearPairs(mesh_, shell_of_, touch_m_);
  std::int64_t work_left = pairs.size() > kMostPairs ? -1 : kMostNestingWork;
  std::optional<Arrangement> cut;
  if (work_left >= 0) cut = arrange(mesh_, pairs, touch_m_, work_left);
  if (!cut) return addCornersAndMiddles();
  for (const std::uint32_t piece : patchesOf(cut->mesh).widest)
    points_[shell_of_[cut->source[piece]]].push_back(middleOf(cut->mesh, piece));
}

void ShellNesting::addCornersAndMiddles() {
  for (std::uint32_t i = 0; i < shell_of_.size(); ++i) {
    std::vector<Vec3>& points = points_[shell_of_[i]];
    points.push_back(middleOf(mesh_, i));
    for (const std::uint32_t v : mesh_.triangles[i]) points.push_back(mesh_.vertices[v]);
  }
}

bool ShellNesting::liesWithin(std::uint32_t inner, std::uint32_t outer) {
  bool has_inside = false;
  for (const Vec3& p : points_[inner]) {
    pollStop();
    const Place place = placeOf(p, outer);
    if (place == Place::Outside) return false;
    has_inside |= place == Place::Inside;
  }
  return has_inside;
}

ShellNesting::Place ShellNesting::placeOf(const Vec3& p, std::uint32_t shell) {
  if (isOn(p, shell)) return Place::On;
  if (!windings_[shell]) windings_[shell].emplace(mesh_, triangles_[shell]);
  return std::abs(windings_[shell]->at(p).w) > 0.5 ? Place::Inside : Place::Outside;
}

bool ShellNesting::isOn(const Vec3& p, std::uint32_t shell) const {
  const double near_m = 2 * touch_m_;
  const auto isNear = [&](std::uint32_t i) {
    const auto& t = mesh_.triangles[i];
    const Vec3 q = closestOnTriangle(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]).q;
    return (q - p).norm() <= near_m;
  };
  return !facets_.forEachOverlap(facet_boxes_, {p.array() - near_m, p.array() + near_m},
                                 [&](std::uint32_t i) { return shell_of_[i] != shell || !isNear(i); });
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// The trees for the search for corners and facets that can touch.
#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "query/features/direction_cone.h"
#include "query/features/touch_search.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_set.h"

namespace vps {

namespace {

// Measured on threads in their nuts and on a bearing block with its bores. If nodes are always halved by
// direction first, they overlap in place, which costs fifteen times as much in the block; by place first,
// twice as much in the threads. Values of kOfPart of 0.06 and of 0.25 cost the same.
constexpr double kSimilar = 0.3, kOfPart = 0.12;

Box boxAround(const std::vector<DirectedTree::Item>& items, std::span<const std::uint32_t> which,
              Vec3 DirectedTree::Item::*member) {
  Box box;
  for (const std::uint32_t i : which) box.add(items[i].*member);
  return box;
}

// The index at which a node's items are divided.
// @param length_m  difference in place that counts as much as opposite directions
std::uint32_t part(const std::vector<DirectedTree::Item>& items, std::span<std::uint32_t> which,
                   double length_m) {
  int axis = 0, place_axis = 0;
  const Box directions = boxAround(items, which, &DirectedTree::Item::direction);
  const double turn = directions.size().maxCoeff(&axis);
  const double place_m = boxAround(items, which, &DirectedTree::Item::p).size().maxCoeff(&place_axis);
  if (turn > kSimilar && turn * length_m > place_m) {
    const double middle = directions.center()[axis];
    const auto half = std::partition(which.begin(), which.end(),
                                     [&](std::uint32_t i) { return items[i].direction[axis] < middle; });
    return static_cast<std::uint32_t>(half - which.begin());
  }
  axis = place_axis;
  const auto half = which.begin() + static_cast<std::ptrdiff_t>(which.size() / 2);
  // A total order, so that every standard library makes the same halves.
  std::nth_element(which.begin(), half, which.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double pa = items[a].p[axis], pb = items[b].p[axis];
    return pa != pb ? pa < pb : a < b;
  });
  return static_cast<std::uint32_t>(which.size() / 2);
}

}  // namespace

void DirectedTree::build(const std::vector<Item>& items) {
  nodes.clear();
  order.resize(items.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!order.empty()) nodes.push_back({0, static_cast<std::uint32_t>(order.size()), 0});
  const double length_m = kOfPart * boxAround(items, order, &DirectedTree::Item::p).size().norm();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto [first, end, left] = nodes[n];
    if (end - first == 1) continue;
    const std::uint32_t half =
        first + vps::part(items, std::span(order).subspan(first, end - first), length_m);
    nodes[n].left = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({first, half, 0});
    nodes.push_back({half, end, 0});
  }
}

void FacetTree::build(const FeatureSet& part) {
  const auto boxOf = [&](std::uint32_t facet) {
    Box box;
    for (const std::uint32_t v : part.facets()[facet]) box.add(part.vertices()[v]);
    return box;
  };
  const auto coneOf = [&](std::uint32_t facet) {
    return part.isTwoSided(facet) ? DirectionCone::everywhere()
                                  : DirectionCone::around(part.normal(facet), 0);
  };
  std::vector<DirectedTree::Item> items;
  for (std::uint32_t i = 0; i < part.facets().size(); ++i)
    items.push_back({boxOf(i).center(), part.normal(i)});
  tree.build(items);
  bounds.clear();
  std::vector<DirectionCone> cones;
  for (const DirectedTree::Node& node : tree.nodes) {
    Bounds& b = bounds.emplace_back();
    b.spread_m = boxAround(items, std::span(tree.order).subspan(node.first, node.end - node.first),
                           &DirectedTree::Item::p)
                     .size()
                     .norm();
    cones.clear();
    for (std::uint32_t k = node.first; k < node.end; ++k) {
      const std::uint32_t facet = tree.order[k];
      const Box box = boxOf(facet);
      b.box.add(box.min);
      b.box.add(box.max);
      b.is_curved = b.is_curved && part.isCurved(facet);
      cones.push_back(coneOf(facet));
    }
    b.normals = coneOver(cones);
    b.low_m = std::numeric_limits<double>::infinity();
    b.high_m = -b.low_m;
    for (std::uint32_t k = node.first; k < node.end; ++k)
      for (const std::uint32_t v : part.facets()[tree.order[k]]) {
        const double at_m = b.normals.axis.dot(part.vertices()[v]);
        b.low_m = std::min(b.low_m, at_m);
        b.high_m = std::max(b.high_m, at_m);
      }
  }
}

namespace {

/// Two different directions of the faces around a corner; everywhere() for a direction that is missing.
struct Faces {
  DirectionCone cone[2];
};

Faces facesAt(const FeatureSet& part, std::uint32_t corner) {
  std::vector<DirectionCone> groups[2];
  for (const std::uint32_t edge : part.edgesAt(corner))
    for (const Vec3& n : part.edges()[edge].normal) {
      if (!(n.squaredNorm() > 0)) continue;
      for (std::vector<DirectionCone>& group : groups)
        if (group.empty() || group[0].axis.dot(n) > kCosSameFace) {
          group.push_back(DirectionCone::around(n, 0));
          break;
        }
    }
  return {{coneOver(groups[0]), coneOver(groups[1])}};
}

// Cones over the faces of several corners, of which each corner's two are taken in the more similar order.
Faces facesOver(const std::vector<Faces>& all) {
  std::vector<DirectionCone> cones[2];
  for (const Faces& f : all) {
    const bool is_swapped = f.cone[0].axis.dot(all[0].cone[0].axis) < f.cone[1].axis.dot(all[0].cone[0].axis);
    for (const int k : {0, 1}) cones[k].push_back(f.cone[is_swapped ? 1 - k : k]);
  }
  return {{coneOver(cones[0]), coneOver(cones[1])}};
}

}  // namespace

void CornerTree::build(const FeatureSet& part) {
  std::vector<std::uint32_t> corners;
  std::vector<DirectedTree::Item> items;
  std::vector<DirectionCone> touch;
  std::vector<Faces> faces;
  for (std::uint32_t i = 0; i < part.corners().size(); ++i) {
    const std::optional<DirectionCone> cone = touchCone(part.raysAt(i), kSinTouch);
    if (!cone) continue;
    corners.push_back(i);
    items.push_back({part.vertices()[part.corners()[i]], cone->axis});
    touch.push_back(*cone);
    faces.push_back(facesAt(part, i));
  }
  tree.build(items);
  bounds.clear();
  std::vector<DirectionCone> cones;
  std::vector<Faces> all;
  for (const DirectedTree::Node& node : tree.nodes) {
    Bounds& b = bounds.emplace_back();
    Box box;
    cones.clear();
    all.clear();
    for (std::uint32_t k = node.first; k < node.end; ++k) {
      box.add(items[tree.order[k]].p);
      cones.push_back(touch[tree.order[k]]);
      all.push_back(faces[tree.order[k]]);
    }
    b.center = box.center();
    b.half = 0.5 * box.size();
    b.radius_m = b.half.norm();
    b.touch = coneOver(cones);
    const Faces over = facesOver(all);
    for (const int k : {0, 1}) b.faces[k] = over.cone[k];
  }
  for (std::uint32_t& i : tree.order) i = corners[i];
}

}  // namespace vps

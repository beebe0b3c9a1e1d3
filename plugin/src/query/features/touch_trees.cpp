// SPDX-License-Identifier: BSD-3-Clause
// The trees for the search for corners and facets that can touch.
#include <algorithm>
#include <limits>
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

struct DirectedItem {
  Vec3 p, direction;
};

Box boxAround(const std::vector<DirectedItem>& items, std::span<const std::uint32_t> which,
              Vec3 DirectedItem::*member) {
  Box box;
  for (const std::uint32_t i : which) box.add(items[i].*member);
  return box;
}

// A tree whose nodes hold items that are near each other and point in similar directions: each node is
// divided by place or by direction, by what differs more.
Hierarchy directedHierarchy(const std::vector<DirectedItem>& items) {
  Box all;
  for (const DirectedItem& item : items) all.add(item.p);
  const double length_m = kOfPart * all.size().norm();  // counts as much as opposite directions
  return buildHierarchy(items.size(), [&](std::span<std::uint32_t> own) -> std::size_t {
    if (own.size() == 1) return 0;
    const Box directions = boxAround(items, own, &DirectedItem::direction),
              places = boxAround(items, own, &DirectedItem::p);
    int axis = 0;
    const double turn = directions.size().maxCoeff(&axis);
    const double place_m = places.size().maxCoeff();
    if (turn > kSimilar && turn * length_m > place_m) {
      const double middle = directions.center()[axis];
      const auto half = std::partition(own.begin(), own.end(),
                                       [&](std::uint32_t i) { return items[i].direction[axis] < middle; });
      return static_cast<std::size_t>(half - own.begin());
    }
    axis = longestAxis(places);
    divideByKey(own, own.size() / 2, [&](std::uint32_t i) { return items[i].p[axis]; });
    return own.size() / 2;
  });
}

}  // namespace

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
  std::vector<DirectedItem> items;
  for (std::uint32_t i = 0; i < part.facets().size(); ++i)
    items.push_back({boxOf(i).center(), part.normal(i)});
  tree = directedHierarchy(items);
  bounds.clear();
  std::vector<DirectionCone> cones;
  for (const HierarchyNode& node : tree.nodes) {
    Bounds& b = bounds.emplace_back();
    const auto own = std::span(tree.order).subspan(node.first, node.end - node.first);
    b.spread_m = boxAround(items, own, &DirectedItem::p).size().norm();
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

// Cones over the faces of several corners, of which each corner's two faces are taken in the more similar
// order.
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
  std::vector<DirectedItem> items;
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
  tree = directedHierarchy(items);
  bounds.clear();
  std::vector<DirectionCone> cones;
  std::vector<Faces> all;
  for (const HierarchyNode& node : tree.nodes) {
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

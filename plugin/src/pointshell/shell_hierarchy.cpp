// SPDX-License-Identifier: BSD-3-Clause
#include "pointshell/shell_hierarchy.h"

#include <algorithm>
#include <cmath>

#include "pointshell/shell_grid.h"
#include "vps/bounding_volume_hierarchy.h"

namespace vps {
namespace {

constexpr std::size_t kLeafPoints = kLanes;

/// Where a range of `count` points is split: near the middle, at a multiple of the leaf size, so that leaves
/// are full, and of the largest power of 16 that leaves both halves non-empty, so that sixteen consecutive
/// leaves are neighbours. Sorting and hierarchy use the same rule, and the leaves of a saved shell are found
/// by this rule.
std::size_t cut(std::size_t count) {
  std::size_t unit = kLeafPoints;
  while (2 * unit * kLanes <= count) unit *= kLanes;
  const std::size_t units = (count + unit - 1) / unit;
  return (units / 2) * unit;
}

struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
};

double greatestDistance2(std::span<const Vec3> points, const Vec3& center, std::size_t& farthest) {
  double greatest = -1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double squared = (points[i] - center).squaredNorm();
    if (squared > greatest) {
      greatest = squared;
      farthest = i;
    }
  }
  return greatest;
}

/// Nearly the smallest enclosing sphere: steps from the box's centre towards the farthest point that shrink
/// as 1/k. Source: Badoiu and Clarkson 2003, Smaller core-sets for balls. Large spheres only cull distant
/// shells; for them the box's centre is good enough.
Sphere enclosingSphere(std::span<const Vec3> points) {
  constexpr std::size_t kWorthSteps = 1024;
  constexpr int kSteps = 24;
  Box box;
  for (const Vec3& p : points) box.add(p);
  Vec3 center = box.center(), best = center;
  std::size_t farthest = 0;
  double best2 = greatestDistance2(points, center, farthest);
  for (int k = 2; k < kSteps && points.size() <= kWorthSteps; ++k) {
    center += (points[farthest] - center) / k;
    const double squared = greatestDistance2(points, center, farthest);
    if (squared < best2) {
      best2 = squared;
      best = center;
    }
  }
  return {best, std::sqrt(best2) * (1 + 1e-12)};  // more than the rounding errors above
}

/// A block's sphere as kernels read it: offsets are rounded to floats, so the radius grows by their error.
void setSphere(ShellBlock& block, const Vec3& center, double radius_m) {
  for (int k = 0; k < 3; ++k) block.center[k] = center[k];
  block.radius_m = radius_m * (1 + 1e-6);
}

/// Sets lane i of a block, and also all later lanes, which keep the value until they are set.
void setLane(ShellBlock& block, std::uint32_t lane, const Vec3& p, double weight) {
  const Vec3 offset = p - Vec3(block.center[0], block.center[1], block.center[2]);
  block.x[lane] = static_cast<float>(offset.x());
  block.y[lane] = static_cast<float>(offset.y());
  block.z[lane] = static_cast<float>(offset.z());
  block.weight[lane] = static_cast<float>(weight);
}

void repeatFirstLane(ShellBlock& block) {
  for (std::uint32_t i = block.count; i < kLanes; ++i) {
    block.x[i] = block.x[0];
    block.y[i] = block.y[0];
    block.z[i] = block.z[0];
    block.weight[i] = 0;
  }
}

/// A block around up to sixteen consecutive blocks.
ShellBlock parentBlock(std::span<const ShellBlock> children, std::size_t first) {
  const auto centerOf = [](const ShellBlock& b) { return Vec3(b.center[0], b.center[1], b.center[2]); };
  Box box;
  for (const ShellBlock& child : children) {
    box.add(centerOf(child) - Vec3::Constant(child.radius_m));
    box.add(centerOf(child) + Vec3::Constant(child.radius_m));
  }
  double radius_m = 0;
  for (const ShellBlock& child : children)
    radius_m = std::max(radius_m, (centerOf(child) - box.center()).norm() + child.radius_m);
  ShellBlock block;
  setSphere(block, box.center(), radius_m);
  block.first = static_cast<std::uint32_t>(first);
  block.count = static_cast<std::uint32_t>(children.size());
  for (std::uint32_t i = 0; i < block.count; ++i)
    setLane(block, i, centerOf(children[i]), children[i].radius_m * (1 + 1e-6));
  repeatFirstLane(block);
  return block;
}

/// The numbers 0 to count - 1, each far from those before (van der Corput: the index with its bits reversed).
std::vector<std::uint32_t> bitReversed(std::size_t count) {
  int bits = 0;
  while ((std::size_t{1} << bits) < count) ++bits;
  std::vector<std::uint32_t> order;
  order.reserve(count);
  for (std::uint64_t i = 0; i < (std::uint64_t{1} << bits); ++i) {
    std::uint64_t reversed = 0;
    for (int b = 0; b < bits; ++b) reversed |= ((i >> b) & 1) << (bits - 1 - b);
    if (reversed < count) order.push_back(static_cast<std::uint32_t>(reversed));
  }
  return order;
}

}  // namespace

std::vector<std::uint32_t> sortedOrder(std::span<const Vec3> points) {
  return buildHierarchy(points.size(),
                        [&](std::span<std::uint32_t> items) -> std::size_t {
                          if (items.size() <= kLeafPoints) {
                            std::sort(items.begin(), items.end());
                            return 0;
                          }
                          divideByPoint(items, cut(items.size()), points);
                          return cut(items.size());
                        })
      .order;
}

std::vector<ShellNode> sphereHierarchy(std::span<const Vec3> points) {
  const Hierarchy tree = buildHierarchy(points.size(), [](std::span<std::uint32_t> items) {
    return items.size() <= kLeafPoints ? 0 : cut(items.size());
  });
  std::vector<ShellNode> nodes;
  nodes.reserve(tree.nodes.size());
  for (const HierarchyNode& node : tree.nodes) {
    const std::uint32_t count = node.end - node.first;
    const Sphere sphere = enclosingSphere(points.subspan(node.first, count));
    nodes.push_back({sphere.center, sphere.radius_m, node.first, count, node.skip, node.isLeaf()});
  }
  return nodes;
}

ShellBlock leafBlock(const PointShell& shell, const ShellNode& leaf) {
  ShellBlock block;
  setSphere(block, leaf.center, leaf.radius_m);
  block.first = leaf.first;
  block.count = leaf.count;
  block.is_leaf = 1;
  for (std::uint32_t i = 0; i < leaf.count; ++i)
    setLane(block, i, shell.points[leaf.first + i], shell.area_m2[leaf.first + i]);
  repeatFirstLane(block);
  return block;
}

void layOutBlocks(PointShell& shell) {
  shell.blocks.clear();
  for (const ShellNode& node : shell.nodes)
    if (node.is_leaf) shell.blocks.push_back(leafBlock(shell, node));
  shell.leaf_blocks = shell.blocks.size();
  for (std::size_t first = 0, end = shell.blocks.size(); end - first > 1;
       first = end, end = shell.blocks.size())
    for (std::size_t i = first; i < end; i += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, end - i);
      shell.blocks.push_back(parentBlock(std::span(shell.blocks).subspan(i, count), i));
    }
  shell.blocks.shrink_to_fit();
}

namespace {

// Keeps the points that are within the radius of a waiting point, in their order.
void keepNear(std::span<const Vec3> points, const std::vector<std::uint32_t>& waiting, double radius_m,
              std::vector<std::uint32_t>& joined) {
  PointGrid grid(2 * radius_m, waiting.size());
  for (const std::uint32_t i : waiting) grid.insert(points[i], i);
  std::erase_if(joined, [&](std::uint32_t i) {
    bool is_far = true;
    grid.visitNear(points[i], radius_m, [&is_far](std::uint32_t, double) { return is_far = false; });
    return is_far;
  });
}

}  // namespace

std::vector<std::uint32_t> progressiveOrder(std::span<const Vec3> points) {
  // Level by level with half the radius: a point joins if no joined point is within the radius.
  std::vector<std::uint32_t> waiting = bitReversed(points.size()), order;
  order.reserve(points.size());
  Box box;
  for (const Vec3& p : points) box.add(p);
  double radius_m = points.empty() ? 0 : box.size().norm();
  constexpr int kLevels = 32;  // from metres to below a nanometre; remaining points are duplicates
  constexpr std::size_t kFew = 8;
  std::vector<std::uint32_t> joined;  // points that a waiting point may be near
  std::size_t taken = 0;              // number of entries of `order` that are in `joined`
  for (int level = 0; level < kLevels && !waiting.empty() && radius_m > 0; ++level, radius_m /= 2) {
    joined.insert(joined.end(), order.begin() + static_cast<std::ptrdiff_t>(taken), order.end());
    taken = order.size();
    // A few duplicates wait through all levels: only their neighbours matter.
    if (kFew * waiting.size() < joined.size()) keepNear(points, waiting, radius_m, joined);
    PointGrid grid(2 * radius_m, joined.size());
    for (const std::uint32_t i : joined) grid.insert(points[i], i);
    std::size_t kept = 0;
    for (const std::uint32_t i : waiting) {
      bool is_near = false;
      grid.visitNear(points[i], radius_m, [&is_near](std::uint32_t, double) { return !(is_near = true); });
      if (is_near) {
        waiting[kept++] = i;
        continue;
      }
      grid.insert(points[i], i);
      order.push_back(i);
    }
    waiting.resize(kept);
  }
  order.insert(order.end(), waiting.begin(), waiting.end());
  return order;
}

}  // namespace vps

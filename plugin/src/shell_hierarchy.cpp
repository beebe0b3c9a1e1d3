// SPDX-License-Identifier: BSD-3-Clause
#include "shell_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shell_grid.h"

namespace vps {
namespace {

/// Points of a leaf: one AVX-512 vector of floats. Assumed; the prototype measured 16 as good as any.
constexpr std::size_t kLeafPoints = 16;

/// Where a range of `count` points is cut: near the middle, at a multiple of the leaf size, so that leaves
/// are full. Sorting and hierarchy must agree on it, and a saved shell finds its leaves again by it.
std::size_t cut(std::size_t count) {
  const std::size_t leaves = (count + kLeafPoints - 1) / kLeafPoints;
  return (leaves / 2) * kLeafPoints;
}

void sortRange(std::span<const Vec3> points, std::span<std::uint32_t> order) {
  if (order.size() <= kLeafPoints) {
    std::sort(order.begin(), order.end());
    return;
  }
  Box box;
  for (const std::uint32_t i : order) box.add(points[i]);
  int axis = 0;
  box.size().maxCoeff(&axis);
  const std::size_t middle = cut(order.size());
  // Ties by index: the cut must not depend on how the library breaks them.
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
                   });
  sortRange(points, order.first(middle));
  sortRange(points, order.subspan(middle));
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

/// Nearly the least enclosing sphere: from the box's centre, steps towards the farthest point that shrink as
/// 1/k. Source: Badoiu and Clarkson 2003, Smaller core-sets for balls. Large spheres only cull what is far
/// away: for those the box's centre will do.
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
  return {best, std::sqrt(best2) * (1 + 1e-12)};  // outward by more than the roundings above
}

void addNodes(std::span<const Vec3> points, std::size_t first, std::size_t count,
              std::vector<ShellNode>& nodes) {
  const std::size_t index = nodes.size();
  const Sphere sphere = enclosingSphere(points.subspan(first, count));
  nodes.push_back({sphere.center, sphere.radius_m, static_cast<std::uint32_t>(first),
                   static_cast<std::uint32_t>(count), 0, count <= kLeafPoints});
  if (count > kLeafPoints) {
    const std::size_t left = cut(count);
    addNodes(points, first, left, nodes);
    addNodes(points, first + left, count - left, nodes);
  }
  nodes[index].skip = static_cast<std::uint32_t>(nodes.size());
}

/// 0 to count - 1, each next one far from those before (van der Corput: the index with its bits reversed).
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
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  sortRange(points, order);
  return order;
}

std::vector<ShellNode> sphereHierarchy(std::span<const Vec3> points) {
  std::vector<ShellNode> nodes;
  if (points.empty()) return nodes;
  nodes.reserve(2 * (points.size() / kLeafPoints + 1));
  addNodes(points, 0, points.size(), nodes);
  return nodes;
}

std::vector<std::uint32_t> progressiveOrder(std::span<const Vec3> points) {
  // Level by level with half the radius: a point joins when nothing that has joined is within the radius.
  std::vector<std::uint32_t> waiting = bitReversed(points.size()), order;
  order.reserve(points.size());
  Box box;
  for (const Vec3& p : points) box.add(p);
  double radius_m = points.empty() ? 0 : box.size().norm();
  constexpr int kLevels = 32;  // from metres to below a nanometre; what still waits repeats a point
  for (int level = 0; level < kLevels && !waiting.empty() && radius_m > 0; ++level, radius_m /= 2) {
    PointGrid grid(2 * radius_m, order.size());
    for (const std::uint32_t i : order) grid.insert(points[i], i);
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

// SPDX-License-Identifier: BSD-3-Clause
#include "query/cluster_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pointshell/shell_hierarchy.h"

namespace vps {
namespace {

/// Points [first, end) are a block's: leaves hold neighbours in ascending order.
struct Range {
  std::uint32_t first = 0, end = 0;
};

Range pointsOf(const PointShell& shell, std::uint32_t block) {
  std::uint32_t low = block, high = block;
  while (!shell.blocks[low].is_leaf) low = shell.blocks[low].first;
  while (!shell.blocks[high].is_leaf) high = shell.blocks[high].first + shell.blocks[high].count - 1;
  return {shell.blocks[low].first, shell.blocks[high].first + shell.blocks[high].count};
}

struct Center {
  Vec3 p_P = Vec3::Zero();
  double area_m2 = 0;
};

Center areaCenter(const PointShell& shell, const Range& range) {
  Vec3 weighted = Vec3::Zero(), plain = Vec3::Zero();
  double area_m2 = 0;
  for (std::uint32_t i = range.first; i < range.end; ++i) {
    weighted += shell.area_m2[i] * shell.points[i];
    plain += shell.points[i];
    area_m2 += shell.area_m2[i];
  }
  if (area_m2 > 0) return {weighted / area_m2, area_m2};
  return {plain / (range.end - range.first), 0};
}

std::uint32_t nearestTo(const PointShell& shell, const Range& range, const Vec3& p_P) {
  std::uint32_t nearest = range.first;
  double least2 = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = range.first; i < range.end; ++i) {
    const double squared = (shell.points[i] - p_P).squaredNorm();
    if (squared < least2) {
      least2 = squared;
      nearest = i;
    }
  }
  return nearest;
}

/// Adds a block's sample, and returns the radius of the sphere around it.
double addSample(const PointShell& shell, std::uint32_t block, PointShell& samples) {
  const Range range = pointsOf(shell, block);
  const Center center = areaCenter(shell, range);
  const std::uint32_t id = nearestTo(shell, range, center.p_P);
  samples.points.push_back(shell.points[id]);
  samples.inward.push_back(shell.inward[id]);
  samples.area_m2.push_back(center.area_m2);
  double greatest2 = 0;
  for (std::uint32_t i = range.first; i < range.end; ++i)
    greatest2 = std::max(greatest2, (shell.points[i] - shell.points[id]).squaredNorm());
  return std::sqrt(greatest2);
}

void addBlock(const PointShell& shell, const ShellBlock& block, ClusterSamples& samples) {
  ShellNode node;
  node.center = Vec3(block.center[0], block.center[1], block.center[2]);
  node.radius_m = block.radius_m;
  node.first = static_cast<std::uint32_t>(samples.points.size());
  node.count = block.count;
  double radii_m[kLanes];
  for (std::uint32_t i = 0; i < block.count; ++i)
    radii_m[i] = addSample(shell, block.first + i, samples.points);
  samples.points.blocks.push_back(leafBlock(samples.points, node));
  samples.spheres.push_back(samples.points.blocks.back());
  // Offsets of both the sample and the points are rounded to floats.
  for (std::uint32_t i = 0; i < block.count; ++i)
    samples.spheres.back().weight[i] = static_cast<float>(radii_m[i] * (1 + 1e-6) + 1e-6 * block.radius_m);
}

}  // namespace

ClusterSamples clusterSamples(const PointShell& shell) {
  ClusterSamples samples;
  const std::size_t blocks = shell.blocks.size() - shell.leaf_blocks;
  const std::size_t count =
      shell.blocks.empty() ? 0 : shell.blocks.size() - 1;  // every block's but the root's
  samples.points.points.reserve(count);
  samples.points.inward.reserve(count);
  samples.points.area_m2.reserve(count);
  samples.points.blocks.reserve(blocks);
  samples.spheres.reserve(blocks);
  samples.points.spacing_m = shell.spacing_m;
  for (std::size_t b = shell.leaf_blocks; b < shell.blocks.size(); ++b)
    addBlock(shell, shell.blocks[b], samples);
  samples.points.leaf_blocks = samples.points.blocks.size();
  return samples;
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Reduces a shell to the points in some boxes.

#include <algorithm>

#include "pointshell/shell_hierarchy.h"
#include "vps/pointshell.h"

namespace vps {
namespace {

/// The number of kept entries before each index, and the total.
std::vector<std::uint32_t> keptBefore(const std::vector<std::uint8_t>& is_kept) {
  std::vector<std::uint32_t> before(is_kept.size() + 1, 0);
  for (std::size_t i = 0; i < is_kept.size(); ++i) before[i + 1] = before[i] + is_kept[i];
  return before;
}

std::vector<std::uint8_t> pointsWithin(const PointShell& shell, const std::vector<Box>& boxes) {
  std::vector<std::uint8_t> is_kept(shell.size());
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    is_kept[i] = std::ranges::any_of(boxes, [&](const Box& box) { return isWithin(shell.points[i], box); });
  return is_kept;
}

/// The nodes that still have a point. Their spheres do not change, because a leaf's points are stored as
/// offsets from its centre and must be rounded as before.
std::vector<ShellNode> keptNodes(const PointShell& shell, const std::vector<std::uint32_t>& points_before) {
  const auto countOf = [&](const ShellNode& node) {
    return points_before[node.first + node.count] - points_before[node.first];
  };
  std::vector<std::uint8_t> is_kept(shell.nodes.size());
  for (std::size_t i = 0; i < is_kept.size(); ++i) is_kept[i] = countOf(shell.nodes[i]) > 0;
  const std::vector<std::uint32_t> nodes_before = keptBefore(is_kept);
  std::vector<ShellNode> nodes;
  nodes.reserve(nodes_before.back());
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    ShellNode node = shell.nodes[i];
    node.count = countOf(node);
    node.first = points_before[node.first];
    node.skip = nodes_before[node.skip];
    nodes.push_back(node);
  }
  return nodes;
}

}  // namespace

PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P) {
  const std::vector<std::uint8_t> is_kept = pointsWithin(shell, boxes_P);
  const std::vector<std::uint32_t> before = keptBefore(is_kept);
  PointShell out;
  out.spacing_m = shell.spacing_m;
  out.points.reserve(before.back());
  out.inward.reserve(before.back());
  out.area_m2.reserve(before.back());
  out.order.reserve(before.back());
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i] == 0) continue;
    out.points.push_back(shell.points[i]);
    out.inward.push_back(shell.inward[i]);
    out.area_m2.push_back(shell.area_m2[i]);
  }
  for (const std::uint32_t i : shell.order)
    if (is_kept[i] != 0) out.order.push_back(before[i]);
  if (before.back() == 0) return out;
  out.nodes = keptNodes(shell, before);
  layOutBlocks(out);
  return out;
}

}  // namespace vps

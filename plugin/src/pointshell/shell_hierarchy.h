// SPDX-License-Identifier: BSD-3-Clause
// The order of a pointshell's points: sorting, bounding spheres, progressive order. Private to the builders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/pointshell.h"

namespace vps {

/// The permutation that sorts points along a k-d tree with the hierarchy's leaves: sortedOrder()[i] is the
/// point that goes to index i. Deterministic. O(n log n).
std::vector<std::uint32_t> sortedOrder(std::span<const Vec3> points);

/// The sphere hierarchy over sorted points: ranges are halved until a leaf has 16 or fewer.
std::vector<ShellNode> sphereHierarchy(std::span<const Vec3> points);

/// Up to sixteen consecutive points of a shell as a block, about the node's centre.
ShellBlock leafBlock(const PointShell& shell, const ShellNode& leaf);

/// Fills shell.blocks from its points, areas and the leaves of its nodes.
void layOutBlocks(PointShell& shell);

/// A permutation whose prefixes are even samplings: with R the least gap between points of the prefix, every
/// point is within 2 R of it, while R is larger than the points' own spacing.
std::vector<std::uint32_t> progressiveOrder(std::span<const Vec3> points);

}  // namespace vps

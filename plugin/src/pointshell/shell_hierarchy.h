// SPDX-License-Identifier: BSD-3-Clause
// How a pointshell is laid out: sorting, bounding spheres, progressive order. Private to the pointshell's
// builders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/pointshell.h"

namespace vps {

/// The permutation that sorts points along a k-d tree whose leaves are the hierarchy's: sortedOrder()[i] is
/// the point that goes to place i. Deterministic. O(n log n).
std::vector<std::uint32_t> sortedOrder(std::span<const Vec3> points);

/// The sphere hierarchy over points that lie in sorted order: ranges are halved until a leaf holds 16 or
/// fewer.
std::vector<ShellNode> sphereHierarchy(std::span<const Vec3> points);

/// Up to sixteen points in a row of a shell as a block, about the node's centre.
ShellBlock leafBlock(const PointShell& shell, const ShellNode& leaf);

/// Fills shell.blocks from its points, areas and the leaves of its nodes.
void layOutBlocks(PointShell& shell);

/// A permutation of which every prefix is an even sampling: with R the least gap between points of the
/// prefix, every point is within 2 R of it, as long as R is above the points' own spacing.
std::vector<std::uint32_t> progressiveOrder(std::span<const Vec3> points);

}  // namespace vps

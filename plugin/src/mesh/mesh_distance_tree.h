// SPDX-License-Identifier: BSD-3-Clause
// How deep MeshDistance's tree can be, for the stacks that walk it.
#pragma once

namespace vps {

/// Nodes on these levels divide their triangles by area, which may take off few at a time; nodes below, by
/// count, so that each of the eight children has an eighth of their triangles, up to eight.
inline constexpr int kTreeLevelsByArea = 20;
/// Levels of nodes at most: by count, ten for the 2^28 groups of eight triangles that there can be, and one
/// whose children are triangles.
inline constexpr int kTreeLevels = kTreeLevelsByArea + 11;

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// The grid nodes within a convex region, as rows along z: the innermost loop of the voxeliser.
#pragma once

#include <cstdint>

namespace vps {

/// Edge of the cube of cells that is worked on at once, and nodes along it: the last ones are also the next
/// tile's first, so that a tile's bricks come with their borders.
inline constexpr int kTile = 32;
inline constexpr int kTileNodes = kTile + 1;

/// Nodes (x, y, low) to (x, y, high) of a tile.
struct SplatRow {
  std::uint8_t x, y, low, high;
};
inline constexpr int kMaxRows = kTileNodes * kTileNodes;

/// A region: planes, each solved for z, within a box of nodes. Plane k bounds z from below, where its lift is
/// 0 and its drop is +kNoBound, or from above, the other way round: both alike, so that no branch is needed.
struct SplatRegion {
  static constexpr int kMaxPlanes = 8;
  static constexpr float kNoBound = 1e30F;
  int count = 0;
  float at[kMaxPlanes], per_x[kMaxPlanes], per_y[kMaxPlanes], lift[kMaxPlanes], drop[kMaxPlanes];
  int low[3], high[3];           ///< first and last node
  double origin[3] = {0, 0, 0};  ///< where node 0 lies in the coordinates that planes are given in

  /// Adds a x + b y + c z + d >= 0, all up to a factor of `scale` > 0: a slack of kRoundingMargin scale is
  /// added.
  void add(double a, double b, double c, double d, double scale);

  /// In voxels: what rounding to float may cost, and more. The rows are a superset; who takes them decides.
  static constexpr double kRoundingMargin = 1e-4;
};

/// Finds the rows of a region; they must hold kMaxRows. Returns how many. Every node of the region is in one;
/// a row may hold nodes that are kRoundingMargin beyond it.
int findRows(const SplatRegion& region, SplatRow* rows);
/// The same without the machine's own vector instructions, for comparison.
int findRowsBaseline(const SplatRegion& region, SplatRow* rows);

}  // namespace vps

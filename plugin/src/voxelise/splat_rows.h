// SPDX-License-Identifier: BSD-3-Clause
// Finds the grid nodes within a convex region, as rows along z: the innermost loop of the voxeliser.
#pragma once

#include <cstdint>

namespace vps {

/// Cells along the edge of a tile, the cube that is processed at once, and nodes along it. The last nodes are
/// also the first nodes of the next tile, so that a tile's bricks have their borders.
inline constexpr int kTile = 32;
inline constexpr int kTileNodes = kTile + 1;

/// Nodes (x, y, low) to (x, y, high) of a tile.
struct SplatRow {
  std::uint8_t x, y, low, high;
};
inline constexpr int kMaxRows = kTileNodes * kTileNodes;

/// A region: planes, each solved for z, within a box of nodes. A plane that bounds z from below has lift 0
/// and drop +kNoBound; a plane that bounds z from above has lift -kNoBound and drop 0. Both cases are
/// therefore evaluated by the same operations, without a branch.
struct SplatRegion {
  static constexpr int kMaxPlanes = 8;
  static constexpr float kNoBound = 1e30F;
  int count = 0;
  float at[kMaxPlanes], per_x[kMaxPlanes], per_y[kMaxPlanes], lift[kMaxPlanes], drop[kMaxPlanes];
  int low[3], high[3];           ///< first and last node
  double origin[3] = {0, 0, 0};  ///< position of node 0 in the coordinates of the planes

  /// Adds the plane a x + b y + c z + d >= 0, all up to a factor of `scale` > 0, with a margin of
  /// kRoundingMargin scale.
  void add(double a, double b, double c, double d, double scale);

  /// Margin for the rounding of floats [voxels]. The rows are a superset; the caller tests each node.
  static constexpr double kRoundingMargin = 1e-4;
};

/// Finds the rows of a region and returns their number; `rows` must have room for kMaxRows. Every node of the
/// region is in a row; a row may hold nodes that are kRoundingMargin beyond the region.
int findRows(const SplatRegion& region, SplatRow* rows);
/// As findRows(), without the processor's own vector instructions, for comparison.
int findRowsBaseline(const SplatRegion& region, SplatRow* rows);

}  // namespace vps

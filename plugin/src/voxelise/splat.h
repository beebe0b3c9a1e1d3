// SPDX-License-Identifier: BSD-3-Clause
// Writes the features of a surface into tiles of grid nodes. Each node gets the signed distance to the
// nearest feature in whose region it lies; this is the distance to the surface (surface_features.h).
//
// The cost is proportional to the number of nodes within the band, not to that number times the triangles
// around each node: most nodes are in the region of only one or two features.
#pragma once

#include <array>
#include <memory>

#include "voxelise/splat_rows.h"
#include "voxelise/surface_features.h"

namespace vps {

using Tile = std::array<float, std::size_t{kTileNodes} * kTileNodes * kTileNodes>;
constexpr int tileIndex(int x, int y, int z) {
  return (x * kTileNodes + y) * kTileNodes + z;
}

/// Reads features; use one Splatter per thread.
class Splatter {
 public:
  /// @param band  greatest distance that is written, in voxels
  Splatter(const SurfaceFeatures& features, double band) : features_(features), band_(band) {}

  /// Features are numbered faces first, then edges, then vertices.
  [[nodiscard]] std::uint32_t count() const {
    return features_.faceCount() + features_.edgeCount() + features_.vertexCount();
  }

  /// Box around the nodes to which a feature can be nearest, empty (min > max) if there are none [voxels].
  [[nodiscard]] Box reach(std::uint32_t feature);
  /// False only if a feature is certain not to come within the band of a ball.
  [[nodiscard]] bool reaches(std::uint32_t feature, const Vec3& center, double radius) const;

  /// Writes to the nodes of a tile whose first node lies at `origin`. Nodes hold FLT_MAX or a signed distance
  /// in voxels, negative inside; of two equal distances the first is kept.
  void splat(std::uint32_t feature, const Vec3& origin, float* tile);

 private:
  struct Face;
  struct Edge;
  struct Corner;
  template <typename Visit>
  auto withFeature(std::uint32_t feature, const Vec3& origin, Visit visit);

  const SurfaceFeatures& features_;
  double band_;
  std::array<SplatRow, kMaxRows + 8> rows_;
  std::vector<Vec3> spokes_;
};

}  // namespace vps

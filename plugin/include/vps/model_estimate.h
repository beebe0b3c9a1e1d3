// SPDX-License-Identifier: BSD-3-Clause
// What the models of a part will cost in memory, estimated from its mesh; nothing is built.
#pragma once

#include <vector>

#include "vps/box.h"
#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// The size of a part's voxmap and pointshell, whole or cropped to some boxes. Bricks and face points follow
/// from the surface's area, points on sharp edges are counted. The mesh should have shared vertices: without
/// them every edge counts as sharp.
class VPS_API ModelEstimate {
 public:
  /// Which models are asked for: whole or cropped ones, or whole ones alone.
  enum class Extent { Any, WholeOnly };
  /// O(n log n) for n triangles, at most some 20,000 pieces of larger ones, and the points of sharp edges.
  /// @param extent  WholeOnly: a few numbers are kept, no pieces of surface; cropped models count as whole
  ModelEstimate(const Mesh& mesh, const VoxMapSettings& voxels, const PointShellSettings& points,
                Extent extent = Extent::Any);

  /// Of VoxMap::memoryBytes(), of the map as croppedVoxMap() leaves it; no boxes: the whole map.
  [[nodiscard]] double mapBytes(const std::vector<Box>& kept_P = {}) const;
  /// Of PointShell::size(), of the shell as croppedShell() leaves it; no boxes: the whole shell.
  [[nodiscard]] double pointCount(const std::vector<Box>& kept_P = {}) const;
  /// Of PointShell::memoryBytes() of a shell with so many points.
  [[nodiscard]] static double shellBytes(double point_count);

 private:
  struct Piece {
    Vec3 center_P;
    double area_m2;
  };
  void addPieces(const Vec3& a, const Vec3& b, const Vec3& c, double piece_m);
  [[nodiscard]] bool isCropped(const std::vector<Box>& kept_P) const {
    return extent_ == Extent::Any && !kept_P.empty();
  }
  [[nodiscard]] double areaWithin(const std::vector<Box>& boxes_P) const;

  std::vector<Piece> pieces_;
  std::vector<Vec3> edge_points_P_;
  Extent extent_ = Extent::Any;
  double area_m2_ = 0, directory_bytes_ = 0, edge_points_ = 0;
  double cell_m_ = 0, bricks_per_m2_ = 0, face_points_per_m2_ = 0;
};

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Estimates, from a mesh, how much memory the models of a part will need; nothing is built.
#pragma once

#include <vector>

#include "vps/box.h"
#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

/// The size of a part's voxmap and pointshell, whole or cropped to some boxes. Bricks and face points are
/// estimated from the surface's area, points on sharp edges are counted. The mesh should have shared
/// vertices; otherwise every edge counts as sharp.
class VPS_API ModelEstimate {
 public:
  /// WholeOnly: only whole models are asked for; no pieces of surface are stored, and cropped models get the
  /// size of whole ones.
  enum class Extent { Any, WholeOnly };
  /// O(n log n) for n triangles. Stores at most about 20,000 pieces of large triangles, and the points of
  /// sharp edges.
  ModelEstimate(const Mesh& mesh, const VoxMapSettings& voxels, const PointShellSettings& points,
                Extent extent = Extent::Any);

  /// Estimate of VoxMap::memoryBytes() of the map that croppedVoxMap() returns; no boxes: of the whole map.
  [[nodiscard]] double mapBytes(const std::vector<Box>& kept_P = {}) const;
  /// Estimate of PointShell::size() of the shell that croppedShell() returns; no boxes: of the whole shell.
  [[nodiscard]] double pointCount(const std::vector<Box>& kept_P = {}) const;
  /// Estimate of PointShell::memoryBytes() of a shell with `point_count` points.
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

// SPDX-License-Identifier: BSD-3-Clause
// Pairs of parts in contact, bounds of the error of their fields, and the tiles of their surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "vps/edge_crossing.h"
#include "vps/part_model.h"

namespace vps::bench {

/// Two parts of a fit, and the direction in which the second moves until they touch.
struct Fit {
  std::string name;
  Mesh mesh[2];
  std::vector<Pose> X_01;           ///< poses of part 1 in part 0, before part 1 is moved along `way`
  Vec3 way = Vec3::Zero();          ///< unit vector in part 0
  double play_m = 0;                ///< the parts touch within this distance
  double fine_m = 0, coarse_m = 0;  ///< voxel sizes
  double spacing_m = 0;             ///< spacing of the points
};

/// @param is_short  one pose of each fit, and only the first two fits
std::vector<Fit> allFits(bool is_short);

using Model = std::shared_ptr<const PartModel>;

Model modelOf(const Mesh& mesh, double voxel_m, double spacing_m);

/// The pose of the fit at which the parts touch: no point of either is more than 0.1 um inside the other.
Pose touching(const Fit& fit, const Pose& X_01, const Model (&model)[2]);

enum class Bound {
  Everywhere,   ///< half a voxel
  BesideEdges,  ///< half a voxel within a voxel of a sharp edge, a twentieth of a voxel elsewhere
  Block,        ///< stored for each block of 8 x 8 x 8 voxels
  Cell,         ///< stored for each voxel
  ShellLeaf,    ///< the greatest true error of sixteen neighbouring points, which depends on the pose
};
inline constexpr std::array<Bound, 5> kBounds = {Bound::Everywhere, Bound::BesideEdges, Bound::Block,
                                                 Bound::Cell, Bound::ShellLeaf};

/// Bounds of reading minus distance in the field of a part. Stored bounds are measured at the points of a
/// fixed grid within a voxel of the surface, and rounded up.
class FieldError {
 public:
  explicit FieldError(const Model& part);

  [[nodiscard]] bool isBesideEdge(const Vec3& p_M) const;
  /// Must not be called for Bound::ShellLeaf, which depends on the pose.
  [[nodiscard]] double bound_m(Bound bound, const Vec3& p_M);

 private:
  using Stored = std::unordered_map<std::uint64_t, double>;
  [[nodiscard]] std::uint64_t keyOf(const Vec3& p_M, double size_m) const;
  double stored_m(Stored& stored, const Vec3& p_M, double size_m, int places);

  Model part_;
  EdgeSet edges_;
  Stored cells_, blocks_;
};

/// A point of one part in the field of the other.
struct Reading {
  Vec3 p, inward;  ///< point and inward normal, in the frame of the part that has the point
  double reading_m = 0, distance_m = 0;  ///< distance by the field, and exact distance
  std::array<double, kBounds.size()> bound_m =
      {};  ///< bounds of the difference between both distances, indexed by Bound
  bool is_beside_edge = false;
  [[nodiscard]] double least_m(Bound bound) const {
    return reading_m - bound_m[static_cast<std::size_t>(bound)];
  }
};

struct Count {
  double tiles = 0, exact = 0, beside_edges = 0, broken = 0;
  double most = 0;  ///< greatest number of exact distances in a tile
  void add(const Count& other);
};

/// Reads the points of a part that are nearer than near_m in the field of another part.
std::vector<Reading> readPoints(const PartModel& points_of, const PartModel& in, FieldError& error,
                                const Pose& X_MP, double near_m);

/// Counts the exact distances that close all tiles. In each tile points are measured in the order of their
/// lower bounds, until the least distance is at most the least remaining bound, or the remaining bounds are
/// above reach_m. `broken` counts distances below their bounds.
/// @param tile_m  points are in one tile if they are in one cell of this size and their normals in one of 24
///                directions
Count closeTiles(const std::vector<Reading>& readings, double tile_m, Bound bound, double reach_m);

}  // namespace vps::bench

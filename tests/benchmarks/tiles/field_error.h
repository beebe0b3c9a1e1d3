// SPDX-License-Identifier: BSD-3-Clause
// How much more a field may read than the distance is: five answers.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "cases.h"
#include "vps/edge_crossing.h"

namespace vps::bench {

enum class Bound {
  Everywhere,   ///< half a voxel
  BesideEdges,  ///< half a voxel within a voxel of a sharp edge, a twentieth elsewhere
  Block,        ///< stored for each block of 8 x 8 x 8 voxels
  Cell,         ///< stored for each voxel
  ShellLeaf,    ///< the greatest true error of sixteen neighbouring points: needs the pose
};
inline constexpr std::array<Bound, 5> kBounds = {Bound::Everywhere, Bound::BesideEdges, Bound::Block,
                                                 Bound::Cell, Bound::ShellLeaf};

/// Bounds of reading minus distance in the field of a part. Stored ones are measured at the places of a fixed
/// grid within a voxel of the surface, and rounded up.
class FieldError {
 public:
  explicit FieldError(const Model& part);

  [[nodiscard]] bool isBesideEdge(const Vec3& p_M) const;
  /// Not of Bound::ShellLeaf, which is not known here.
  [[nodiscard]] double bound_m(Bound bound, const Vec3& p_M);

 private:
  using Stored = std::unordered_map<std::uint64_t, double>;
  [[nodiscard]] std::uint64_t keyOf(const Vec3& p_M, double size_m) const;
  double stored_m(Stored& stored, const Vec3& p_M, double size_m, int places);

  Model part_;
  EdgeSet edges_;
  Stored cells_, blocks_;
};

}  // namespace vps::bench

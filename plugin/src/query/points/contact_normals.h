// SPDX-License-Identifier: BSD-3-Clause
// Computes normals at touching points, several at a time.
#pragma once

#include "query/points/leaf_walk.h"
#include "vps/query.h"

namespace vps {

/// The field's value at the exact position of a lane's point [quanta]. The read itself rounds positions to
/// steps of 1/16384 voxel (15 nm at 0.25 mm); this function extrapolates its value with the gradient of the
/// trilinear interpolation. Without the extrapolation a stiff contact would show the steps.
/// @param p_P  position of the lane's point
double readingAt(const ReadLeaf& leaf, int lane, const GridPose& motion, const Vec3& p_P) noexcept;

/// Collects points of leaves that have been read and computes their unit outward normals. `Continuous` reads
/// the field one voxel before and one voxel behind along each axis: the difference equals the interpolated
/// central difference of the nodes.
class ContactNormals {
 public:
  ContactNormals(const MapReading& reading, Gradient gradient) noexcept
      : reading_(reading), gradient_(gradient) {}

  void add(const ReadLeaf& leaf, int lane) noexcept;
  [[nodiscard]] bool isFull() const noexcept { return count_ == kMaxCount; }
  /// Computes the normals and returns their number; normal(i) is valid after this.
  int compute() noexcept;
  /// Zero where the field has no direction.
  [[nodiscard]] Vec3 normal(int i) const noexcept {
    const Vec3 g(n_[0][i], n_[1][i], n_[2][i]);
    const double length = g.norm();
    // Where opposite walls cancel there is no direction; a gradient below two quanta is rounding noise.
    return length > 2 ? Vec3(g / length) : Vec3(Vec3::Zero());
  }
  void clear() noexcept { count_ = 0; }

 private:
  static constexpr int kReads = 6;  // two along each axis
  static constexpr int kMaxCount = kBatchLanes / kReads;

  const MapReading& reading_;
  const Gradient gradient_;
  int count_ = 0;
  std::int32_t whole_[3][kBatchLanes];
  float t_[3][kBatchLanes];
  float value_[kBatchLanes];
  float n_[3][kMaxCount];  // gradients, of any length [quanta]
};

}  // namespace vps

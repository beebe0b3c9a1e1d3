// SPDX-License-Identifier: BSD-3-Clause
// Normals for points that touch, several at a time.
#pragma once

#include "query/leaf_walk.h"
#include "vps/query.h"

namespace vps {

/// The reading of a lane [quanta], carried from the whole step where its point was placed to where it is,
/// along the trilinear slope: positions of 1/16384 voxel are steps that a stiff spring feels (15 nm at 0.25
/// mm).
/// @param p_P  the lane's point
double readingAt(const ReadLeaf& leaf, int lane, const Motion& motion, const Vec3& p_P) noexcept;

/// Gathers points of read leaves and gives each its unit outward normal. `Continuous` reads the field a voxel
/// before and behind along each axis: the difference is that of nodal central differences, interpolated.
class ContactNormals {
 public:
  ContactNormals(const Reading& reading, Gradient gradient) noexcept
      : reading_(reading), gradient_(gradient) {}

  void add(const ReadLeaf& leaf, int lane) noexcept;
  [[nodiscard]] bool isFull() const noexcept { return count_ == kMost; }
  /// How many there are; normal(i) is valid for each after this.
  int compute() noexcept;
  /// Zero where the field has no direction.
  [[nodiscard]] Vec3 normal(int i) const noexcept {
    const Vec3 g(n_[0][i], n_[1][i], n_[2][i]);
    const double length = g.norm();
    // Where opposite walls cancel there is no direction; below two quanta it is rounding noise.
    return length > 2 ? Vec3(g / length) : Vec3(Vec3::Zero());
  }
  void clear() noexcept { count_ = 0; }

 private:
  static constexpr int kReads = 6;  // two along each axis
  static constexpr int kMost = kBatchLanes / kReads;

  const Reading& reading_;
  const Gradient gradient_;
  int count_ = 0;
  std::int32_t whole_[3][kBatchLanes];
  float t_[3][kBatchLanes];
  float value_[kBatchLanes];
  float n_[3][kMost];  // gradients, of any length [quanta]
};

}  // namespace vps

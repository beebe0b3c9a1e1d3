// SPDX-License-Identifier: BSD-3-Clause
// Sums over the touching points of leaves that have been read.
//
// The order of summation is the same for every processor and every way of culling: leaf by leaf in ascending
// order within a row of sixteen leaves, separately for sixteen lanes; rows in ascending order within a group
// of 256 leaves; then the lanes, by halves; then groups in ascending order. A leaf that does not touch adds
// nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "query/points/contact_normals.h"
#include "query/points/leaf_walk.h"
#include "vps/query.h"

namespace vps {

inline double sumOfLanes(const double lanes[kLanes]) {
  double sum[kLanes];
  std::copy_n(lanes, kLanes, sum);
  for (int half = kLanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) sum[i] += sum[i + half];
  return sum[0];
}

/// Adds up leaves, then rows, then groups.
class WrenchCollector {
 public:
  WrenchCollector(const MapReading& reading, const Pose& X_MP, Gradient gradient, const Vec3& p_MO) noexcept
      : reading_(reading), X_MP_(X_MP), gradient_(gradient), normals_(reading, gradient) {
    for (int k = 0; k < 3; ++k) {
      const double o = p_MO[k] / reading.field.voxel_m - reading.field.low[k];
      reference_[k] = static_cast<std::int32_t>(std::clamp(std::floor(o), -1e9, 1e9));
      from_reference_[k] = o - reference_[k];
    }
  }

  void take(const ReadLeaf& leaf) noexcept {
    least_ = std::min(least_, leaf.least());
    if (!(leaf.least() <= 0)) return;
    startRow(leaf.index / kLanes);
    if (gradient_ == Gradient::Trilinear) {
      std::uint32_t lost =
          reading_.kernels.touch(reading_.motion, leaf.batch, leaf.slot, leaf.block, reference_, row_sums_);
      for (int lane = 0; lost != 0; ++lane, lost >>= 1)
        if (lost & 1) addForce(entryOf(leaf, lane), inwardOf(leaf, lane));
    } else {
      for (int lane = 0; lane < static_cast<int>(leaf.block.count); ++lane)
        if (leaf.value(lane) <= 0) addWaiting(leaf, lane);
    }
  }

  void finish() noexcept {
    finishRow();
    finishGroup();
  }

  /// Least reading so far [quanta].
  [[nodiscard]] float least() const noexcept { return least_; }

  /// The sums multiplied by the stiffness, with the wrench about O.
  [[nodiscard]] TouchSummary summary(double k_N_per_m3) const noexcept {
    TouchSummary out;
    const double quantum_m = reading_.field.quantum_m, h = reading_.field.voxel_m;
    out.count = totals_.count;
    out.area_m2 = totals_.area_m2;
    out.volume_m3 = totals_.area_depth * quantum_m;
    out.max_depth_m = least_ < 0 ? -static_cast<double>(least_) * quantum_m : 0;
    out.F_O_M.f = k_N_per_m3 * quantum_m * totals_.f;
    out.F_O_M.tau = k_N_per_m3 * quantum_m * h * (totals_.tau - from_reference_.cross(totals_.f));
    return out;
  }

 private:
  struct Entry {
    int lane;
    double arm[3];     ///< vector from the reference [voxels]
    double weight;     ///< area times depth [m^2 quanta]
    std::uint32_t id;  ///< id of the point
  };

  [[nodiscard]] Entry entryOf(const ReadLeaf& leaf, int lane) const noexcept {
    const int i = kLanes * leaf.slot + lane;
    const std::int32_t at[3] = {leaf.batch.x[i], leaf.batch.y[i], leaf.batch.z[i]};
    Entry entry;
    entry.lane = lane;
    for (int k = 0; k < 3; ++k)
      entry.arm[k] =
          static_cast<double>(leaf.batch.base[leaf.slot][k] - reference_[k]) + at[k] * (1.0 / kSteps);
    entry.id = leaf.block.first + static_cast<std::uint32_t>(lane);
    const double reading = readingAt(leaf, lane, reading_.motion, reading_.shell.points[entry.id]);
    entry.weight = static_cast<double>(leaf.block.weight[lane]) * std::max(0.0, -reading);
    return entry;
  }
  /// For a point deeper than the band the field has no direction; its own inward normal is used, as in the
  /// original VPS.
  [[nodiscard]] Vec3 inwardOf(const ReadLeaf& leaf, int lane) const noexcept {
    return X_MP_.R * reading_.shell.inward[leaf.block.first + static_cast<std::uint32_t>(lane)];
  }

  void addForce(const Entry& entry, const Vec3& n_M) noexcept {
    const Vec3 f = entry.weight * n_M;
    const Vec3 tau = Vec3(entry.arm[0], entry.arm[1], entry.arm[2]).cross(f);
    for (int k = 0; k < 3; ++k) {
      sums_.f[k][entry.lane] += f[k];
      sums_.tau[k][entry.lane] += tau[k];
    }
  }

  void addWaiting(const ReadLeaf& leaf, int lane) noexcept {
    const Entry entry = entryOf(leaf, lane);
    if (!(entry.weight > 0)) return;
    ++sums_.count[lane];
    sums_.area_m2[lane] += static_cast<double>(leaf.block.weight[lane]);
    sums_.area_depth[lane] += entry.weight;
    waiting_[waiting_count_++] = entry;
    normals_.add(leaf, lane);
    if (normals_.isFull()) addForces();
  }

  void addForces() noexcept {
    normals_.compute();
    for (int i = 0; i < waiting_count_; ++i) {
      const Vec3 n_M = normals_.normal(i);
      addForce(waiting_[i], n_M.isZero(0) ? Vec3(X_MP_.R * reading_.shell.inward[waiting_[i].id]) : n_M);
    }
    normals_.clear();
    waiting_count_ = 0;
  }

  void startRow(std::uint32_t row) noexcept {
    if (row == row_ && has_sums_) return;
    if (has_sums_) finishRow();
    if (row / kGroupRows != row_ / kGroupRows) finishGroup();
    row_ = row;
    has_sums_ = true;
  }

  void finishRow() noexcept {
    if (gradient_ != Gradient::Trilinear) return;
    reading_.kernels.addRow(row_sums_, sums_);
    row_sums_ = RowSums();
  }

  void finishGroup() noexcept {
    if (!has_sums_) return;
    addForces();
    for (int k = 0; k < 3; ++k) {
      totals_.f[k] += sumOfLanes(sums_.f[k]);
      totals_.tau[k] += sumOfLanes(sums_.tau[k]);
    }
    totals_.area_m2 += sumOfLanes(sums_.area_m2);
    totals_.area_depth += sumOfLanes(sums_.area_depth);
    for (const std::uint32_t count : sums_.count) totals_.count += count;
    sums_ = TouchSums();
    has_sums_ = false;
  }

  const MapReading& reading_;
  const Pose& X_MP_;
  const Gradient gradient_;
  std::int32_t reference_[3];
  Vec3 from_reference_;
  RowSums row_sums_;
  TouchSums sums_;
  bool has_sums_ = false;
  std::uint32_t row_ = 0;
  ContactNormals normals_;
  Entry waiting_[kBatchLanes];
  int waiting_count_ = 0;
  struct {
    Vec3 f = Vec3::Zero(), tau = Vec3::Zero();  ///< as in TouchSums
    double area_m2 = 0, area_depth = 0;
    std::size_t count = 0;
  } totals_;  // sums over whole groups
  float least_ = std::numeric_limits<float>::infinity();
};

}  // namespace vps

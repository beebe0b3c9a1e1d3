// SPDX-License-Identifier: BSD-3-Clause
// Turns leaves that have been read into contacts: position, distance, normal, owner.
#pragma once

#include <algorithm>
#include <limits>

#include "query/points/contact_normals.h"
#include "query/points/leaf_walk.h"
#include "voxmap/voxmap_sampler.h"

namespace vps {

/// The cutoff limited to slightly less than the band: a saturated reading only means "far" and is never a
/// contact.
inline double usedCutoff(const VoxMap& map, double cutoff_m) noexcept {
  return std::min(cutoff_m, map.band_m() - 0.01 * map.voxel_m());
}

/// Collects the contacts of leaves that have been read.
class ContactCollector {
 public:
  ContactCollector(const VoxMap& map, const MapReading& reading, const Pose& X_MP,
                   const QueryOptions& options, double cutoff_m, ContactSet& out) noexcept
      : sampler_(map),
        reading_(reading),
        X_MP_(X_MP),
        cutoff_(static_cast<float>(cutoff_m / reading.field.quantum_m)),
        has_owners_(map.partCount() > 1),
        normals_(reading, options.gradient),
        out_(out) {}

  /// Adds all of a leaf's points within the cutoff.
  void take(const ReadLeaf& leaf) noexcept {
    least_ = std::min(least_, leaf.least());
    if (!(leaf.least() <= cutoff_)) return;
    for (std::uint32_t lane = 0; lane < leaf.block.count; ++lane)
      if (leaf.value(static_cast<int>(lane)) <= cutoff_) add(leaf, static_cast<int>(lane));
  }

  /// Adds one point of a leaf.
  void add(const ReadLeaf& leaf, int lane) noexcept {
    if (out_.contacts.size() == out_.contacts.capacity()) {
      ++out_.left_out;
      return;
    }
    const std::uint32_t id = leaf.block.first + static_cast<std::uint32_t>(lane);
    const Vec3 p_M = X_MP_ * reading_.shell.points[id];
    const std::uint16_t owner = has_owners_ ? sampler_.owner(sampler_.place(p_M)) : std::uint16_t{0};
    out_.contacts.push_back(
        {p_M, Vec3::Zero(),
         reading_.field.quantum_m * readingAt(leaf, lane, reading_.motion, reading_.shell.points[id]),
         reading_.shell.area_m2[id], id, owner});
    normals_.add(leaf, lane);
    if (normals_.isFull()) giveNormals();
  }

  void finish() noexcept { giveNormals(); }

  /// Least reading so far [quanta].
  [[nodiscard]] float least() const noexcept { return least_; }

 private:
  void giveNormals() noexcept {
    const int count = normals_.compute();
    for (int i = 0; i < count; ++i) {
      Contact& c = out_.contacts[done_++];
      c.n_M = normals_.normal(i);
      // A point deeper than the band has no direction in the field; its own inward normal is used, as in the
      // original VPS.
      if (c.n_M.isZero(0)) c.n_M = X_MP_.R * reading_.shell.inward[c.id];
    }
    normals_.clear();
  }

  VoxSampler sampler_;
  const MapReading& reading_;
  const Pose& X_MP_;
  const float cutoff_;
  const bool has_owners_;
  ContactNormals normals_;
  ContactSet& out_;
  std::size_t done_ = 0;
  float least_ = std::numeric_limits<float>::infinity();
};

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Who touches, and how far off the nearest is. Whole clusters are skipped where the field proves that none of
// their points can matter. The proof must hold for the field as it is read, not for the true distance,
// because the answer promised is that of reading it at every point (read_kernel.inc has the bounds).
#include "vps/query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coherent_walk.h"
#include "contact_normals.h"
#include "leaf_walk.h"
#include "voxmap_layout.h"
#include "voxmap_sampling.h"

namespace vps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A saturated reading says only "far": it is never a contact, however wide the cutoff.
double usedCutoff(const VoxMap& map, double cutoff_m) {
  return std::min(cutoff_m, map.band_m() - 0.01 * map.voxel_m());
}

/// Collects the contacts of leaves that have been read.
class ContactCollector {
 public:
  ContactCollector(const VoxMap& map, const Reading& reading, const Pose& X_MP, const QueryOptions& options,
                   double cutoff_m, ContactSet& out) noexcept
      : sampler_(map),
        reading_(reading),
        X_MP_(X_MP),
        cutoff_(static_cast<float>(cutoff_m / reading.field.quantum_m)),
        has_owners_(map.partCount() > 1),
        normals_(reading, options.gradient),
        out_(out) {}

  void take(const ReadLeaf& leaf) noexcept {
    least_ = std::min(least_, leaf.least());
    if (!(leaf.least() <= cutoff_)) return;
    for (std::uint32_t lane = 0; lane < leaf.block.count; ++lane)
      if (leaf.value(static_cast<int>(lane)) <= cutoff_) add(leaf, static_cast<int>(lane));
  }

  void finish() noexcept { giveNormals(); }

  /// Least reading so far [quanta].
  [[nodiscard]] float least() const noexcept { return least_; }

 private:
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

  void giveNormals() noexcept {
    const int count = normals_.compute();
    for (int i = 0; i < count; ++i) {
      Contact& c = out_.contacts[done_++];
      c.n_M = normals_.normal(i);
      // Deeper than the band the field knows no way out; the point's own inward normal is the older VPS's
      // answer.
      if (c.n_M.isZero(0)) c.n_M = X_MP_.R * reading_.shell.inward[c.id];
    }
    normals_.clear();
  }

  VoxSampler sampler_;
  const Reading& reading_;
  const Pose& X_MP_;
  const float cutoff_;
  const bool has_owners_;
  ContactNormals normals_;
  ContactSet& out_;
  std::size_t done_ = 0;
  float least_ = std::numeric_limits<float>::infinity();
};

/// Least over the shell of a lower bound of the true distance, for shells that are all beyond the band:
/// spheres are opened until they are small beside their distance, since a quarter is precise enough to go by.
double farBound(const VoxSampler& sampler, const PointShell& shell, const Pose& X_MP) noexcept {
  constexpr double kSmall = 0.25;  // assumed
  const auto least = [&](const Vec3& p_P) {
    const Vec3 p_M = X_MP * p_P;
    return sampler.leastDistance(p_M, sampler.place(p_M));
  };
  double least_m = kInfinity;
  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    const double center_m = least(node.center);
    const bool is_worse = center_m - node.radius_m >= least_m;
    if (is_worse || node.radius_m <= kSmall * center_m) {
      least_m = std::min(least_m, center_m - node.radius_m);
      i = node.skip;
      continue;
    }
    ++i;
    if (!node.is_leaf) continue;
    for (std::uint32_t id = node.first; id < node.first + node.count; ++id)
      least_m = std::min(least_m, least(shell.points[id]));
  }
  return least_m;
}

/// Branch and bound for the least reading [quanta]: spheres with the nearest centres first.
class LeastReading {
 public:
  explicit LeastReading(const Reading& reading) noexcept : reading_(reading), reader_(reading, {this}) {}

  float find() noexcept {
    if (!reading_.shell.blocks.empty()) open(static_cast<std::uint32_t>(reading_.shell.blocks.size() - 1));
    return least_;
  }
  [[nodiscard]] std::size_t pointsRead() const noexcept { return reader_.pointsRead(); }

 private:
  void open(std::uint32_t index) noexcept {
    const ShellBlock& block = reading_.shell.blocks[index];
    if (block.is_leaf) {
      reader_.add(index);
      reader_.flush();
      return;
    }
    SphereBounds bounds;
    reading_.kernels.bound(reading_.field, reading_.motion, block, 0, bounds);
    std::uint32_t order[kLanes];
    for (std::uint32_t i = 0; i < block.count; ++i) order[i] = i;
    std::sort(order, order + block.count, [&](std::uint32_t a, std::uint32_t b) {
      return bounds.center[a] != bounds.center[b] ? bounds.center[a] < bounds.center[b] : a < b;
    });
    // Once a point reads -band nothing can read less.
    for (std::uint32_t k = 0; k < block.count && least_ > -kFullBand; ++k)
      if (bounds.least[order[k]] < reading_.field.quantum * least_) open(block.first + order[k]);
  }

  struct Consume {
    LeastReading* self;
    void operator()(const ReadLeaf& leaf) const { self->least_ = std::min(self->least_, leaf.least()); }
  };
  const Reading& reading_;
  LeafReader<Consume> reader_;
  float least_ = kFullBand;
};

}  // namespace

QueryResult queryContacts(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                          const QueryOptions& options, ContactSet& out, QueryMemory* memory) noexcept {
  out.contacts.clear();
  out.left_out = 0;
  QueryResult result;
  if (!X_MP.isFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const Reading reading(map, shell, X_MP, options.simd);
  const double cutoff_m = usedCutoff(map, options.cutoff_m);
  ContactCollector collector(map, reading, X_MP, options, cutoff_m, out);
  const double least_skipped =
      readNearLeaves(reading, X_MP, options, cutoff_m, usable(memory, map, shell), result.points_tested,
                     [&](const ReadLeaf& leaf) { collector.take(leaf); });
  collector.finish();
  if (out.left_out > 0) result.status = Status::Truncated;
  setDistance(map, reading, collector.least(), least_skipped, result);
  return result;
}

QueryResult queryDistance(const VoxMap& map, const PointShell& shell, const Pose& X_MP, Simd simd) noexcept {
  QueryResult result;
  if (!X_MP.isFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const Reading reading(map, shell, X_MP, simd);
  LeastReading search(reading);
  result.min_distance_m = reading.field.quantum_m * search.find();
  result.points_tested = search.pointsRead();
  result.is_beyond_band = !(result.min_distance_m < map.band_m());
  if (result.is_beyond_band) {
    result.status = Status::BeyondBand;
    // Saturated readings allow for a true distance that is half a cell's diagonal less.
    result.min_distance_m =
        std::max(farBound(VoxSampler(map), shell, X_MP), map.band_m() - map.sampleError_m());
  }
  return result;
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Contacts and least distance. Clusters of points are skipped if the field proves that none of their points
// matters. The proof must hold for the field as it is interpolated, not for the true distance, because the
// result must equal that of reading the field at every point (read_kernel.inc has the bounds).
#include "vps/query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "query/points/coherent_walk.h"
#include "query/points/contact_collector.h"
#include "query/points/leaf_walk.h"
#include "voxmap/voxmap_layout.h"
#include "voxmap/voxmap_sampler.h"

namespace vps {
namespace {

/// The least lower bound of the true distance over a shell that lies entirely beyond the band. Spheres are
/// opened until they are small compared with their distance; a quarter is precise enough.
double farBound(const VoxSampler& sampler, const PointShell& shell, const Pose& X_MP) noexcept {
  constexpr double kSmall = 0.25;  // assumed
  const auto least = [&](const Vec3& p_P) {
    const Vec3 p_M = X_MP * p_P;
    return sampler.leastDistance(p_M, sampler.place(p_M));
  };
  double least_m = std::numeric_limits<double>::infinity();
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

/// Branch and bound for the least reading [quanta]: spheres with the nearest centres are opened first.
class LeastReading {
 public:
  explicit LeastReading(const MapReading& reading) noexcept : reading_(reading), reader_(reading, {this}) {}

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
    // No point can read less than -band.
    for (std::uint32_t k = 0; k < block.count && least_ > -kFullBand; ++k)
      if (bounds.least[order[k]] < reading_.field.quantum * least_) open(block.first + order[k]);
  }

  struct Consume {
    LeastReading* self;
    void operator()(const ReadLeaf& leaf) const { self->least_ = std::min(self->least_, leaf.least()); }
  };
  const MapReading& reading_;
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
  const MapReading reading(map, shell, X_MP, options.simd);
  const double cutoff_m = usedCutoff(map, options.cutoff_m);
  ContactCollector collector(map, reading, X_MP, options, cutoff_m, out);
  const double least_skipped =
      readNearLeaves(reading, X_MP, options, cutoff_m, memoryFor(memory, map, shell), result.points_tested,
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
  const MapReading reading(map, shell, X_MP, simd);
  LeastReading search(reading);
  result.min_distance_m = reading.field.quantum_m * search.find();
  result.points_tested = search.pointsRead();
  result.is_beyond_band = !(result.min_distance_m < map.band_m());
  if (result.is_beyond_band) {
    result.status = Status::BeyondBand;
    // A saturated reading is compatible with a true distance that is half a cell's diagonal less.
    result.min_distance_m =
        std::max(farBound(VoxSampler(map), shell, X_MP), map.band_m() - map.sampleError_m());
  }
  return result;
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Rigid resampling: a part's own field is read at the nodes of another grid. Mounting writes the values
// directly into the cooked map.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxmap/kernels/read_kernel.h"
#include "voxmap/map_limits.h"
#include "voxmap/voxmap_access.h"
#include "voxmap/voxmap_sampler.h"
#include "vps/errors.h"

namespace vps {
namespace {

constexpr int kBlocksOfBrick = kBrickStride / kLanes;
static_assert(kBrickStride % kLanes == 0);

/// The nodes of a brick as blocks of points about the brick's centre.
std::vector<ShellBlock> nodeBlocks(double voxel_m) {
  std::vector<ShellBlock> blocks(kBlocksOfBrick);
  for (int i = 0; i < static_cast<int>(kBrickStride); ++i) {
    ShellBlock& block = blocks[static_cast<std::size_t>(i / kLanes)];
    const int node = std::min(i, kBrickNodes - 1);  // the padding after the last node repeats it
    const Vec3 offset = voxel_m * (nodeAt(node) - Index3::Constant(kBrick / 2)).cast<double>();
    block.x[i % kLanes] = static_cast<float>(offset.x());
    block.y[i % kLanes] = static_cast<float>(offset.y());
    block.z[i % kLanes] = static_cast<float>(offset.z());
    block.count = kLanes;
    block.is_leaf = 1;
    block.radius_m = std::max(block.radius_m, offset.norm() * (1 + 1e-6));
  }
  return blocks;
}

/// A map's field on another grid, at a pose.
class ResampledField final : public AddedField {
 public:
  ResampledField(const PlacedMap& part, double voxel_m, double band_m, double quantum_m)
      : map_(*part.map),
        sampler_(map_),
        X_PM_(part.X_MP.inverse()),
        voxel_m_(voxel_m),
        field_(map_),
        kernels_(readKernels(Simd::Best)),
        blocks_(nodeBlocks(voxel_m)),
        quanta_(static_cast<float>(field_.quantum_m / quantum_m)) {
    const double ratio = map_.voxel_m() / voxel_m;
    // Nodes have the field's error, and neighbours differ by at most the field's slope over a voxel.
    node_error = static_cast<float>(field_.error * ratio);
    steepest = field_.slope;
    is_metric = field_.is_metric;
    for (int i = 0; i < 8; ++i) {
      const Box& from = map_.bounds();
      const Vec3 corner(i & 1 ? from.max.x() : from.min.x(), i & 2 ? from.max.y() : from.min.y(),
                        i & 4 ? from.max.z() : from.min.z());
      bounds_.add(part.X_MP * corner);
    }
    layOut(band_m);
  }

  [[nodiscard]] const Box& bounds() const { return bounds_; }

  void write(std::size_t cell, NodeValue* nodes) const override {
    // All bricks have the same blocks; the pose moves them to this brick.
    const GridPose motion(field_, {X_PM_.R, X_PM_ * centerOf(cellAt(cell))});
    const ShellBlock* batch[kBatch];
    ReadBatch read;
    for (int first = 0; first < kBlocksOfBrick; first += kBatch) {
      const int count = std::min(kBatch, kBlocksOfBrick - first);
      for (int i = 0; i < count; ++i) batch[i] = &blocks_[static_cast<std::size_t>(first + i)];
      kernels_.read(field_, motion, batch, count, read);
      toNodes(read.value, kLanes * count, nodes + kLanes * first);
    }
  }
  [[nodiscard]] std::uint16_t ownerOf(std::size_t cell, int node) const override {
    if (map_.partCount() <= 1) return 0;
    return map_.owner(X_PM_ * (voxel_m_ * (kBrick * cellAt(cell) + nodeAt(node)).cast<double>()));
  }
  [[nodiscard]] bool hasMixedOwners(std::size_t) const override { return map_.partCount() > 1; }

 private:
  [[nodiscard]] Vec3 centerOf(const Index3& cell) const {
    return voxel_m_ * (kBrick * cell + Index3::Constant(kBrick / 2)).cast<double>();
  }

  /// Converts the map's quanta to the grid's, rounded to nearest. The map's band is at least as wide as the
  /// grid's, so that saturated values stay saturated.
  void toNodes(const float* __restrict value, int count, NodeValue* __restrict nodes) const {
    // Compares the bits, since floats of one sign have the same order as their bits, and compilers do not
    // vectorise comparisons of floats by default.
    constexpr auto kBand = std::bit_cast<std::int32_t>(float{kFullBand});
    for (int i = 0; i < count; ++i) {
      const auto bits = std::bit_cast<std::int32_t>(value[i] * quanta_);
      const std::int32_t size = bits & INT32_MAX, sign = bits & INT32_MIN;
      nodes[i] = nodeOf(std::bit_cast<float>((size < kBand ? size : kBand) | sign));
    }
  }

  void layOut(double band_m) {
    requireNear(bounds_, voxel_m_);
    const double cell_m = kBrick * voxel_m_;
    const Vec3 from = ((bounds_.min.array() - band_m) / cell_m).floor() - 1;
    const Vec3 to = ((bounds_.max.array() + band_m) / cell_m).floor() + 2;
    requireDirectory(to - from);
    low = from.cast<int>();
    size = (to - from).cast<int>();
    parts = {{bounds_, low, low + size}};
    for (std::size_t i = 1; i < map_.partCount(); ++i) parts.push_back(parts.front());
    kinds.assign(cellCount(), kOutside);
    centers_m.assign(cellCount(), 0);
    // The radius of a cell, and the distance beyond which all eight nodes of a reading are saturated.
    const double reach_m =
        band_m + std::sqrt(3.0) * (4 * voxel_m_ + map_.voxel_m()) + sampler_.nodeError_m() + 1e-6 * band_m;
    tbb::parallel_for(0, size.x(), [&](int x) {
      for (int y = 0; y < size.y(); ++y)
        for (int z = 0; z < size.z(); ++z) layOutCell(low + Index3(x, y, z), reach_m);
    });
  }

  void layOutCell(const Index3& at, double reach_m) {
    const std::size_t cell = cellIndex(at);
    const Vec3 p = X_PM_ * centerOf(at);
    const VoxSampler::Place place = sampler_.place(p);
    VoxSampler::Range d = {sampler_.leastDistance(p, place), sampler_.mostDistance(place)};
    const auto isFar = [&] { return field_.is_metric && (d.least_m > reach_m || d.most_m < -reach_m); };
    const bool is_rim = ((at - low).array() == 0).any() || ((at - low).array() == size.array() - 1).any();
    if (!is_rim && !isFar()) {
      const VoxSampler::Range around = sampler_.rangeAround(p);
      d = {std::max(d.least_m, around.least_m), std::min(d.most_m, around.most_m)};
    }
    const bool is_inside = sampler_.isInside(place);
    const double bound_m = is_inside ? std::min(0.0, d.most_m) : std::max(0.0, d.least_m);
    centers_m[cell] = static_cast<float>(bound_m * (1 - 2e-7));
    if (is_rim) return;
    const std::uint32_t constant = isFar() ? (is_inside ? kInside : kOutside) : constantAround(p);
    kinds[cell] = constant == VoxSampler::kMixed ? kInside + kBrickStride : constant;
  }

  /// The constant that all nodes of the cell centred at p_P read as; VoxSampler::kMixed if they differ.
  [[nodiscard]] std::uint32_t constantAround(const Vec3& p_P) const {
    const Vec3 half = X_PM_.R.cwiseAbs() * Vec3::Constant((4 + 1e-3) * voxel_m_);
    return sampler_.constantIn({p_P - half, p_P + half});
  }

  const VoxMap& map_;
  const VoxSampler sampler_;
  const Pose X_PM_;
  const double voxel_m_;
  const FieldView field_;
  const ReadKernels& kernels_;
  const std::vector<ShellBlock> blocks_;
  const float quanta_;  ///< quanta of the grid per quantum of the map
  Box bounds_;
};

void requireBand(const VoxMap& map, double band_m) {
  if (map.band_m() < band_m * (1 - 1e-6))
    throw LoadError("", "",
                    "the voxmap to be mounted stores distances up to " + std::to_string(map.band_m() * 1e3) +
                        " mm, but " + std::to_string(band_m * 1e3) +
                        " mm are required; build it with a wider band");
}

}  // namespace

VoxMap resampledVoxMap(const PlacedMap& part, const VoxMapSettings& settings) {
  requireSettings(settings);
  return mountVoxMap(VoxMapAccess::empty(settings), part);
}

VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMap& part) {
  if (!(cooked.voxel_m() > 0))
    throw LoadError("", "",
                    "there is no voxmap to mount on: the given voxmap is empty and has no grid; cook one "
                    "first (cookVoxMap)");
  requirePose(part.X_MP);
  requireBand(*part.map, cooked.band_m());
  const ResampledField field(part, cooked.voxel_m(), cooked.band_m(), cooked.quantum_m());
  return mergedVoxMap(cooked, field, field.bounds());
}

}  // namespace vps

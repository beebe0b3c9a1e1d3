// SPDX-License-Identifier: BSD-3-Clause
#include "vps/voxmap.h"

#include <algorithm>

#include "voxmap/voxmap_access.h"
#include "voxmap/voxmap_sampler.h"

namespace vps {

VoxMap::VoxMap() {
  // An empty map has no cells, so every point is outside; all empty maps share this layout.
  static const std::shared_ptr<const VoxLayout> empty = [] {
    auto layout = std::make_shared<VoxLayout>();
    layout->pool = std::make_shared<VoxPool>(0);
    return layout;
  }();
  layout_ = empty;
}

double VoxMap::sampleError_m() const noexcept {
  return (0.8661 + layout_->node_error) * voxel_m_ + 0.51 * quantum_m_;
}

std::size_t VoxMap::partCount() const noexcept {
  return layout_->parts.size();
}

std::size_t VoxMap::brickCount() const noexcept {
  const auto& bricks = layout_->bricks;
  return static_cast<std::size_t>(
      std::count_if(bricks.begin(), bricks.end(), [](std::uint32_t brick) { return !isConstant(brick); }));
}

std::size_t VoxMap::memoryBytes() const noexcept {
  std::size_t bytes = sizeof(VoxLayout) + layout_->bricks.size() * VoxLayout::kCellBytes +
                      layout_->pool->size() * VoxPool::kBytes;
  for (const auto& owners : layout_->owners) bytes += owners->size() * sizeof(NodeOwners);
  return bytes;
}

std::size_t VoxMap::additionalMemoryBytes(const VoxMap& other) const noexcept {
  if (isSame(other)) return 0;
  const bool is_mounted_on_one = layout_->pool == other.layout_->pool;
  return memoryBytes() - (is_mounted_on_one ? layout_->pool->size() * VoxPool::kBytes : 0);
}

double VoxMap::distance(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.distance(sampler.place(p_M));
}

Vec3 VoxMap::normal(const Vec3& p_M, Gradient gradient) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.normal(sampler.place(p_M), gradient);
}

VoxMap::Sample VoxMap::sample(const Vec3& p_M, Gradient gradient) const noexcept {
  const VoxSampler sampler(*this);
  const VoxSampler::Place at = sampler.place(p_M);
  return {sampler.distance(at), sampler.normal(at, gradient)};
}

double VoxMap::lowerBound(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  const VoxSampler::Place at = sampler.place(p_M);
  return std::max({0.0, sampler.leastDistance(p_M, at), -sampler.mostDistance(at)});
}

double VoxMap::leastDistance(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.leastDistance(p_M, sampler.place(p_M));
}

bool VoxMap::isInsideCoarse(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.isInside(sampler.place(p_M));
}

std::uint16_t VoxMap::owner(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.owner(sampler.place(p_M));
}

VoxMap VoxMapAccess::make(std::shared_ptr<const VoxLayout> layout, double voxel_m, double band_m,
                          const Box& bounds) {
  VoxMap map;
  map.voxel_m_ = voxel_m;
  map.band_m_ = bandHeld(band_m);
  map.quantum_m_ = quantumOf(band_m);
  map.bounds_ = bounds;
  map.layout_ = std::move(layout);
  return map;
}

VoxMap VoxMapAccess::empty(const VoxMapSettings& settings) {
  return make(layout(VoxMap()), settings.voxel_m, settings.band_voxels * settings.voxel_m, Box());
}

namespace {

/// True for cells of 8 voxels in a box or next to it; gradients at a box's border read nodes beyond it.
bool isNear(const std::vector<Box>& boxes_M, const Index3& cell, double cell_m) {
  Box room;
  room.add(cell_m * (cell - Index3::Ones()).cast<double>());
  room.add(cell_m * (cell + Index3::Constant(2)).cast<double>());
  return std::any_of(boxes_M.begin(), boxes_M.end(), [&](const Box& box) { return overlap(box, room); });
}

}  // namespace

VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M) {
  auto layout = std::make_shared<VoxLayout>(*VoxMapAccess::layout(map));
  for (std::size_t i = 0; i < layout->bricks.size(); ++i) {
    std::uint32_t& brick = layout->bricks[i];
    if (isConstant(brick) || isNear(boxes_M, layout->cellAt(i), VoxMap::kBrick * map.voxel_m())) continue;
    brick = layout->centers_m[i] < 0 ? kInside : kOutside;
  }
  moveToNewPool(*layout, 0);
  markFarCells(*layout);
  return VoxMapAccess::make(layout, map.voxel_m(), map.band_m(), map.bounds());
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
#include "vps/voxmap.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <new>

#include "voxmap/voxmap_layout.h"
#include "voxmap/voxmap_sampler.h"

namespace vps {

VoxPool::VoxPool(std::size_t capacity)
    : capacity_(std::min<std::size_t>(2 * capacity, kMost) + 2),
      nodes_(static_cast<NodeValue*>(
          ::operator new (capacity_* kBrickStride * sizeof(NodeValue), std::align_val_t{kPage}))),
      owner_(new std::uint16_t[capacity_]),
      mixed_(new const NodeOwners*[capacity_]) {
#ifdef __linux__
  // Reads go all over the nodes: of small pages, more than the processor remembers (5 to 10 % of a read of
  // 20 MB). A wish; where it is not granted, nothing else changes.
  const std::size_t bytes = capacity_ * kBrickStride * sizeof(NodeValue);
  if (bytes >= kPage) (void)madvise(nodes_.get(), bytes / kPage * kPage, MADV_HUGEPAGE);
#endif
  used_ = 2;
  std::fill_n(nodes(kOutside), kBrickStride, static_cast<NodeValue>(kFullBand));
  std::fill_n(nodes(kInside), kBrickStride, static_cast<NodeValue>(-kFullBand));
  owner(kOutside) = owner(kInside) = 0;
  mixed(kOutside) = mixed(kInside) = nullptr;
}

std::uint32_t VoxPool::take(std::size_t count) noexcept {
  if (count == 0) return 0;
  const std::lock_guard lock(mutex_);
  std::size_t first = used_;
  const auto run = std::find_if(free_.begin(), free_.end(), [&](const auto& r) { return r.second >= count; });
  if (run != free_.end()) {
    // From its end: what is left keeps its place in the list, and nothing is allocated.
    first = run->first + (run->second -= count);
    if (run->second == 0) free_.erase(run);
  } else {
    if (first + count > capacity_) return 0;
    used_ = first + count;
  }
  std::fill_n(&owner_[first], count, std::uint16_t{0});
  std::fill_n(&mixed_[first], count, nullptr);
  return static_cast<std::uint32_t>(first * kBrickStride);
}

void VoxPool::giveBack(std::uint32_t first, std::size_t count) noexcept {
  const std::lock_guard lock(mutex_);
  std::size_t begin = first / kBrickStride, end = begin + count;
  const auto after = free_.find(end);
  if (after != free_.end()) {
    end += after->second;
    free_.erase(after);
  }
  auto before = free_.lower_bound(begin);
  if (before != free_.begin() && (--before)->first + before->second == begin) {
    begin = before->first;
    free_.erase(before);
  }
  if (end == used_) {
    used_ = begin;
    return;
  }
  try {
    free_[begin] = end - begin;
  } catch (const std::bad_alloc&) {  // lost until the pool goes
  }
}

VoxMap::VoxMap() {
  // An empty map: no cells, so everywhere outside; shared by all.
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

std::size_t VoxMap::memoryBytesBeside(const VoxMap& other) const noexcept {
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

}  // namespace vps

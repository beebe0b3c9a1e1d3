// SPDX-License-Identifier: BSD-3-Clause
#include "query/cluster_choice.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>

namespace vps {
namespace {

float areaOfLeaf(const ShellBlock& leaf) {
  double area_m2 = 0;
  for (std::uint32_t i = 0; i < leaf.count; ++i) area_m2 += static_cast<double>(leaf.weight[i]);
  return static_cast<float>(area_m2);
}

ShellBlock sphereAround(const ShellBlock& block) {
  ShellBlock around;
  std::copy_n(block.center, 3, around.center);
  around.radius_m = block.radius_m;
  around.count = 1;
  std::fill_n(around.weight, kLanes, static_cast<float>(block.radius_m * (1 + 1e-6)));
  return around;
}

}  // namespace

ClusterChoice::ClusterChoice(const PointShell& shell, const ClusterSamples& samples)
    : shell_(&shell), samples_(&samples), clusters_(shell.blocks.size()), sorted_(shell.blocks.size()) {
  const auto& blocks = shell.blocks;
  if (blocks.empty()) return;
  top_ = sphereAround(blocks.back());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b].is_leaf) {
      clusters_[b].area_m2 = areaOfLeaf(blocks[b]);
      continue;
    }
    double area_m2 = 0;
    for (std::uint32_t i = 0; i < blocks[b].count; ++i)
      area_m2 += static_cast<double>(clusters_[blocks[b].first + i].area_m2);
    clusters_[b].area_m2 = static_cast<float>(area_m2);
  }
  std::size_t end = shell.leaf_blocks;
  level_ends_.push_back(static_cast<std::uint32_t>(end));
  for (std::size_t count = shell.leaf_blocks; count > 1;) {
    count = (count + kLanes - 1) / kLanes;
    level_ends_.push_back(static_cast<std::uint32_t>(end += count));
  }
}

int ClusterChoice::level(std::uint32_t block) const noexcept {
  return static_cast<int>(std::upper_bound(level_ends_.begin(), level_ends_.end(), block) -
                          level_ends_.begin());
}

std::size_t ClusterChoice::memoryBytes() const noexcept {
  return clusters_.capacity() * sizeof(Cluster) + sorted_.capacity() * sizeof(std::uint64_t);
}

std::size_t ClusterChoice::costOf(std::uint32_t block) const noexcept {
  const ShellBlock& b = shell_->blocks[block];
  return b.is_leaf ? b.count : 2 * std::size_t{b.count};
}

void ClusterChoice::choose(const Reading& reading, std::size_t max_points,
                           const Deadline& deadline) noexcept {
  reading_ = &reading;
  deadline_ = &deadline;
  cut_ = 0;
  cost_ = spheres_read_ = 0;
  is_out_of_time_ = false;
  if (clusters_.empty()) return;
  // Before anything is read: as deep as a field reads.
  clusters_[root()].depth = reading.field.band;
  clusters_[root()].rank = 0;
  if (max_points == 0) return;
  buckets_.fill(Bucket());
  ClusterBounds bounds;
  boundClusters(reading, top_, bounds);
  cost_ = spheres_read_ = 1;
  remaining_ = max_points - 1;
  const float most = clusters_[root()].area_m2 * std::max(bounds.depth[0], 0.0f);
  least_rank_ = std::max(most * 0x1p-60f, std::numeric_limits<float>::denorm_min());
  top_bits_ = std::bit_cast<std::uint32_t>(std::max(most, least_rank_)) >> kBucketShift;
  add(root(), bounds.depth[0], most);
  for (Bucket& bucket : buckets_) {
    takeBucket(bucket);
    if (cut_ > 0) return;
  }
}

void ClusterChoice::add(std::uint32_t block, float depth, float rank) noexcept {
  Cluster& cluster = clusters_[block];
  cluster.depth = depth;
  cluster.rank = depth > 0 ? std::max(rank, least_rank_) : 0;
  if (!(depth > 0)) return;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(cluster.rank) >> kBucketShift;
  Bucket& bucket = buckets_[std::min<std::uint32_t>(top_bits_ - std::min(bits, top_bits_), kBuckets - 1)];
  cluster.next = bucket.first;
  bucket.first = block;
  bucket.cost += costOf(block);
}

void ClusterChoice::take(std::uint32_t block) noexcept {
  const std::size_t cost = costOf(block);
  remaining_ -= cost;
  cost_ += cost;
  if (!shell_->blocks[block].is_leaf) open(block);
}

/// Ranks a cluster's children. Linearly, a child's part of the change of the field across them all is what
/// its sample may be off, times its area; less where all of them stay clear of contact by more than that.
void ClusterChoice::open(std::uint32_t block) noexcept {
  const ShellBlock& spheres = samples_->spheres[block - shell_->leaf_blocks];
  ClusterBounds bounds;
  boundClusters(*reading_, spheres, bounds);
  spheres_read_ += spheres.count;
  const auto [low, high] = std::minmax_element(bounds.value, bounds.value + spheres.count);
  const float change_per_radius =
      (*high - *low) / (static_cast<float>(spheres.radius_m) * reading_->field.voxels_per_m);
  const Cluster& parent = clusters_[block];
  const std::uint32_t first = shell_->blocks[block].first;
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    const float off = std::min((change_per_radius + kRoughness) * bounds.radius[i], *high - *low + 1);
    const float likely = off * off / (off + std::max(*low, 0.0f));
    const float depth = std::min(bounds.depth[i], parent.depth);
    const float rank = clusters_[first + i].area_m2 * std::min(likely, depth);
    add(first + i, depth, std::min(rank, 0.5f * parent.rank));
  }
}

bool ClusterChoice::isTooLateFor(std::uint32_t block) noexcept {
  // Leaves cost next to nothing here.
  if (!shell_->blocks[block].is_leaf && deadline_->isOver()) is_out_of_time_ = true;
  return is_out_of_time_;
}

/// Children fall into later buckets, except at the least rank.
void ClusterChoice::takeBucket(Bucket& bucket) noexcept {
  while (bucket.first != kNone) {
    if (bucket.cost > remaining_) return takeSome(bucket);
    const std::uint32_t block = bucket.first;
    if (isTooLateFor(block)) {
      for (std::uint32_t b = block; b != kNone; b = clusters_[b].next)
        cut_ = std::max(cut_, clusters_[b].rank);
      return;
    }
    bucket.first = clusters_[block].next;
    bucket.cost -= costOf(block);
    take(block);
  }
}

/// The bucket in which the budget ends: in order of rank, up to the first that does not fit.
void ClusterChoice::takeSome(const Bucket& bucket) noexcept {
  std::size_t count = 0;
  for (std::uint32_t b = bucket.first; b != kNone; b = clusters_[b].next)
    sorted_[count++] = std::uint64_t{std::bit_cast<std::uint32_t>(clusters_[b].rank)} << 32 | b;
  std::sort(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(count), std::greater<>());
  for (std::size_t i = 0; i < count; ++i) {
    const auto block = static_cast<std::uint32_t>(sorted_[i]);
    if (costOf(block) > remaining_ || isTooLateFor(block)) {
      cut_ = clusters_[block].rank;
      return;
    }
    take(block);
  }
}

}  // namespace vps

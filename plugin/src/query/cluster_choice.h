// SPDX-License-Identifier: BSD-3-Clause
// Which clusters of a shell a budget is spent on.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "query/cluster_depth.h"
#include "query/cluster_samples.h"

namespace vps {

/// A moment after which to stop; asking costs some 30 ns, and nothing if there is none.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;
  Deadline() noexcept = default;
  Deadline(Clock::time_point start, double us) noexcept
      : is_set_(true), end_(start + std::chrono::nanoseconds(static_cast<std::int64_t>(us * 1e3))) {}
  [[nodiscard]] bool isOver() const noexcept { return is_set_ && Clock::now() >= end_; }

 private:
  bool is_set_ = false;
  Clock::time_point end_;
};

/// Ranks the clusters of a shell (its blocks) and takes them in that order until a budget is spent. Taking a
/// leaf costs its points; taking an inner block a reading at the sample of each child, which tells how deep
/// that can be, and another where the samples answer for children. A child's rank is at most half its
/// parent's, so that parents go first.
///
/// A cluster's rank is its area times what its sample is likely to be off, and never more than its area times
/// its depth bound, so that it is 0 before the cluster is out of reach. Siblings rank alike but for their
/// size, whatever each one's own sample says. Rejected, since it made the force of a thread worse with a
/// greater budget, by 20 %: to rank those first whose samples touch. It takes back what samples that touch
/// say too much, and leaves what the others say too little.
///
/// Clusters are kept in buckets of a sixteenth of an octave of rank each; a bucket that fits is taken in any
/// order, and only the one in which the budget ends is sorted. O(clusters taken).
class ClusterChoice {
 public:
  ClusterChoice(const PointShell& shell, const ClusterSamples& samples);

  /// Takes clusters of what may touch at the reading's pose. Ends early at the deadline.
  void choose(const Reading& reading, std::size_t max_points, const Deadline& deadline) noexcept;

  /// How much of a cluster's own answer counts, 0 to 1: 0 from the rank of the first that did not fit down, 1
  /// from twice that up. Of children of clusters with a weight above 0, and of the root.
  [[nodiscard]] float weight(std::uint32_t block) const noexcept {
    const float rank = clusters_[block].rank;
    if (!(rank > cut_)) return 0;
    return cut_ > 0 ? std::min(1.0f, (rank / cut_ - 1) / kBlend) : 1;
  }
  /// Bound of its points' depths [voxels]; not above 0: it does not touch. Known as weight() is.
  [[nodiscard]] float depth(std::uint32_t block) const noexcept { return clusters_[block].depth; }
  [[nodiscard]] float area_m2(std::uint32_t block) const noexcept { return clusters_[block].area_m2; }
  /// 0 for leaves.
  [[nodiscard]] int level(std::uint32_t block) const noexcept;

  [[nodiscard]] std::size_t spheresRead() const noexcept { return spheres_read_; }
  /// What the clusters taken cost.
  [[nodiscard]] std::size_t cost() const noexcept { return cost_; }
  [[nodiscard]] bool wasCutByTime() const noexcept { return is_out_of_time_; }
  /// Beside its own size.
  [[nodiscard]] std::size_t memoryBytes() const noexcept;

 private:
  /// Of rank, above that of the first left out, over which a cluster's weight grows to 1; at most 1, so that
  /// the parents of whatever counts count in full. Assumed.
  static constexpr float kBlend = 1;
  /// How much a surface may be off what its samples say, of their distance. Assumed.
  static constexpr float kRoughness = 1e-3f;
  static constexpr std::uint32_t kNone = UINT32_MAX;
  static constexpr int kBuckets = 1024;    // of 1/16 octave each: 64 octaves below the root's rank
  static constexpr int kBucketShift = 19;  // of a float's bits: the exponent and four more

  struct Cluster {
    float area_m2 = 0;
    float depth = 0;
    float rank = 0;
    std::uint32_t next = kNone;  ///< in its bucket
  };
  struct Bucket {
    std::uint32_t first = kNone;
    std::size_t cost = 0;
  };

  [[nodiscard]] std::uint32_t root() const noexcept {
    return static_cast<std::uint32_t>(clusters_.size() - 1);
  }
  [[nodiscard]] std::size_t costOf(std::uint32_t block) const noexcept;
  void add(std::uint32_t block, float depth, float rank) noexcept;
  void open(std::uint32_t block) noexcept;
  void take(std::uint32_t block) noexcept;
  void takeBucket(Bucket& bucket) noexcept;
  void takeSome(const Bucket& bucket) noexcept;
  [[nodiscard]] bool isTooLateFor(std::uint32_t block) noexcept;

  const PointShell* shell_;
  const ClusterSamples* samples_;
  ShellBlock top_;  ///< its one lane is the root's sphere
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> level_ends_;  ///< the block after each level's last
  std::vector<std::uint64_t> sorted_;      ///< room for one bucket
  std::array<Bucket, kBuckets> buckets_;
  const Reading* reading_ = nullptr;
  const Deadline* deadline_ = nullptr;
  std::uint32_t top_bits_ = 0;
  float least_rank_ = 0;  ///< of what may touch at all; below it the order is of no interest
  float cut_ = 0;
  std::size_t remaining_ = 0, cost_ = 0, spheres_read_ = 0;
  bool is_out_of_time_ = false;
};

}  // namespace vps

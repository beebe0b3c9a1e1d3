// SPDX-License-Identifier: BSD-3-Clause
// What every tick of a real-time loop took, kept without allocating and read by any thread at any time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

/// Counts times in buckets, 64 to the octave: a percentile is known to 1/64 of itself, from 1 ns to 18
/// minutes (longer counts as that). One writer, any number of readers; neither waits. 18 kB.
class VPS_DEVICE_API TickHistogram {
 public:
  static constexpr int kSplit = 64;    ///< buckets an octave
  static constexpr int kOctaves = 34;  ///< above the first 64 ns, which are exact

  /// Negative counts as 0. O(1).
  void add(std::int64_t ns) noexcept;

  struct Summary {
    std::uint64_t count = 0;
    std::int64_t p50_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;
  };
  /// Of what has been counted by now: nearest rank, rounded up to the bucket's end (at most 1/64 too much,
  /// never too little), the greatest exact. O(buckets). While ticks are being added it may lack the last.
  [[nodiscard]] Summary summary() const noexcept;
  /// The least value that so large a share of all is not above, as in summary().
  [[nodiscard]] std::int64_t percentile(double share) const noexcept;

 private:
  static constexpr std::size_t kBuckets = static_cast<std::size_t>(kSplit) * (kOctaves + 1);
  std::array<std::atomic<std::uint32_t>, kBuckets> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

/// Where a tick's time went, or what made it late.
enum class TickCause : std::uint8_t {
  WokenLate,  ///< the system let the thread run late
  Device,     ///< reading or writing the device
  OwnWork,    ///< coupling, safety, local contact
  Beside,     ///< what else the thread was given to do, after the wrench was written
};
inline constexpr int kTickCauses = 4;
VPS_DEVICE_API const char* toText(TickCause cause) noexcept;

/// One tick's times [ns].
struct VPS_DEVICE_API TickTiming {
  std::uint64_t tick = 0;        ///< its number
  std::int64_t late_ns = 0;      ///< from its due time to its start
  std::int64_t device_ns = 0;    ///< in the device's read and write
  std::int64_t own_ns = 0;       ///< the rest, until the wrench was written
  std::int64_t beside_ns = 0;    ///< after that
  std::int64_t snapshot_ns = 0;  ///< how long the physics snapshot has been the same

  /// From due to the wrench written: what the hand notices.
  [[nodiscard]] std::int64_t response_ns() const noexcept { return late_ns + device_ns + own_ns; }
  /// The greatest of its parts; of what the hand notices, unless `has_beside`.
  [[nodiscard]] TickCause cause(bool has_beside = false) const noexcept;
};

/// All ticks of a loop. Written by its thread, read by any.
class VPS_DEVICE_API TickStatistics {
 public:
  /// @param stale_ns  a snapshot that has been the same for longer counts as old; 0: never
  explicit TickStatistics(std::int64_t stale_ns = 0) noexcept : stale_ns_(stale_ns) {}

  void add(const TickTiming& timing) noexcept;
  /// `periods` passed without a tick of their own, because of `cause`.
  void miss(std::uint64_t periods, TickCause cause) noexcept;

  struct Summary {
    TickHistogram::Summary tick;      ///< device and own work
    TickHistogram::Summary late;      ///< woken late
    TickHistogram::Summary response;  ///< due until written
    std::uint64_t missed = 0;         ///< periods without a tick of their own
    std::array<std::uint64_t, kTickCauses> missed_by{};
    std::uint64_t stale = 0;  ///< ticks that answered from an old snapshot
    TickTiming worst;         ///< the longest response
  };
  [[nodiscard]] Summary summary() const noexcept;

 private:
  void keepWorst(const TickTiming& timing) noexcept;
  [[nodiscard]] TickTiming worst() const noexcept;

  std::int64_t stale_ns_;
  TickHistogram tick_, late_, response_;
  std::array<std::atomic<std::uint64_t>, kTickCauses> missed_by_{};
  std::atomic<std::uint64_t> stale_{0};
  // A sequence lock: odd while being written. Every field is atomic, so that a torn read is noticed, not
  // undefined.
  std::int64_t worst_response_ns_ = -1;
  std::atomic<std::uint64_t> worst_version_{0};
  std::array<std::atomic<std::int64_t>, 6> worst_{};
};

}  // namespace vps::device

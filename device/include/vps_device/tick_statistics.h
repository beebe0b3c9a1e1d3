// SPDX-License-Identifier: BSD-3-Clause
// Statistics of the ticks of a real-time loop, kept without allocating and readable by any thread at any
// time.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "vps_device/export.h"

namespace vps::device {

/// Histogram of times with 64 buckets per octave: percentiles have a relative error of 1/64, from 1 ns to 18
/// minutes (longer times count as 18 minutes). One writer, any number of readers; none of them waits. 18 kB.
class VPS_DEVICE_API TickHistogram {
 public:
  static constexpr int kSplit = 64;    ///< buckets per octave
  static constexpr int kOctaves = 34;  ///< octaves above the first 64 ns, which are exact

  /// Adds a time; a negative time counts as 0. O(1).
  void add(std::int64_t ns) noexcept;

  struct Summary {
    std::uint64_t count = 0;
    std::int64_t p50_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;
  };
  /// Percentiles by nearest rank, rounded up to the bucket's end (at most 1/64 too large, never too small);
  /// the maximum is exact. O(buckets). While ticks are being added, the last ones may be missing.
  [[nodiscard]] Summary summary() const noexcept;
  /// The least value that this share of all times does not exceed, as in summary().
  [[nodiscard]] std::int64_t percentile(double share) const noexcept;

 private:
  static constexpr std::size_t kBuckets = static_cast<std::size_t>(kSplit) * (kOctaves + 1);
  std::array<std::atomic<std::uint32_t>, kBuckets> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

/// Cause of the duration or the delay of a tick.
enum class TickCause : std::uint8_t {
  WokenLate,  ///< the system woke the thread late
  Device,     ///< reading or writing the device
  OwnWork,    ///< coupling, safety, local contact
  AfterTick,  ///< RealTimeSettings::after_tick, once the wrench is written
};
inline constexpr int kTickCauses = 4;
VPS_DEVICE_API const char* toText(TickCause cause) noexcept;

/// One tick's times [ns].
struct VPS_DEVICE_API TickTiming {
  std::uint64_t tick = 0;          ///< number of the tick
  std::int64_t late_ns = 0;        ///< time from the tick's due time to its start
  std::int64_t device_ns = 0;      ///< time in the device's read and write
  std::int64_t own_ns = 0;         ///< other time until the wrench was written
  std::int64_t after_tick_ns = 0;  ///< time from the write to the end of RealTimeSettings::after_tick
  std::int64_t snapshot_ns = 0;    ///< time for which the physics state has stayed the same

  /// Time from the due time until the wrench is written: the delay that the hand feels.
  [[nodiscard]] std::int64_t response_ns() const noexcept { return late_ns + device_ns + own_ns; }
  /// The part of the tick that took longest; after_tick_ns counts only if `includes_after_tick`.
  [[nodiscard]] TickCause cause(bool includes_after_tick = false) const noexcept;
};

/// Statistics of all ticks of a loop. The loop's thread writes them, any thread reads them.
class VPS_DEVICE_API TickStatistics {
 public:
  /// @param stale_ns  a physics state that stays the same for longer counts as old; 0: never
  explicit TickStatistics(std::int64_t stale_ns = 0) noexcept : stale_ns_(stale_ns) {}

  void add(const TickTiming& timing) noexcept;
  /// Counts `periods` that passed without a tick, because of `cause`.
  void miss(std::uint64_t periods, TickCause cause) noexcept;

  struct Summary {
    TickHistogram::Summary tick;      ///< duration of a tick: device and own work
    TickHistogram::Summary late;      ///< delay of a tick's start
    TickHistogram::Summary response;  ///< time from the due time until the wrench is written
    std::uint64_t missed = 0;         ///< periods without a tick
    std::array<std::uint64_t, kTickCauses> missed_by{};
    std::uint64_t stale = 0;  ///< ticks that used an old physics state
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
  // worst_version_ is a sequence lock: odd while worst_ is being written. Every field is atomic, so that a
  // torn read is detected rather than undefined.
  std::int64_t worst_response_ns_ = -1;
  std::atomic<std::uint64_t> worst_version_{0};
  std::array<std::atomic<std::int64_t>, 6> worst_{};
};

}  // namespace vps::device

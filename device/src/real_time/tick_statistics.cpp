// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/tick_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vps::device {
namespace {

constexpr int kSplitBits = 6;
static_assert(TickHistogram::kSplit == 1 << kSplitBits);
constexpr std::int64_t kMax_ns = (std::int64_t{1} << (kSplitBits + TickHistogram::kOctaves)) - 1;

// One bucket per nanosecond below 64 ns; above 64 ns, the octave and the six bits after the highest bit give
// the bucket.
std::size_t bucketOf(std::int64_t ns) {
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(ns, 0, kMax_ns));
  const int octave = std::max(0, static_cast<int>(std::bit_width(value)) - kSplitBits);
  if (octave == 0) return value;
  const std::uint64_t part = (value >> (octave - 1)) - TickHistogram::kSplit;
  return static_cast<std::size_t>(octave) * TickHistogram::kSplit + part;
}

// The greatest value in a bucket.
std::int64_t endOf(std::size_t bucket) {
  const std::size_t octave = bucket / TickHistogram::kSplit, part = bucket % TickHistogram::kSplit;
  if (octave == 0) return static_cast<std::int64_t>(part);
  return static_cast<std::int64_t>(((TickHistogram::kSplit + part + 1) << (octave - 1)) - 1);
}

// Only one thread writes, so that no atomic read-modify-write is needed.
template <typename T>
void increase(std::atomic<T>& value, T by = 1) {
  value.store(value.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
}

}  // namespace

void TickHistogram::add(std::int64_t ns) noexcept {
  increase(counts_[bucketOf(ns)]);
  if (ns > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(ns, std::memory_order_relaxed);
}

TickHistogram::Summary TickHistogram::summary() const noexcept {
  Summary all;
  for (const auto& count : counts_) all.count += count.load(std::memory_order_relaxed);
  all.max_ns = max_ns_.load(std::memory_order_relaxed);
  all.p50_ns = percentile(0.5);
  all.p99_ns = percentile(0.99);
  all.p999_ns = percentile(0.999);
  return all;
}

std::int64_t TickHistogram::percentile(double share) const noexcept {
  std::uint64_t total = 0, below = 0;
  for (const auto& count : counts_) total += count.load(std::memory_order_relaxed);
  if (total == 0) return 0;
  const auto rank = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(total))));
  for (std::size_t i = 0; i < kBuckets; ++i) {
    below += counts_[i].load(std::memory_order_relaxed);
    if (below >= rank) return std::min(endOf(i), max_ns_.load(std::memory_order_relaxed));
  }
  return max_ns_.load(std::memory_order_relaxed);
}

const char* toText(TickCause cause) noexcept {
  switch (cause) {
    case TickCause::WokenLate:
      return "woken late";
    case TickCause::Device:
      return "the device";
    case TickCause::OwnWork:
      return "the tick's own work";
    case TickCause::AfterTick:
      return "work after the tick";
  }
  return "unknown";
}

TickCause TickTiming::cause(bool includes_after_tick) const noexcept {
  const std::array<std::int64_t, kTickCauses> parts = {late_ns, device_ns, own_ns,
                                                       includes_after_tick ? after_tick_ns : -1};
  return static_cast<TickCause>(std::max_element(parts.begin(), parts.end()) - parts.begin());
}

void TickStatistics::add(const TickTiming& timing) noexcept {
  tick_.add(timing.device_ns + timing.own_ns);
  late_.add(timing.late_ns);
  response_.add(timing.response_ns());
  if (stale_ns_ > 0 && timing.snapshot_ns > stale_ns_) increase(stale_);
  if (timing.response_ns() > worst_response_ns_) keepWorst(timing);
}

void TickStatistics::miss(std::uint64_t periods, TickCause cause) noexcept {
  increase(missed_by_[static_cast<std::size_t>(cause)], periods);
}

// A reader that sees a field of the new value also sees the odd version before that field (release, acquire),
// and retries.
void TickStatistics::keepWorst(const TickTiming& timing) noexcept {
  worst_response_ns_ = timing.response_ns();
  const std::uint64_t version = worst_version_.load(std::memory_order_relaxed);
  worst_version_.store(version + 1, std::memory_order_relaxed);
  const std::array<std::int64_t, 6> fields = {static_cast<std::int64_t>(timing.tick),
                                              timing.late_ns,
                                              timing.device_ns,
                                              timing.own_ns,
                                              timing.after_tick_ns,
                                              timing.snapshot_ns};
  for (std::size_t i = 0; i < fields.size(); ++i) worst_[i].store(fields[i], std::memory_order_release);
  worst_version_.store(version + 2, std::memory_order_release);
}

TickTiming TickStatistics::worst() const noexcept {
  for (;;) {
    const std::uint64_t before = worst_version_.load(std::memory_order_acquire);
    std::array<std::int64_t, 6> f{};
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = worst_[i].load(std::memory_order_acquire);
    if (before % 2 == 0 && worst_version_.load(std::memory_order_relaxed) == before)
      return {static_cast<std::uint64_t>(f[0]), f[1], f[2], f[3], f[4], f[5]};
  }
}

TickStatistics::Summary TickStatistics::summary() const noexcept {
  Summary all;
  all.tick = tick_.summary();
  all.late = late_.summary();
  all.response = response_.summary();
  for (std::size_t i = 0; i < all.missed_by.size(); ++i) {
    all.missed_by[i] = missed_by_[i].load(std::memory_order_relaxed);
    all.missed += all.missed_by[i];
  }
  all.stale = stale_.load(std::memory_order_relaxed);
  all.worst = worst();
  return all;
}

}  // namespace vps::device

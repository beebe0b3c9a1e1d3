// SPDX-License-Identifier: BSD-3-Clause
// Delays snapshots of a session, so that all watchers show a snapshot at the same instant: a fixed time after
// it was taken, by the common clock of the nodes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "vps_scenes/run/snapshot.h"

namespace vps::viewer {

/// Delay from physics to picture and sound, which covers the delays that differ between watchers: up to 17 ms
/// until a window or page polls again, and a network with a delay of 20 ms and a jitter of 5 ms.
inline constexpr std::int64_t kPresentAfter_ns = 50'000'000;

/// Keeps snapshots until they are due. Used by one thread.
class Presentation {
 public:
  /// @param after_ns  time from when a snapshot was taken until it is due
  explicit Presentation(std::int64_t after_ns = kPresentAfter_ns) : after_ns_(after_ns) {}

  /// Adds a snapshot.
  /// @param taken_ns  time of the snapshot by this machine's monotonic clock, at most now_ns
  void add(scenes::Snapshot shot, std::int64_t taken_ns, std::int64_t now_ns) {
    taken_ns = std::min(taken_ns, now_ns);
    if (!waiting_.empty()) taken_ns = std::max(taken_ns, waiting_.back().taken_ns);  // keeps the order
    late_ += taken_ns + after_ns_ < now_ns;
    if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
    waiting_.push_back({std::move(shot), taken_ns});
  }
  /// Calls each(snapshot, taken_ns) for the snapshots that are due, in the order of time, and removes them.
  template <typename Each>
  void take(std::int64_t now_ns, const Each& each) {
    for (; !waiting_.empty() && waiting_.front().taken_ns + after_ns_ <= now_ns; waiting_.pop_front())
      each(std::move(waiting_.front().shot), waiting_.front().taken_ns);
  }
  /// Number of snapshots that arrived after they were due.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  static constexpr std::size_t kMostWaiting = 64;  ///< one second of snapshots; usually a few wait
  struct Waiting {
    scenes::Snapshot shot;
    std::int64_t taken_ns;
  };

  std::int64_t after_ns_;
  std::deque<Waiting> waiting_;
  std::uint64_t late_ = 0;
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// When those who watch a session show a snapshot: all at the same instant, which is a fixed time after it was
// taken, by the one clock of the nodes.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// From physics to picture and sound. Covers the ways whose length differs from watcher to watcher: 17 ms
/// until a window or page looks again, and a network with a jitter of 5 ms and a delay of 20 ms.
inline constexpr std::int64_t kPresentAfter_ns = 50'000'000;

/// Keeps snapshots until they are due. Used by one thread.
class VPS_VIEWER_API Presentation {
 public:
  /// @param after_ns  from the time a snapshot was taken until it is due
  explicit Presentation(std::int64_t after_ns = kPresentAfter_ns) : after_ns_(after_ns) {}

  /// @param taken_ns  by the monotonic clock of this machine; of one that is ahead, as if it were now
  void add(scenes::Snapshot shot, std::int64_t taken_ns, std::int64_t now_ns);
  /// Calls `each` with those that are due now, in their order, and the times at which they were taken.
  template <typename Each>
  void take(std::int64_t now_ns, const Each& each) {
    for (; !waiting_.empty() && waiting_.front().taken_ns + after_ns_ <= now_ns; waiting_.pop_front())
      each(std::move(waiting_.front().shot), waiting_.front().taken_ns);
  }
  /// How many came when they were due already.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  struct Waiting {
    scenes::Snapshot shot;
    std::int64_t taken_ns;
  };

  std::int64_t after_ns_;
  std::deque<Waiting> waiting_;
  std::uint64_t late_ = 0;
};

}  // namespace vps::viewer

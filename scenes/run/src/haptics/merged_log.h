// SPDX-License-Identifier: BSD-3-Clause
// Puts what physics logs and what the haptic loop of another process logs in the order of a replay.
#pragma once

#include <cstdint>
#include <deque>
#include <variant>

#include "vps_device/run_log.h"

namespace vps::scenes {

/// Entries of the loop come later than the states and replies that physics works with, the later the longer
/// the way. So what physics logs waits here until the entries that precede it have come. Used by the physics
/// thread; it allocates.
class MergedLog final : public device::RunLog {
 public:
  /// @param log  outlives this object
  explicit MergedLog(device::RunLog& log) : log_(log) {}

  /// Once something was lost, nothing is added any more.
  void lose(std::uint64_t count) noexcept override;
  /// Of physics: follows what was asked for by waitForTick() and waitForEvent() before.
  void add(const device::LogEntry& entry) noexcept override;
  /// Of the loop, in their order. Numbers that are missing were lost.
  void addFromLoop(std::uint32_t number, const device::LogEntry& entry);

  /// What is added from now on follows the loop's entries of the ticks up to this one.
  void waitForTick(std::int32_t tick) { wait(Tick{tick}); }
  /// The same for the loop's next SyncEvent of a kind, which is no Tick.
  void waitForEvent(device::SyncEventKind kind) { wait(Event{kind}); }
  /// Entries of the loop are still to come.
  [[nodiscard]] bool isWaiting() const { return !waiting_.empty(); }

 private:
  struct Tick {
    std::int32_t tick;
  };
  struct Event {
    device::SyncEventKind kind;
  };
  using Waiting = std::variant<device::LogEntry, Tick, Event>;

  void wait(const Waiting& item) {
    if (is_over_) return;
    waiting_.push_back(item);
    pass();
  }
  void pass();
  /// False: entries of the loop that come first are missing.
  bool passUntil(const device::LogEntry& entry);
  bool passUntil(const Tick& until);
  bool passUntil(const Event& until);
  void passLoopEntry();

  device::RunLog& log_;
  std::deque<Waiting> waiting_;
  std::deque<device::LogEntry> loop_;
  std::uint32_t next_ = 0;                   ///< number of the loop's next entry
  std::int32_t ticking_ = 0, complete_ = 0;  ///< the last tick that was passed on, as a whole
  bool is_over_ = false;                     ///< something was lost, so a replay ends there
};

}  // namespace vps::scenes

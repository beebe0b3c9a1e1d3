// SPDX-License-Identifier: BSD-3-Clause
// Merges the log entries of physics and of a haptic loop in another process into the order of a replay.
#pragma once

#include <cstdint>
#include <deque>
#include <variant>

#include "vps_device/run_log.h"

namespace vps::scenes {

/// Entries of the loop arrive later than the states and replies that physics uses, by the delay of the
/// network. The entries of physics wait in a MergedLog until the loop's entries that precede them have
/// arrived. The physics thread uses this class, which allocates.
class MergedLog final : public device::RunLog {
 public:
  /// @param log  outlives this object
  explicit MergedLog(device::RunLog& log) : log_(log) {}

  /// Reports lost entries; later entries are discarded.
  void lose(std::uint64_t count) noexcept override;
  /// Adds an entry of physics, after the entries that waitForTick() and waitForEvent() asked for.
  void add(const device::LogEntry& entry) noexcept override;
  /// Adds an entry of the loop. Entries come in the order of their numbers; a missing number means a lost
  /// entry.
  void addFromLoop(std::uint32_t number, const device::LogEntry& entry);

  /// Later entries of physics follow the loop's entries of all ticks up to `tick`.
  void waitForTick(std::int32_t tick) { wait(Tick{tick}); }
  /// Later entries of physics follow the loop's next SyncEvent of this kind, which must not be Tick.
  void waitForEvent(device::SyncEventKind kind) { wait(Event{kind}); }
  /// Whether entries of the loop are still missing.
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
  /// Passes on a waiting item if no entry of the loop that must come before it is missing; else returns
  /// false.
  bool passUntil(const device::LogEntry& entry);
  bool passUntil(const Tick& until);
  bool passUntil(const Event& until);
  void passLoopEntry();

  device::RunLog& log_;
  std::deque<Waiting> waiting_;
  std::deque<device::LogEntry> loop_;
  std::uint32_t next_ = 0;  ///< number of the loop's next entry
  std::int32_t ticking_ = 0,
               complete_ =
                   0;  ///< the last tick that was passed on, and the last tick that was passed on completely
  bool is_over_ = false;  ///< entries were lost, so a replay ends at the gap
};

}  // namespace vps::scenes

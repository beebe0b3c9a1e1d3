// SPDX-License-Identifier: BSD-3-Clause
// Transfers log entries from the haptic thread to the physics thread, which owns the run's log.
#pragma once

#include <functional>

#include "vps_device/detail/entry_ring.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

/// The haptic thread adds entries without waiting or allocating. The physics thread passes the entries on to
/// the run's log in the order of their events, up to the tick that physics has reached. The run's log
/// therefore has one writer, and its entries have the order of a replay.
class HapticLog final : public device::RunLog {
 public:
  /// @param log  null: entries are discarded
  explicit HapticLog(device::RunLog* log) : log_(log), ring_(log != nullptr ? kEntries : 1) {}

  /// Called by the haptic thread.
  void add(const device::LogEntry& entry) noexcept override {
    if (log_ != nullptr)
      ring_.push(number_++, entry);  // an entry that finds no room leaves a gap in the numbers
  }

  /// Called by the physics thread: passes on all entries of the ticks up to `tick`.
  void passUpTo(std::int32_t tick) {
    pass(
        [tick](const device::SyncEvent* event) {
          return event != nullptr && event->kind == device::SyncEventKind::Tick && event->tick > tick;
        },
        [](const device::SyncEvent*) { return false; });
  }
  /// Called by the physics thread: passes on all entries up to and including the next SyncEvent of the given
  /// kind.
  void passUntil(device::SyncEventKind kind) {
    pass([](const device::SyncEvent*) { return false; },
         [kind](const device::SyncEvent* event) { return event != nullptr && event->kind == kind; });
  }
  /// Called by the physics thread: adds an event of the physics thread.
  void addFromPhysics(const device::SyncEvent& event) {
    if (log_ != nullptr) log_->add(event);
  }

 private:
  /// assumed: 11 s of a loop at 1 kHz, three entries a tick; longer than any physics step
  static constexpr std::size_t kEntries = 1 << 15;

  template <typename Before, typename After>
  void pass(const Before& stops_before, const After& stops_after) {
    if (log_ == nullptr) return;
    while (const device::EntryRing::Slot* slot = ring_.front()) {
      const auto* event = std::get_if<device::SyncEvent>(&slot->entry);
      if (stops_before(event)) return;
      if (slot->number != passed_) log_->lose(slot->number - passed_);
      passed_ = slot->number + 1;
      log_->add(slot->entry);
      const bool is_last = stops_after(event);
      ring_.pop();
      if (is_last) return;
    }
  }

  device::RunLog* log_;
  device::EntryRing ring_;
  std::uint32_t number_ = 0;  ///< number of the next entry; used by the haptic thread
  std::uint32_t passed_ = 0;  ///< number of the next entry to pass on; used by the physics thread
};

}  // namespace vps::scenes

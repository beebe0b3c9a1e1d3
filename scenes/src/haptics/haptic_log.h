// SPDX-License-Identifier: BSD-3-Clause
// What the haptic thread logs, on its way to the physics thread, which has the run's log.
#pragma once

#include <functional>

#include "vps_device/entry_ring.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

/// The haptic thread adds; it neither waits nor allocates. The physics thread passes on, in the order in
/// which things were done, what it has come to: so the run's log has one writer, and its order is a replay's.
class HapticLog final : public device::RunLog {
 public:
  /// @param log  null: nobody listens
  explicit HapticLog(device::RunLog* log) : log_(log), ring_(log != nullptr ? kEntries : 1) {}

  /// Haptic thread.
  void add(const device::LogEntry& entry) noexcept override;

  /// Physics thread: all of the ticks up to this one.
  void passUpTo(std::int32_t tick) {
    pass(
        [tick](const device::SyncEvent* met) {
          return met != nullptr && met->kind == device::SyncEventKind::Tick && met->tick > tick;
        },
        [](const device::SyncEvent*) { return false; });
  }
  /// Up to the next sync_event of a kind, with it.
  void passThrough(device::SyncEventKind kind) {
    pass([](const device::SyncEvent*) { return false; },
         [kind](const device::SyncEvent* met) { return met != nullptr && met->kind == kind; });
  }
  /// Physics thread's own.
  void tell(const device::SyncEvent& sync_event) {
    if (log_ != nullptr) log_->add(sync_event);
  }

 private:
  /// assumed: 11 s of a loop at 1 kHz, three entries a tick; longer than any physics step
  static constexpr std::size_t kEntries = 1 << 15;

  template <typename Before, typename After>
  void pass(const Before& stops_before, const After& stops_after) {
    if (log_ == nullptr) return;
    while (const device::EntryRing::Slot* slot = ring_.front()) {
      const auto* met = std::get_if<device::SyncEvent>(&slot->entry);
      if (stops_before(met)) return;
      if (slot->number != passed_) log_->lose(slot->number - passed_);
      passed_ = slot->number + 1;
      log_->add(slot->entry);
      const bool is_last = stops_after(met);
      ring_.pop();
      if (is_last) return;
    }
  }

  device::RunLog* log_;
  device::EntryRing ring_;
  std::uint32_t number_ = 0;  ///< haptic thread's
  std::uint32_t passed_ = 0;  ///< physics thread's
};

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Lock-free ring of numbered log entries, from a thread that must not wait to a thread that may wait.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/run_log.h"

namespace vps::device {

/// One writer, one reader; neither waits. A full ring refuses entries.
class VPS_DEVICE_API EntryRing {
 public:
  struct Slot {
    std::uint32_t number = 0;
    LogEntry entry;
  };

  explicit EntryRing(std::size_t entries) : slots_(std::bit_ceil(entries)) {}

  /// Writer. False if the ring is full; the entry is then not added.
  bool push(std::uint32_t number, const LogEntry& entry) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == slots_.size()) return false;
    Slot& slot = slots_[head & (slots_.size() - 1)];
    slot.number = number;
    slot.entry = entry;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Reader. The oldest entry, which stays until pop(); null if the ring is empty.
  [[nodiscard]] const Slot* front() const noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    return tail == head_.load(std::memory_order_acquire) ? nullptr : &slots_[tail & (slots_.size() - 1)];
  }
  void pop() noexcept { tail_.store(tail_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  /// Either thread.
  [[nodiscard]] bool isHalfFull() const noexcept {
    return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire) >= slots_.size() / 2;
  }

 private:
  std::vector<Slot> slots_;
  // head_ and tail_ are on separate cache lines, to avoid false sharing.
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace vps::device

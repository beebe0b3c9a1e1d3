// SPDX-License-Identifier: BSD-3-Clause
// Passes the latest value from one writing thread to one reading thread; neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace vps {

/// Three slots: the writer fills one, the reader owns one, the third holds the latest published value.
/// Wait-free, no allocation. Assigning a T must not throw.
template <typename T>
class TripleBuffer {
 public:
  explicit TripleBuffer(const T& initial = T{}) { slots_.fill(initial); }

  /// Writer: publishes a value.
  void write(const T& value) noexcept {
    slots_[write_] = value;
    // Release makes the slot's content visible with its index; the fresh bit says that it is new.
    write_ = middle_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_acq_rel) & kIndex;
  }

  /// Reader: the latest published value. The reference stays valid until the next read().
  const T& read() noexcept {
    if (middle_.load(std::memory_order_relaxed) & kFresh)
      read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return slots_[read_];
  }

 private:
  static constexpr std::uint8_t kFresh = 4, kIndex = 3;
  std::array<T, 3> slots_;
  std::uint8_t write_ = 0, read_ = 1;
  std::atomic<std::uint8_t> middle_{2};
};

}  // namespace vps

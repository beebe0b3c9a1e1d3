// SPDX-License-Identifier: BSD-3-Clause
// A ring of messages in memory that several processes share: one writer, any number of readers, no lock.
//
// The writer never waits: it overwrites the oldest message. A slot carries the number of its message, odd
// while it is being written, so that a reader notices a message that was overwritten while it was read. A
// writer that is killed in the middle leaves the messages before it whole, and the next writer continues.
// That is why states use this ring rather than a TripleBuffer: the latter keeps the ownership of its slots in
// the two processes, where a kill loses it, and has one reader only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace vps::scenes {

using SharedWord = std::atomic<std::uint64_t>;
static_assert(SharedWord::is_always_lock_free && sizeof(SharedWord) == 8, "processes share no lock");

/// Slots and the room in each. Both are constants of the program, never read from shared memory.
struct RingShape {
  std::uint32_t slots = 0;  ///< a power of two
  std::uint32_t bytes = 0;  ///< longest message, a multiple of 8

  [[nodiscard]] constexpr std::size_t slotWords() const { return 2 + bytes / 8; }
  [[nodiscard]] constexpr std::size_t words() const { return 8 + slots * slotWords(); }
};

/// Continues where an earlier writer of the same memory stopped. Memory of zeros is an empty ring.
class RingWriter {
 public:
  RingWriter() = default;
  RingWriter(SharedWord* memory, RingShape shape) noexcept;

  /// Never waits or allocates. A longer message than the ring's is not written; false then. O(bytes).
  bool write(std::string_view message) noexcept;

 private:
  SharedWord* memory_ = nullptr;
  RingShape shape_;
  std::uint64_t number_ = 0;  ///< of the next message
};

/// Each reader keeps its own place. Nothing that it finds in the memory is trusted.
class RingReader {
 public:
  RingReader() = default;
  RingReader(const SharedWord* memory, RingShape shape) noexcept : memory_(memory), shape_(shape) {}

  /// The oldest message not yet read; messages that were overwritten are counted in lost(). The result views
  /// `buffer`, which has room for shape.bytes; empty: nothing new. Never waits or allocates.
  [[nodiscard]] std::string_view next(std::span<char> buffer) noexcept;
  /// The newest message, if it was not read yet. The ones before it are skipped.
  [[nodiscard]] std::string_view latest(std::span<char> buffer) noexcept;
  /// Skips what was written so far.
  void skip() noexcept;

  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  [[nodiscard]] std::string_view read(std::uint64_t number, std::span<char> buffer) const noexcept;

  const SharedWord* memory_ = nullptr;
  RingShape shape_;
  std::uint64_t number_ = 0;  ///< of the next message to be read
  std::uint64_t lost_ = 0;
};

}  // namespace vps::scenes

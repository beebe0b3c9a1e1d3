// SPDX-License-Identifier: BSD-3-Clause
// A ring of messages in memory shared by several processes: one writer, any number of readers, no lock.
//
// The writer never waits: it overwrites the oldest message. A slot carries the number of its message, odd
// while it is being written, so that a reader detects a message that was overwritten during reading. If the
// writer is killed in the middle of a message, earlier messages stay intact, and the next writer continues. A
// TripleBuffer is not used for states, because it has only one reader and keeps the ownership of its slots in
// the two processes, where the ownership is lost if a process is killed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace vps::scenes {

using SharedWord = std::atomic<std::uint64_t>;
static_assert(SharedWord::is_always_lock_free && sizeof(SharedWord) == 8, "processes must not share a lock");

/// Number and size of the slots. Both numbers are constants of the program and are never read from shared
/// memory.
struct RingShape {
  std::uint32_t slots = 0;  ///< a power of two
  std::uint32_t bytes = 0;  ///< longest message, a multiple of 8

  [[nodiscard]] constexpr std::size_t slotWords() const { return 2 + bytes / 8; }
  [[nodiscard]] constexpr std::size_t words() const { return 8 + slots * slotWords(); }
};

/// Writes messages. Continues after the last message of an earlier writer of the same memory. Memory filled
/// with zeros is an empty ring.
class RingWriter {
 public:
  RingWriter() = default;
  RingWriter(SharedWord* memory, RingShape shape) noexcept;

  /// Returns false, without writing, if the message is longer than the ring's slots. Never waits or
  /// allocates. O(bytes).
  bool write(std::string_view message) noexcept;

 private:
  SharedWord* memory_ = nullptr;
  RingShape shape_;
  std::uint64_t number_ = 0;  ///< number of the next message
};

/// Reads messages. Each reader keeps its own position and validates everything that it reads from the memory.
class RingReader {
 public:
  RingReader() = default;
  RingReader(const SharedWord* memory, RingShape shape) noexcept : memory_(memory), shape_(shape) {}

  /// The oldest unread message; messages that were overwritten are counted in lost(). The result is a view of
  /// `buffer`, which has room for shape.bytes; empty: no new message. Never waits or allocates.
  [[nodiscard]] std::string_view next(std::span<char> buffer) noexcept;
  /// The newest message if it is unread; older messages are skipped.
  [[nodiscard]] std::string_view latest(std::span<char> buffer) noexcept;
  /// Skips all messages written so far.
  void skip() noexcept;

  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  [[nodiscard]] std::string_view read(std::uint64_t number, std::span<char> buffer) const noexcept;

  const SharedWord* memory_ = nullptr;
  RingShape shape_;
  std::uint64_t number_ = 0;  ///< number of the next message to read
  std::uint64_t lost_ = 0;
};

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "link/broadcast_ring.h"

#include <algorithm>
#include <cstring>

namespace vps::scenes {

namespace {

// memory[0] is the number of messages written so far; slots begin on the next cache line. A slot holds a
// stamp, the message's size, and its words. Message n has the stamp 2 n + 2, and 2 n + 1 while it is being
// written.
constexpr std::size_t kFirstSlot = 8;
constexpr int kTries =
    4;  // tries of latest(); a try fails only if the writer has lapped the whole ring in the meantime

template <typename Word>
Word* slotOf(Word* memory, const RingShape& shape, std::uint64_t number) {
  return memory + kFirstSlot + (number & (shape.slots - 1)) * shape.slotWords();
}

}  // namespace

RingWriter::RingWriter(SharedWord* memory, RingShape shape) noexcept
    : memory_(memory), shape_(shape), number_(memory[0].load(std::memory_order_acquire)) {}

// Words are stored with release order, so that the odd stamp is visible before any of them. A reader that
// loads one of these words with acquire order therefore sees the odd stamp in its final check. On x86 these
// loads and stores are ordinary moves.
bool RingWriter::write(std::string_view message) noexcept {
  if (message.size() > shape_.bytes) return false;
  SharedWord* slot = slotOf(memory_, shape_, number_);
  slot[0].store(2 * number_ + 1, std::memory_order_relaxed);
  slot[1].store(message.size(), std::memory_order_release);
  for (std::size_t at = 0, word = 2; at < message.size(); at += 8, ++word) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, message.data() + at, std::min<std::size_t>(8, message.size() - at));
    slot[word].store(bits, std::memory_order_release);
  }
  slot[0].store(2 * number_ + 2, std::memory_order_release);
  memory_[0].store(++number_, std::memory_order_release);
  return true;
}

std::string_view RingReader::read(std::uint64_t number, std::span<char> buffer) const noexcept {
  const SharedWord* slot = slotOf(memory_, shape_, number);
  const std::uint64_t stamp = 2 * number + 2;
  if (slot[0].load(std::memory_order_acquire) != stamp) return {};
  const std::uint64_t size = slot[1].load(std::memory_order_acquire);
  if (size > shape_.bytes || size > buffer.size()) return {};
  for (std::size_t at = 0, word = 2; at < size; at += 8, ++word) {
    const std::uint64_t bits = slot[word].load(std::memory_order_acquire);
    std::memcpy(buffer.data() + at, &bits, std::min<std::size_t>(8, size - at));
  }
  if (slot[0].load(std::memory_order_relaxed) != stamp) return {};
  return {buffer.data(), static_cast<std::size_t>(size)};
}

std::string_view RingReader::next(std::span<char> buffer) noexcept {
  if (memory_ == nullptr) return {};
  const std::uint64_t end = memory_[0].load(std::memory_order_acquire);
  if (end <= number_) return {};
  const std::uint64_t oldest = end > shape_.slots ? end - shape_.slots : 0;
  if (number_ < oldest) {
    lost_ += oldest - number_;
    number_ = oldest;
  }
  while (number_ < end) {
    const std::string_view message = read(number_++, buffer);
    if (!message.empty()) return message;
    ++lost_;
  }
  return {};
}

std::string_view RingReader::latest(std::span<char> buffer) noexcept {
  if (memory_ == nullptr) return {};
  for (int i = 0; i < kTries; ++i) {
    const std::uint64_t end = memory_[0].load(std::memory_order_acquire);
    if (end <= number_) return {};
    const std::string_view message = read(end - 1, buffer);
    if (message.empty()) continue;
    number_ = end;
    return message;
  }
  return {};
}

void RingReader::skip() noexcept {
  if (memory_ != nullptr) number_ = memory_[0].load(std::memory_order_acquire);
}

}  // namespace vps::scenes

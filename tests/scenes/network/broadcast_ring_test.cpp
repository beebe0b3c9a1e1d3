// SPDX-License-Identifier: BSD-3-Clause
// The ring of messages in shared memory: order, overruns, torn messages, a killed writer, and invalid
// contents.
#include "link/broadcast_ring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <thread>

#include "support/no_alloc.h"

namespace vps::scenes {
namespace {

constexpr RingShape kShape{8, 64};

class BroadcastRing : public testing::Test {
 protected:
  [[nodiscard]] std::string next() { return std::string(reader_.next(buffer_)); }
  [[nodiscard]] std::string latest() { return std::string(reader_.latest(buffer_)); }

  std::unique_ptr<SharedWord[]> memory_ = std::make_unique<SharedWord[]>(kShape.words());
  RingWriter writer_{memory_.get(), kShape};
  RingReader reader_{memory_.get(), kShape};
  std::array<char, 64> buffer_{};
};

TEST_F(BroadcastRing, MessagesOfEveryLengthComeInOrderAndOnce) {
  EXPECT_EQ(next(), "");
  for (std::size_t length = 1; length <= 64; ++length) {
    ASSERT_TRUE(writer_.write(std::string(length, static_cast<char>('0' + length % 10))));
    EXPECT_EQ(next(), std::string(length, static_cast<char>('0' + length % 10)));
    EXPECT_EQ(next(), "");
  }
  EXPECT_EQ(reader_.lost(), 0u);
}

TEST_F(BroadcastRing, TheLatestMessageIsReadOnceAndTheOnesBeforeItAreSkipped) {
  writer_.write("a");
  writer_.write("b");
  EXPECT_EQ(latest(), "b");
  EXPECT_EQ(latest(), "");
  writer_.write("c");
  EXPECT_EQ(next(), "c");
}

TEST_F(BroadcastRing, AReaderThatIsTooSlowGetsTheLastMessagesAndTheCountOfTheOthers) {
  for (int i = 0; i < 20; ++i) writer_.write(std::to_string(i));
  for (int i = 12; i < 20; ++i) EXPECT_EQ(next(), std::to_string(i));
  EXPECT_EQ(next(), "");
  EXPECT_EQ(reader_.lost(), 12u);
}

TEST_F(BroadcastRing, AMessageThatIsTooLongIsNotWritten) {
  EXPECT_FALSE(writer_.write(std::string(65, 'x')));
  EXPECT_EQ(next(), "");
}

TEST_F(BroadcastRing, AWriterThatDiesInTheMiddleLeavesTheMessagesBeforeAndTheNextWriterGoesOn) {
  writer_.write("before");
  const std::size_t second_slot = 8 + kShape.slotWords();
  memory_[second_slot] = 2 * 1 + 1;  // marks the slot as being written
  memory_[second_slot + 1] = 5;
  EXPECT_EQ(latest(), "before");
  RingWriter next_writer(memory_.get(), kShape);
  next_writer.write("after");
  EXPECT_EQ(next(), "after");
  EXPECT_EQ(reader_.lost(), 0u);
}

TEST_F(BroadcastRing, GarbageInTheMemoryIsNeitherReadBeyondItsEndNorWaitedFor) {
  const std::array<std::uint64_t, 4> bad = {~std::uint64_t{0}, std::uint64_t{1} << 63U, 1000, 65};
  for (const std::uint64_t number : bad)
    for (const std::uint64_t size : bad) {
      memory_[0] = number;
      for (std::uint32_t slot = 0; slot < kShape.slots; ++slot) {
        memory_[8 + slot * kShape.slotWords()] = 2 * (number - kShape.slots + slot) + 2;
        memory_[9 + slot * kShape.slotWords()] = size;
      }
      RingReader reader(memory_.get(), kShape);
      EXPECT_TRUE(reader.next(buffer_).empty());
      EXPECT_TRUE(reader.latest(buffer_).empty());
    }
}

TEST_F(BroadcastRing, WritingAndReadingAllocateNothing) {
  const std::string message(64, 'x');
  const vps_test::NoAllocScope scope;
  writer_.write(message);
  EXPECT_EQ(reader_.latest(buffer_).size(), 64u);
}

/// Each byte of a message identifies the message, so that a mixture is detected.
TEST_F(BroadcastRing, NoReaderSeesHalfOfAMessageWhileOneIsBeingWritten) {
  constexpr int kMessages = 200'000;
  std::atomic<bool> is_done{false};
  std::array<std::uint64_t, 2> whole{}, torn{};
  const auto read = [&](std::size_t who, bool newest_only) {
    RingReader reader(memory_.get(), kShape);
    std::array<char, 64> buffer{};
    for (bool is_last = false; !is_last;) {
      is_last = is_done.load();
      for (std::string_view m; !(m = newest_only ? reader.latest(buffer) : reader.next(buffer)).empty();)
        ++(std::all_of(m.begin(), m.end(), [&](char c) { return c == m[0]; }) ? whole : torn)[who];
    }
  };
  std::thread in_order(read, 0, false), newest(read, 1, true);
  for (int i = 0; i < kMessages; ++i)
    writer_.write(std::string(static_cast<std::size_t>(1 + i % 64), static_cast<char>(i % 251)));
  is_done = true;
  in_order.join();
  newest.join();
  for (const std::size_t who : {0U, 1U}) {
    EXPECT_GT(whole[who], 0u);
    EXPECT_EQ(torn[who], 0u);
  }
}

}  // namespace
}  // namespace vps::scenes

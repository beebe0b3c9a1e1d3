// SPDX-License-Identifier: BSD-3-Clause
// One damaged number must not make all later messages old, and replayed messages must not become new.
#include "messages/message_order.h"

#include <gtest/gtest.h>

#include "messages/messages.h"
#include "support/device/fake_device.h"

namespace vps::scenes {
namespace {

using Place = MessageOrder::Place;
constexpr std::int64_t kPeriod_ns = 1'000'000;

/// A sender at 1 kHz whose clock is an hour ahead.
class Sender {
 public:
  Place send(std::uint64_t number) { return order.place(number, timeOf(number), at(number)); }
  /// A message with a damaged number, sent at this time.
  Place sendAs(std::uint64_t number, std::uint64_t when) {
    return order.place(number, timeOf(when), at(when));
  }
  /// A message that was stored and is sent again later.
  Place sendAgain(std::uint64_t number, std::uint64_t when) {
    return order.place(number, timeOf(number), at(when));
  }
  static std::int64_t at(std::uint64_t number) { return static_cast<std::int64_t>(number) * kPeriod_ns; }
  static std::int64_t timeOf(std::uint64_t number) { return at(number) + 3'600'000'000'000; }
  MessageOrder order;
};

TEST(MessageOrder, NoBitOfANumberStopsTheMessagesAfterIt) {
  for (int bit = 0; bit < 64; ++bit) {
    Sender sender;
    std::uint64_t number = 1;
    for (; number < 100; ++number) ASSERT_EQ(sender.send(number), Place::Next);
    (void)sender.sendAs(number ^ (std::uint64_t{1} << static_cast<unsigned>(bit)), number);
    ++number;
    int refused = 0;
    for (int i = 0; i < 100; ++i) refused += sender.send(number++) != Place::Next;
    EXPECT_LT(refused, MessageOrder::kRunUntilTrusted) << "bit " << bit;
  }
}

TEST(MessageOrder, ADamagedFirstNumberIsCorrected) {
  Sender sender;
  EXPECT_EQ(sender.sendAs(std::uint64_t{1} << 60U, 1),
            Place::Next);  // the first message has no predecessor to compare with
  EXPECT_EQ(sender.send(2), Place::Old);
  EXPECT_EQ(sender.send(3), Place::Old);
  EXPECT_EQ(sender.send(4), Place::Next);
  EXPECT_EQ(sender.send(5), Place::Next);
}

TEST(MessageOrder, KeptMessagesStayOldHoweverManyComeAndWhenever) {
  Sender sender;
  for (std::uint64_t number = 1; number <= 500; ++number) ASSERT_EQ(sender.send(number), Place::Next);
  for (const std::uint64_t later : {500u, 5'000u, 500'000u})
    for (std::uint64_t number = 1; number <= 500; ++number)
      ASSERT_EQ(sender.sendAgain(number, later + number), Place::Old);
}

TEST(MessageOrder, APauseOfTheLinkIsNoJump) {
  Sender sender;
  ASSERT_EQ(sender.send(1), Place::Next);
  EXPECT_EQ(sender.send(60'000), Place::Next);  // sent a minute later
  EXPECT_EQ(sender.sendAs(60'001 + MessageOrder::kMostAtOnce + 100, 60'001), Place::TooFarAhead);
  EXPECT_EQ(sender.send(60'001), Place::Next);
}

TEST(MessageOrder, ARequestThatIsSentAgainCountsOnce) {
  Sender sender;
  ASSERT_EQ(sender.send(1), Place::Next);
  for (std::uint64_t when = 2; when < 20; ++when) EXPECT_EQ(sender.sendAs(1, when), Place::Old);
  EXPECT_EQ(sender.send(20), Place::Next);
}

// The bytes of the number in a message, which a flipped bit changes.
TEST(MessageOrder, AReaderSurvivesAFlippedBitInEachByteOfTheNumber) {
  constexpr std::size_t kNumberAt = 12;  // kind, version and sender precede it
  for (std::size_t byte = 0; byte < 8; ++byte) {
    MessageWriter writer(5);
    MessageReader reader;
    PhysicsMessage message;
    ASSERT_EQ(reader.read(writer.write(message), message), Reading::Good);
    std::string damaged(writer.write(message));
    damaged[kNumberAt + byte] = static_cast<char>(damaged[kNumberAt + byte] ^ 0x40);
    (void)reader.read(damaged, message);
    int good = 0;
    for (int i = 0; i < 10; ++i) good += reader.read(writer.write(message), message) == Reading::Good;
    EXPECT_GE(good, 8) << "byte " << byte;
  }
}

}  // namespace
}  // namespace vps::scenes

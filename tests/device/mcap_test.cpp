// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/detail/mcap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vps_device/detail/bytes.h"

namespace vps::device {
namespace {

constexpr int kMessages = 40;

std::string dataOf(int i) {
  std::string out;
  ByteWriter(out).put(1.0 / (i + 1));
  return out;
}

/// Two channels, an attachment, metadata, and messages that fill several chunks (of 250 ms).
std::string smallFile(std::size_t* first_chunk_at = nullptr) {
  std::string bytes;
  McapWriter writer([&](std::string_view piece) { bytes += piece; }, "ros2", "test");
  const std::uint16_t schema = writer.addSchema("test/msg/Number", "ros2msg", "float64 x\n");
  const std::uint16_t a = writer.addChannel({0, schema, "/a", "cdr", {{"key", "value"}}});
  const std::uint16_t b = writer.addChannel({0, schema, "/b", "cdr", {}});
  writer.addAttachment({"scene", "application/octet-stream", std::string("\0\1\2", 3)});
  writer.addMetadata({"run", {{"seed", "7"}, {"empty", ""}}});
  if (first_chunk_at != nullptr) *first_chunk_at = bytes.size();
  for (int i = 0; i < kMessages; ++i)
    writer.write(i % 3 == 0 ? b : a, static_cast<std::uint32_t>(i),
                 static_cast<std::uint64_t>(i) * 20'000'000, dataOf(i));
  writer.finish();
  return bytes;
}

/// Number of messages, all of which must be as written.
std::size_t goodMessages(const McapContent& content) {
  for (std::size_t i = 0; i < content.messages.size(); ++i) {
    EXPECT_EQ(content.messages[i].sequence, i);
    EXPECT_EQ(content.messages[i].data, dataOf(static_cast<int>(i)));
    EXPECT_EQ(content.messages[i].time_ns, i * 20'000'000);
  }
  return content.messages.size();
}

TEST(Crc32, HasTheStandardsCheckValue) {
  EXPECT_EQ(crc32("123456789"), 0xcbf43926u);  // the check value in the catalogue of CRC-32/ISO-HDLC
}

TEST(Mcap, WhatIsWrittenReadsBack) {
  const std::string bytes = smallFile();
  const McapContent content = readMcap(bytes);
  EXPECT_FALSE(content.damage);
  EXPECT_EQ(content.profile, "ros2");
  EXPECT_EQ(content.library, "test");
  EXPECT_EQ(goodMessages(content), static_cast<std::size_t>(kMessages));
  ASSERT_EQ(content.channels.size(), 2u);
  EXPECT_EQ(content.channels.at(1).topic, "/a");
  EXPECT_EQ(content.channels.at(1).metadata.at("key"), "value");
  EXPECT_EQ(content.schemas.at(1).data, "float64 x\n");
  ASSERT_EQ(content.attachments.size(), 1u);
  EXPECT_EQ(content.attachments[0].data, std::string("\0\1\2", 3));
  ASSERT_EQ(content.metadata.size(), 1u);
  EXPECT_EQ(content.metadata[0].values.at("seed"), "7");
}

TEST(Mcap, WritesTheRecordLayoutOfTheSpecification) {
  // The expected bytes are worked out by hand from the specification's tables for a file with one message.
  std::string bytes;
  McapWriter writer([&](std::string_view piece) { bytes += piece; }, "", "");
  const std::uint16_t channel = writer.addChannel({0, 0, "t", "", {}});
  writer.write(channel, 5, 6, "x");
  writer.finish();
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes.at(i)); };
  EXPECT_EQ(bytes.substr(0, 8), "\x89MCAP0\r\n");
  EXPECT_EQ(at(8), 0x01);  // header: two empty strings, 8 bytes
  EXPECT_EQ(at(9), 8);
  EXPECT_EQ(at(25), 0x04);  // channel: 2 + 2 + (4 + 1) + 4 + 4
  EXPECT_EQ(at(26), 17);
  EXPECT_EQ(at(51), 0x06);  // chunk: 8 + 8 + 8 + 4 + 4 + 8 + (9 + 2 + 4 + 8 + 8 + 1)
  EXPECT_EQ(at(52), 40 + 32);
  EXPECT_EQ(at(51 + 9 + 40), 0x05);
  EXPECT_EQ(at(51 + 9 + 72), 0x07);  // message index: 2 + 4 + 16
  EXPECT_EQ(at(51 + 9 + 72 + 1), 22);
  EXPECT_EQ(at(51 + 9 + 72 + 31), 0x0f);
  const std::size_t summary = 51 + 9 + 72 + 31 + 13;
  EXPECT_EQ(at(summary), 0x04);  // the file has no schema, so the summary begins with the copy of the channel
  EXPECT_EQ(bytes.substr(bytes.size() - 8), bytes.substr(0, 8));
  const std::size_t footer = bytes.size() - 8 - 29;
  EXPECT_EQ(at(footer), 0x02);
  EXPECT_EQ(at(footer + 9) + 256 * at(footer + 10), static_cast<int>(summary));
}

TEST(Mcap, AFileCutAtAnyByteIsReadUpToTheCutAndReportsIt) {
  const std::string whole = smallFile();
  std::size_t before = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string bytes = whole.substr(0, length);
    const McapContent content = readMcap(bytes);
    ASSERT_TRUE(content.damage) << length;
    EXPECT_TRUE(content.damage->is_cut) << length;
    EXPECT_LE(content.damage->at_byte, length);
    const std::size_t kept = goodMessages(content);
    ASSERT_GE(kept, before) << length;  // a longer file never yields fewer messages
    before = kept;
  }
  EXPECT_EQ(before, static_cast<std::size_t>(kMessages));
}

TEST(Mcap, ACompleteMessageBeforeTheCutIsKept) {
  std::size_t chunk_at = 0;
  const std::string whole = smallFile(&chunk_at);
  // The first chunk's head is 9 + 40 bytes, a message 9 + 22 + 8.
  for (std::size_t n = 0; n < 5; ++n) {
    const std::string bytes = whole.substr(0, chunk_at + 49 + n * 39 + 38);
    EXPECT_EQ(readMcap(bytes).messages.size(), n);
  }
}

TEST(Mcap, EveryChangedByteIsDetectedAndNoWrongMessageReturned) {
  const std::string whole = smallFile();
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ flip);
      const McapContent content = readMcap(bytes);
      EXPECT_TRUE(content.damage) << "byte " << at << " changed by " << flip;
      for (const McapMessage& message : content.messages)
        ASSERT_EQ(message.data, dataOf(static_cast<int>(message.sequence))) << at;
    }
}

TEST(Mcap, WrongLengthsNeitherHangNorAllocate) {
  std::string bytes = smallFile().substr(0, 8);
  ByteWriter writer(bytes);
  writer.put(std::uint8_t{9});
  writer.put(~std::uint64_t{0});  // an attachment of 2^64 - 1 bytes
  writer.put(~std::uint64_t{0});
  EXPECT_TRUE(readMcap(bytes).damage);
  EXPECT_TRUE(readMcap("").damage);
  EXPECT_TRUE(readMcap("solid cube").damage);
  EXPECT_FALSE(readMcap("solid cube").damage->is_cut);
}

TEST(ByteReader, MissingDataReadsAsZeroAndStaysBad) {
  ByteReader in("\1\2\3");
  EXPECT_EQ(in.get<std::uint16_t>(), 0x0201);
  EXPECT_EQ(in.get<std::uint32_t>(), 0u);
  EXPECT_FALSE(in.isGood());
  EXPECT_EQ(in.get<std::uint8_t>(), 0);
}

TEST(ByteWriter, DoublesKeepEveryBit) {
  for (const double x : {0.0, -0.0, 1.0 / 3, std::nan("7"), -HUGE_VAL, 5e-324}) {
    std::string out;
    ByteWriter(out).put(x);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(ByteReader(out).getDouble()), std::bit_cast<std::uint64_t>(x));
  }
}

}  // namespace
}  // namespace vps::device

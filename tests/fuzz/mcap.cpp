// SPDX-License-Identifier: BSD-3-Clause
// Reads arbitrary bytes as an MCAP file, the container of recordings.
#include "vps_device/detail/mcap.h"

#include "fuzz.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const vps::device::McapContent content = vps::device::readMcap(bytes);
  vps::fuzz::require(content.messages.size() <= size / 31, "a message takes its bytes");
  for (const vps::device::McapMessage& message : content.messages) {
    vps::fuzz::require(content.channels.contains(message.channel), "a message has a channel");
    vps::fuzz::require(message.data.data() >= bytes.data() &&
                           message.data.data() + message.data.size() <= bytes.data() + size,
                       "messages lie within the bytes");
  }
  if (content.damage) vps::fuzz::require(content.damage->at_byte <= size, "damage lies within the bytes");
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  std::string bytes;
  device::McapWriter writer([&](std::string_view piece) { bytes += piece; }, "ros2", "fuzz");
  const std::uint16_t schema = writer.addSchema("x/msg/X", "ros2msg", "float64 x\n");
  const std::uint16_t channel = writer.addChannel({0, schema, "/x", "cdr", {{"a", "b"}}});
  writer.addAttachment({"a", "text/plain", "some text"});
  writer.addMetadata({"m", {{"k", "v"}}});
  for (std::uint32_t i = 0; i < 6; ++i) writer.write(channel, i, i * 100'000'000ull, "12345678");
  writer.finish();
  return {bytes};
}

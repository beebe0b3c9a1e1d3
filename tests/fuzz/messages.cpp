// SPDX-License-Identifier: BSD-3-Clause
// Reads arbitrary bytes as each kind of message between nodes.
#include "messages/messages.h"

#include "fuzz.h"

namespace {

using namespace vps::scenes;

constexpr std::size_t kEnvelope = 28;

/// Writing the message that was read gives the same bytes again, so that nothing was invented or lost.
template <typename Message>
void read(std::string_view bytes) {
  MessageReader reader;
  Message message;
  // A dense state can be read only after a whole state of its sender.
  if (isDense(bytes)) {
    MessageWriter whole(denseHead(bytes, 0).sender);
    reader.read(whole.write(Message{}), message);
  }
  const std::uint64_t refused = reader.refused();
  if (const Reading reading = reader.read(bytes, message); reading != Reading::Good) {
    vps::fuzz::require(reader.refused() == refused + isRefused(reading), "what is refused is counted");
    return;
  }
  MessageWriter writer(reader.envelope().sender);
  constexpr char kCompactBit = static_cast<char>(0x80);  // dense states have this bit too
  if ((bytes[0] & kCompactBit) == 0)
    vps::fuzz::require(writer.write(message).substr(kEnvelope) == bytes.substr(kEnvelope),
                       "a message is read back unchanged");
  MessageWriter compact(reader.envelope().sender, WireForm::Compact);
  const std::string again(compact.write(message));
  vps::fuzz::require(MessageReader().read(again, message) == Reading::Good, "what was read can be sent");
  vps::fuzz::require(reader.read(bytes, message) == Reading::Replayed, "a message counts once");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  read<HapticMessage>(bytes);
  read<PhysicsMessage>(bytes);
  read<RequestMessage>(bytes);
  read<ReplyMessage>(bytes);
  read<HelloMessage>(bytes);
  read<TimesMessage>(bytes);
  read<LogMessage>(bytes);
  read<SnapshotMessage>(bytes);
  read<NewsMessage>(bytes);
  read<PointerMessage>(bytes);
  read<BeatMessage>(bytes);
  read<AskMessage>(bytes);
  read<AnswerMessage>(bytes);
  read<PieceMessage>(bytes);
  read<FetchedMessage>(bytes);
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  MessageWriter writer(1), compact(1, WireForm::Compact), dense(1, WireForm::Compact);
  for (int i = 0; i < 8; ++i) dense.write(HapticMessage{}), dense.write(PhysicsMessage{});
  SnapshotMessage snapshot;
  snapshot.snapshot.bodies.resize(2);
  snapshot.snapshot.contacts.resize(2);
  return {std::string(writer.write(HapticMessage{})),
          std::string(writer.write(PhysicsMessage{})),
          std::string(compact.write(HapticMessage{})),
          std::string(compact.write(PhysicsMessage{})),
          std::string(dense.write(HapticMessage{})),
          std::string(dense.write(PhysicsMessage{})),
          std::string(compact.write(snapshot)),
          std::string(writer.write(RequestMessage{})),
          std::string(writer.write(HelloMessage{})),
          std::string(writer.write(LogMessage{1, device::SyncEvent{}})),
          std::string(writer.write(LogMessage{2, device::DeviceSample{}})),
          std::string(writer.write(snapshot)),
          std::string(writer.write(NewsMessage{})),
          std::string(writer.write(PointerMessage{})),
          std::string(writer.write(BeatMessage{})),
          std::string(writer.write(AskMessage{})),
          std::string(writer.write(AnswerMessage{})),
          std::string(writer.write(PieceMessage{})),
          std::string(writer.write(FetchedMessage{}))};
}

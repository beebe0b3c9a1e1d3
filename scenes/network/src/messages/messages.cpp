// SPDX-License-Identifier: BSD-3-Clause
#include "messages/messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "link/link.h"
#include "messages/compact_fields.h"
#include "messages/dense_state.h"
#include "messages/field_visitors.h"
#include "messages/message_fields.h"
#include "vps_device/detail/bytes.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

namespace {

using wire::CompactGet, wire::CompactPut, wire::Get, wire::Put;

constexpr std::size_t kEnvelopeBytes = 28;
// Envelope of a compact message: kind and version, sender, number, microseconds.
constexpr std::size_t kCompactEnvelopeBytes = 16;
constexpr std::uint16_t kCompactBit = 0x80;

template <typename Message>
constexpr MessageKind kKindOf = MessageKind::Haptic;
template <typename Message>
constexpr bool kHasCompact =
    std::is_same_v<Message, HapticMessage> || std::is_same_v<Message, PhysicsMessage> ||
    std::is_same_v<Message, SnapshotMessage>;
template <typename Message>
constexpr bool kHasDense = std::is_same_v<Message, HapticMessage> || std::is_same_v<Message, PhysicsMessage>;
template <typename Message>
constexpr MessageKind kDenseKindOf =
    std::is_same_v<Message, HapticMessage> ? MessageKind::DenseHaptic : MessageKind::DensePhysics;
template <>
constexpr MessageKind kKindOf<PhysicsMessage> = MessageKind::Physics;
template <>
constexpr MessageKind kKindOf<RequestMessage> = MessageKind::Request;
template <>
constexpr MessageKind kKindOf<ReplyMessage> = MessageKind::Reply;
template <>
constexpr MessageKind kKindOf<HelloMessage> = MessageKind::Hello;
template <>
constexpr MessageKind kKindOf<TimesMessage> = MessageKind::Times;
template <>
constexpr MessageKind kKindOf<LogMessage> = MessageKind::Log;
template <>
constexpr MessageKind kKindOf<SnapshotMessage> = MessageKind::Snapshot;
template <>
constexpr MessageKind kKindOf<NewsMessage> = MessageKind::News;
template <>
constexpr MessageKind kKindOf<BeatMessage> = MessageKind::Beat;
template <>
constexpr MessageKind kKindOf<PointerMessage> = MessageKind::Pointer;
template <>
constexpr MessageKind kKindOf<AskMessage> = MessageKind::Ask;
template <>
constexpr MessageKind kKindOf<AnswerMessage> = MessageKind::Answer;
template <>
constexpr MessageKind kKindOf<PieceMessage> = MessageKind::Piece;
template <>
constexpr MessageKind kKindOf<FetchedMessage> = MessageKind::Fetched;

/// The time whose microseconds have these lower bits and that is nearest to now.
std::int64_t nearNow_ns(std::uint32_t low_us) {
  const std::int64_t now_us = device::monotonicClock().now_ns() / 1000;
  const auto ahead = static_cast<std::int32_t>(low_us - static_cast<std::uint32_t>(now_us));
  return 1000 * (now_us + ahead);
}

}  // namespace

const char* toText(Reading reading) {
  switch (reading) {
    case Reading::Good:
      return "good";
    case Reading::BadSize:
      return "of the wrong size";
    case Reading::BadVersion:
      return "of another version";
    case Reading::BadKind:
      return "of another kind";
    case Reading::BadValue:
      return "with values out of range";
    case Reading::WrongSender:
      return "of another sender";
    case Reading::Replayed:
      return "sent before";
    case Reading::TooFarAhead:
      return "with a number too far ahead";
    case Reading::Early:
      return "received before the first whole state";
    case Reading::Overtaken:
      return "overtaken by a later state";
  }
  return "unknown";
}

MessageWriter::MessageWriter(std::uint64_t sender, WireForm form) : sender_(sender), form_(form) {
  out_.reserve(kLongestMessage);
}

template <typename Message>
std::string_view MessageWriter::write(const Message& message) noexcept {
  constexpr MessageKind kKind = kKindOf<Message>;
  out_.clear();
  if constexpr (kHasCompact<Message>) {
    if (form_ == WireForm::Compact && !(kHasDense<Message> && has_exact_states_)) {
      if constexpr (kHasDense<Message>) {
        DenseWriter& dense = kKind == MessageKind::Haptic ? dense_haptic_ : dense_physics_;
        std::uint64_t& number = numbers_[static_cast<std::size_t>(kDenseKindOf<Message>)];
        if (dense.write(message, sender_, number + 1, out_)) {
          ++number;
          device::ByteWriter(out_).put(static_cast<std::uint64_t>(device::monotonicClock().now_ns()));
          return out_;
        }
      }
      device::ByteWriter head(out_);
      head.put(static_cast<std::uint16_t>(static_cast<std::uint16_t>(kKind) | kCompactBit));
      head.put(kMessageVersion);
      head.put(static_cast<std::uint32_t>(sender_));
      head.put(static_cast<std::uint32_t>(++numbers_[static_cast<std::size_t>(kKind)]));
      head.put(static_cast<std::uint32_t>(device::monotonicClock().now_ns() / 1000));
      CompactPut put(out_);
      wire::compactFields(const_cast<Message&>(message), put);  // CompactPut does not change the message
      return out_;
    }
  }
  Put put(out_);
  put.number(static_cast<std::uint16_t>(kKind));
  put.number(kMessageVersion);
  Envelope envelope{sender_, ++numbers_[static_cast<std::size_t>(kKind)], device::monotonicClock().now_ns()};
  wire::fields(envelope, put);
  wire::fields(const_cast<Message&>(message), put);  // Put does not change the message
  return out_;
}

MessageKind kindOf(std::string_view bytes) noexcept {
  return static_cast<MessageKind>(device::ByteReader(bytes).get<std::uint16_t>());
}

template <typename Message>
Reading MessageReader::readDenseState(std::string_view bytes, Message& message) noexcept {
  constexpr auto kKind = static_cast<std::size_t>(kDenseKindOf<Message>);
  if (!isDenseOf(bytes, message)) return Reading::BadKind;
  if (!isThisVersion(bytes)) return Reading::BadVersion;
  DenseBase& base = baseFor(message);
  const DenseHead head = denseHead(bytes, last_numbers_[kKind]);
  const std::uint64_t sender = sender_ != 0 ? sender_ : envelope_.sender;
  if (head.sender != sender % kDenseSenders) return sender_ != 0 ? Reading::WrongSender : Reading::Early;
  if (!base.is_known) return Reading::Early;
  Message read = message;
  if (!readDense(bytes, base, read)) return Reading::BadValue;
  if (isOlder(read, message)) return Reading::Overtaken;
  const auto sent_ns =
      static_cast<std::int64_t>(device::ByteReader(bytes.substr(kDenseBytes)).get<std::uint64_t>());
  const MessageOrder::Place place = orders_[kKind].place(head.number, sent_ns, clock_->now_ns());
  if (place != MessageOrder::Place::Next)
    return place == MessageOrder::Place::Old ? Reading::Replayed : Reading::TooFarAhead;
  last_numbers_[kKind] = head.number;
  envelope_ = {sender, head.number, sent_ns};
  message = read;
  return Reading::Good;
}

template <typename Message>
Reading MessageReader::read(std::string_view bytes, Message& message) noexcept {
  constexpr MessageKind kKind = kKindOf<Message>;
  const Reading reading = [&] {
    if constexpr (kHasDense<Message>)
      if (isDense(bytes)) return readDenseState(bytes, message);
    if (bytes.size() < kCompactEnvelopeBytes) return Reading::BadSize;
    device::ByteReader head(bytes);
    const auto kind = head.get<std::uint16_t>();
    const bool is_compact = kHasCompact<Message> && kind == (static_cast<std::uint16_t>(kKind) | kCompactBit);
    if (!is_compact && bytes.size() < kEnvelopeBytes) return Reading::BadSize;
    if (!is_compact && kind != static_cast<std::uint16_t>(kKind)) return Reading::BadKind;
    if (head.get<std::uint16_t>() != kMessageVersion) return Reading::BadVersion;
    Envelope envelope;
    Message read = message;
    const auto take = [&](auto& get, const auto& fields) {
      fields(read, get);
      if (!get.isAllRead()) return get.isGood() ? Reading::BadSize : Reading::BadValue;
      return get.isGood() ? Reading::Good : Reading::BadValue;
    };
    Reading taken = Reading::BadKind;
    if (is_compact) {
      if constexpr (kHasCompact<Message>) {
        envelope.sender = head.get<std::uint32_t>();
        if (sender_ != 0 && envelope.sender != static_cast<std::uint32_t>(sender_))
          return Reading::WrongSender;
        if (sender_ != 0) envelope.sender = sender_;
        envelope.number = head.get<std::uint32_t>();
        envelope.time_ns = nearNow_ns(head.get<std::uint32_t>());
        CompactGet get(bytes.substr(kCompactEnvelopeBytes));
        taken = take(get, [](Message& m, CompactGet& visit) { wire::compactFields(m, visit); });
      }
    } else {
      Get get(bytes.substr(4));
      wire::fields(envelope, get);
      if (sender_ != 0 && envelope.sender != sender_) return Reading::WrongSender;
      taken = take(get, [](Message& m, Get& visit) { wire::fields(m, visit); });
    }
    if (taken != Reading::Good) return taken;
    if (envelope.sender != envelope_.sender) forget();
    const MessageOrder::Place place =
        orders_[static_cast<std::size_t>(kKind)].place(envelope.number, envelope.time_ns, clock_->now_ns());
    if (place != MessageOrder::Place::Next)
      return place == MessageOrder::Place::Old ? Reading::Replayed : Reading::TooFarAhead;
    envelope_ = envelope;
    if constexpr (kHasDense<Message>) {
      DenseBase& base = baseFor(message);
      const DenseBase given = baseOf(read);
      if (is_compact && base.is_known) keepNewer(read, message);
      base = given;
    }
    message = std::move(read);
    return Reading::Good;
  }();
  ++counts_[static_cast<std::size_t>(reading)];
  return reading;
}

std::uint64_t MessageReader::refused() const noexcept {
  std::uint64_t sum = 0;
  for (std::size_t i = 1; i < kReadings; ++i)
    if (isRefused(static_cast<Reading>(i))) sum += counts_[i];
  return sum;
}

std::uint64_t newSender() {
  std::random_device random;
  std::uint64_t sender = 0;
  while (sender == 0) sender = std::uint64_t{random()} << 32U | random();
  return sender;
}

#define MESSAGE(Type)                                                         \
  template std::string_view MessageWriter::write<Type>(const Type&) noexcept; \
  template Reading MessageReader::read<Type>(std::string_view, Type&) noexcept;
MESSAGE(HapticMessage)
MESSAGE(PhysicsMessage)
MESSAGE(RequestMessage)
MESSAGE(ReplyMessage)
MESSAGE(HelloMessage)
MESSAGE(TimesMessage)
MESSAGE(LogMessage)
MESSAGE(SnapshotMessage)
MESSAGE(NewsMessage)
MESSAGE(BeatMessage)
MESSAGE(PointerMessage)
MESSAGE(AskMessage)
MESSAGE(AnswerMessage)
MESSAGE(PieceMessage)
MESSAGE(FetchedMessage)
#undef MESSAGE

}  // namespace vps::scenes

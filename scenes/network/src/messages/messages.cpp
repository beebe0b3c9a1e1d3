// SPDX-License-Identifier: BSD-3-Clause
#include "messages/messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "link/link.h"
#include "messages/compact_fields.h"
#include "messages/dense_state.h"
#include "messages/message_fields.h"
#include "vps_device/detail/bytes.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

namespace {

constexpr double kLargest = 1e12;        // limit of any number that a correct node sends
constexpr double kRotationError = 1e-6;  // assumed: far above rounding, far below the threshold of touch
constexpr std::size_t kEnvelopeBytes = 28;
// Envelope of a compact message: kind and version, sender, number, microseconds.
constexpr std::size_t kCompactEnvelopeBytes = 16;
constexpr std::uint16_t kCompactBit = 0x80;
constexpr std::uint32_t kLongestList =
    1024;  // limit of the bodies or contacts in a snapshot; further ones are left out

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

/// Composes fields from numbers, for writing and reading.
template <typename Self>
class Visit {
 public:
  void operator()(Vec3& x) {
    for (double& component : x) self().number(component);
  }
  void operator()(Twist& x) { (*this)(x.w), (*this)(x.v); }
  void operator()(Wrench& x) { (*this)(x.tau), (*this)(x.f); }
  void operator()(Pose& x) {
    for (double& entry : x.R.reshaped()) self().number(entry);
    (*this)(x.p);
    self().checkRotation(x.R);
  }
  void operator()(bool& x) { self().flag(x); }
  void operator()(std::optional<double>& x) {
    bool has_value = x.has_value();
    double value = x.value_or(0);
    self().flag(has_value);
    self().number(value);
    if (!has_value && std::bit_cast<std::uint64_t>(value) != 0) self().refuse();
    x = has_value ? std::optional(value) : std::nullopt;
  }
  template <std::size_t N>
  void operator()(std::array<char, N>& text) {
    self().text(text.data(), N);
  }
  template <std::size_t N>
  void raw(std::array<char, N>& bytes) {
    self().put(bytes.data(), N);
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void operator()(T& x) { self().number(x); }
  void notNegative(double& x) {
    self().number(x);
    if (x < 0) self().refuse();
  }
  void unchecked(bool on) { is_unchecked_ = on; }
  void alternative(device::LogEntry& entry) {
    std::uint8_t index = static_cast<std::uint8_t>(entry.index());
    choice(index, 5);
    self().become(entry, index);
    const auto visit = [this](auto& e) {
      using T = std::remove_reference_t<decltype(e)>;
      if constexpr (!std::is_same_v<T, device::RunEvent> && !std::is_same_v<T, device::RunTrace>)
        wire::fields(e, self());
    };
    std::visit(visit, entry);
  }
  template <typename Enum>
  void choice(Enum& e, unsigned count) {
    std::uint8_t byte = static_cast<std::uint8_t>(e);
    self().number(byte);
    if (byte >= count) return self().refuse();
    e = static_cast<Enum>(byte);
  }

 protected:
  bool is_unchecked_ = false;

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

/// Composes fields in the compact form, for writing and reading.
template <typename Self>
class CompactVisit {
 public:
  void operator()(double& x) { self().number(x); }
  void operator()(Vec3& x) {
    for (double& component : x) self().number(component);
  }
  void operator()(Pose& x) {
    (*this)(x.p);
    self().rotation(x.R);
  }
  void operator()(std::optional<double>& x) {
    bool has_value = x.has_value();
    double value = x.value_or(0);
    exact(has_value);
    if (has_value) self().number(value);
    x = has_value ? std::optional(value) : std::nullopt;
  }
  void coarse(Twist& x) {
    for (Vec3* part : {&x.w, &x.v}) self().half(*part);
  }
  void coarse(Wrench& x) {
    for (Vec3* part : {&x.tau, &x.f}) self().half(*part);
  }
  void coarse(Vec3& x) { self().half(x); }
  void coarse(double& x) { self().half(x); }
  template <typename T>
  void exact(T& x) {
    if constexpr (std::is_same_v<T, bool>)
      self().flag(x);
    else
      self().whole(x);
  }
  template <typename Enum>
  void choice(Enum& e, unsigned count) {
    std::uint8_t byte = static_cast<std::uint8_t>(e);
    self().whole(byte);
    if (byte >= count) return self().refuse();
    e = static_cast<Enum>(byte);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }
};

class CompactPut : public CompactVisit<CompactPut> {
 public:
  explicit CompactPut(std::string& out) : writer_(out) {}
  void number(double x) { writer_.put(static_cast<float>(x)); }
  void half(double x) {
    const auto bounded = static_cast<float>(std::clamp(x, -kLargestHalf, kLargestHalf));
    writer_.put(std::bit_cast<std::uint16_t>(Eigen::half(bounded)));
  }
  void half(const Vec3& x) {
    for (const double component : x) half(component);
  }
  void rotation(const Mat3& R) { writer_.put(packedRotation(R)); }
  void flag(bool x) { writer_.put(static_cast<std::uint8_t>(x)); }
  template <typename T>
  void whole(T x) {
    writer_.put(x);
  }
  void refuse() {}
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const std::size_t count = std::min<std::size_t>(items.size(), kLongestList);
    writer_.put(static_cast<std::uint16_t>(count));
    for (std::size_t i = 0; i < count; ++i) each(items[i]);
  }

 private:
  static constexpr double kLargestHalf = 65504;
  device::ByteWriter writer_;
};

class CompactGet : public CompactVisit<CompactGet> {
 public:
  explicit CompactGet(std::string_view bytes) : reader_(bytes) {}
  [[nodiscard]] bool isAllRead() const { return reader_.isGood() && reader_.left() == 0; }
  [[nodiscard]] bool isGood() const { return is_good_; }

  void number(double& x) { check(x = reader_.getFloat()); }
  void half(double& x) {
    check(x = static_cast<float>(std::bit_cast<Eigen::half>(reader_.get<std::uint16_t>())));
  }
  void half(Vec3& x) {
    for (double& component : x) half(component);
  }
  void rotation(Mat3& R) {
    const std::optional<Mat3> read = unpackedRotation(reader_.get<std::uint64_t>());
    if (!read) return refuse();
    R = *read;
  }
  void flag(bool& x) {
    const auto byte = reader_.get<std::uint8_t>();
    if (byte > 1) refuse();
    x = byte == 1;
  }
  void whole(double& x) { check(x = reader_.getDouble()); }
  void whole(std::int32_t& x) { x = reader_.getInt(); }
  template <std::unsigned_integral T>
  void whole(T& x) {
    x = reader_.get<T>();
  }
  void refuse() { is_good_ = false; }
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const auto count = reader_.get<std::uint16_t>();
    items.clear();
    if (count > kLongestList) return refuse();
    for (std::uint32_t i = 0; i < count && reader_.isGood(); ++i) each(items.emplace_back());
  }

 private:
  void check(double x) {
    if (!(std::abs(x) <= kLargest)) refuse();
  }
  device::ByteReader reader_;
  bool is_good_ = true;
};

/// The time whose microseconds have these lower bits and that is nearest to now.
std::int64_t nearNow_ns(std::uint32_t low_us) {
  const std::int64_t now_us = device::monotonicClock().now_ns() / 1000;
  const auto ahead = static_cast<std::int32_t>(low_us - static_cast<std::uint32_t>(now_us));
  return 1000 * (now_us + ahead);
}

class Put : public Visit<Put> {
 public:
  explicit Put(std::string& out) : writer_(out) {}
  void number(double x) { writer_.put(x); }
  void number(std::int32_t x) { writer_.put(x); }
  void number(std::int64_t x) { writer_.put(static_cast<std::uint64_t>(x)); }
  template <std::unsigned_integral T>
  void number(T x) {
    writer_.put(x);
  }
  void flag(bool x) { writer_.put(static_cast<std::uint8_t>(x)); }
  void text(const char* bytes, std::size_t size) { writer_.bytes({bytes, size}); }
  void put(const char* bytes, std::size_t size) { writer_.bytes({bytes, size}); }
  void become(device::LogEntry&, std::uint8_t) {}
  void checkRotation(const Mat3&) {}
  void refuse() {}
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const std::size_t count = std::min<std::size_t>(items.size(), kLongestList);
    writer_.put(static_cast<std::uint32_t>(count));
    for (std::size_t i = 0; i < count; ++i) each(items[i]);
  }

 private:
  device::ByteWriter writer_;
};

class Get : public Visit<Get> {
 public:
  explicit Get(std::string_view bytes) : reader_(bytes) {}
  [[nodiscard]] bool isAllRead() const { return reader_.isGood() && reader_.left() == 0; }
  [[nodiscard]] bool isGood() const { return is_good_; }

  void number(double& x) {
    x = reader_.getDouble();
    if (!is_unchecked_ && !(std::abs(x) <= kLargest)) refuse();
  }
  void number(std::int32_t& x) { x = reader_.getInt(); }
  void number(std::int64_t& x) { x = static_cast<std::int64_t>(reader_.get<std::uint64_t>()); }
  template <std::unsigned_integral T>
  void number(T& x) {
    x = reader_.get<T>();
  }
  void flag(bool& x) {
    const std::uint8_t byte = reader_.get<std::uint8_t>();
    if (byte > 1) refuse();
    x = byte == 1;
  }
  void text(char* bytes, std::size_t size) {
    const std::string_view read = reader_.take(size);
    std::copy(read.begin(), read.end(), bytes);
    if (read.find('\0') == std::string_view::npos) refuse();
  }
  void put(char* bytes, std::size_t size) {
    const std::string_view read = reader_.take(size);
    std::copy(read.begin(), read.end(), bytes);
  }
  void become(device::LogEntry& entry, std::uint8_t index) {
    if (index == 0)
      entry = device::DeviceSample{};
    else if (index == 1)
      entry = device::WrittenWrench{};
    else if (index == 4)
      entry = device::SyncEvent{};
    else
      refuse();
  }
  void checkRotation(const Mat3& R) {
    if (is_unchecked_) return;
    const bool is_rotation =
        (R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() <= kRotationError && R.determinant() > 0;
    if (!is_rotation) refuse();
  }
  void refuse() { is_good_ = false; }
  template <typename List, typename Each>
  void list(List& items, const Each& each) {
    const auto count = reader_.get<std::uint32_t>();
    items.clear();
    if (count > kLongestList) return refuse();
    for (std::uint32_t i = 0; i < count && reader_.isGood(); ++i) each(items.emplace_back());
  }

 private:
  device::ByteReader reader_;
  bool is_good_ = true;
};

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

// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/device_end.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "vps/errors.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::microseconds kReplyPoll{100};
constexpr std::chrono::milliseconds kJoinPoll{2};
constexpr double kAgain_s =
    0.2;  // a request without a reply is sent again, since the peer may not have been discovered yet
constexpr double kReplyLimit_s = 5;  // assumed: planning a step takes milliseconds

std::int64_t now_ns() {
  return device::monotonicClock().now_ns();
}

double since_s(std::int64_t ns) {
  return 1e-9 * static_cast<double>(now_ns() - ns);
}

bool isSameDevice(const HelloMessage& a, const HelloMessage& b) {
  MessageWriter write_a(1), write_b(1);
  constexpr std::size_t kEnvelope = 28;
  return write_a.write(a).substr(kEnvelope) == write_b.write(b).substr(kEnvelope);
}

}  // namespace

DeviceEnd::DeviceEnd(Link& link, const std::atomic<bool>* stop, std::function<void(const std::string&)> say,
                     RunRequests* requests)
    : link_(link),
      stop_(stop),
      say_(std::move(say)),
      requests_(requests),
      writer_(link.sessionId(), link.form()),
      buffer_(kLongestMessage) {}

void DeviceEnd::welcome(const HelloMessage& hello) {
  const std::uint64_t sender = hello_reader_.envelope().sender;
  if (sender == sender_) return;  // a device node repeats its hello until it gets a request
  const std::string name = hello.name.data();
  if (first_ && !isSameDevice(*first_, hello)) {
    say_("the device '" + name + "' joined in place of '" + first_->name.data() +
         "', for whose limits the run was planned; start vps device with the original device");
    return;
  }
  if (!first_) first_ = hello;
  sender_ = sender;
  for (MessageReader* reader : {&reply_reader_, &state_reader_, &log_reader_}) reader->bindTo(sender);
  writer_.startAnew();
  is_present_ = true;
  ++joins_;
  say_("the device '" + name + "' has joined");
}

void DeviceEnd::poll() {
  for (std::string_view bytes; !(bytes = link_.receive(Channel::Reply, buffer_)).empty();) {
    HelloMessage hello;
    switch (kindOf(bytes)) {
      case MessageKind::Hello:
        if (hello_reader_.read(bytes, hello) == Reading::Good) welcome(hello);
        break;
      case MessageKind::Times:
        reply_reader_.read(bytes, times_);
        break;
      default:
        reply_reader_.read(bytes, reply_);
        break;
    }
  }
}

bool DeviceEnd::waitForDevice() {
  const int joins = joins_;
  is_present_ = false;
  while (!isStopped()) {
    poll();
    if (joins_ > joins && isPresent()) {
      heard_ns_ = now_ns();
      return true;
    }
    std::this_thread::sleep_for(kJoinPoll);
  }
  return false;
}

const HapticMessage* DeviceEnd::takeState() {
  const std::string_view bytes = link_.receive(Channel::Haptic, buffer_);
  if (bytes.empty() || state_reader_.read(bytes, state_) != Reading::Good) return nullptr;
  device::HapticState& state = state_.state;
  state.proxy = {state.report.X_WG, state.report.V_WG, state.report.time_s, state.proxy.is_coupled};
  heard_ns_ = now_ns();
  return &state_;
}

double DeviceEnd::silence_s() const {
  return since_s(heard_ns_);
}

bool DeviceEnd::request(const RequestMessage& request, const std::function<void()>& wait) {
  const int joins = joins_;
  const std::string bytes(writer_.write(request));
  link_.send(Channel::Request, bytes);
  const std::uint64_t number = writer_.number(MessageKind::Request);
  const std::int64_t begun_ns = now_ns();
  std::int64_t sent_ns = begun_ns;
  for (;;) {
    poll();
    if (joins_ != joins) return false;
    if (reply_.request == number) break;
    if (isStopped() || !isPresent()) return false;
    if (since_s(begun_ns) > kReplyLimit_s) return false;
    if (since_s(sent_ns) > kAgain_s) {
      sent_ns = now_ns();
      link_.send(Channel::Request, bytes);
    }
    wait();
    std::this_thread::sleep_for(kReplyPoll);
  }
  heard_ns_ = now_ns();
  // A run ends in any case, whatever the device node answers.
  if (reply_.refusal[0] != '\0' && request.kind != RequestKind::Stop)
    throw LoadError("", "", std::string("the device node refuses: ") + reply_.refusal.data());
  return true;
}

void DeviceEnd::send(const device::PhysicsState& state) {
  link_.send(Channel::Physics, writer_.write(PhysicsMessage{state}));
}
void DeviceEnd::send(const SnapshotMessage& snapshot) {
  link_.send(Channel::Snapshot, writer_.write(snapshot));
}
void DeviceEnd::send(const NewsMessage& news) {
  link_.send(Channel::News, writer_.write(news));
}

std::string DeviceEnd::refusals() const {
  std::string words;
  for (std::size_t i = 1; i < kReadings; ++i) {
    if (!isRefused(static_cast<Reading>(i))) continue;
    std::uint64_t count = 0;
    for (const MessageReader* reader : {&hello_reader_, &reply_reader_, &state_reader_, &log_reader_})
      count += reader->counts()[i];
    if (count == 0) continue;
    words += (words.empty() ? "" : ", ") + std::to_string(count) + " " + toText(static_cast<Reading>(i));
  }
  if (const std::uint64_t beats = link_.refusedBeats(); beats > 0)
    words += (words.empty() ? "" : ", ") + std::to_string(beats) + " beats that were invalid or repeated";
  return words;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The render node's driver of a loop in another process, with a scripted device node.
#include <gtest/gtest.h>

#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "haptics/haptic_driver.h"
#include "nodes/device_end.h"
#include "scenes/two_pins.h"

namespace vps::scenes {
namespace {

/// Answers each request at once, and returns the states that a test has queued, as a network might deliver
/// them.
class ScriptedDevice final : public Link {
 public:
  explicit ScriptedDevice(bool may_rearm = false) {
    HelloMessage hello;
    hello.may_rearm = may_rearm;
    replies_.emplace_back(writer_.write(hello));
  }

  void addState(std::int32_t tick, device::OperatorPhase phase, std::uint64_t faults = 0) {
    HapticMessage message;
    message.state.tick = tick;
    message.state.safety.faults = faults;
    if (faults > 0) message.state.safety.fault = device::SafetyFault::BadPose;
    message.hand = device::toByte({phase, {}});
    states_.emplace_back(writer_.write(message));
  }
  void addLogOfTick(std::int32_t tick) {
    addLog(device::SyncEvent{0, tick, 1, 0, device::SyncEventKind::Tick});
    addLog(device::WrittenWrench{});
  }
  ReplyMessage answer;  ///< to the next request
  std::optional<device::SyncEventKind> last_command;

  bool send(Channel channel, std::string_view bytes) noexcept override {
    RequestMessage request;
    if (channel != Channel::Request || reader_.read(bytes, request) != Reading::Good) return true;
    if (request.kind == RequestKind::Command) last_command = request.command;
    answer.request = reader_.envelope().number;
    replies_.emplace_back(writer_.write(answer));
    return true;
  }
  std::string_view receive(Channel channel, std::span<char> buffer) noexcept override {
    if (channel == Channel::Haptic) return take(states_, buffer);
    if (channel == Channel::Reply) return take(replies_, buffer);
    if (channel == Channel::Log) return take(log_, buffer);
    return {};
  }
  [[nodiscard]] std::uint64_t lost(Channel) const noexcept override { return 0; }
  [[nodiscard]] bool isAlive(NodeRole) const override { return true; }
  [[nodiscard]] std::size_t watchers() const override { return 0; }
  [[nodiscard]] std::uint64_t sessionId() const override { return 7; }
  [[nodiscard]] bool hasEnded() const override { return false; }
  [[nodiscard]] std::string sceneBytes() const override { return {}; }

 private:
  void addLog(const device::LogEntry& entry) {
    log_.emplace_back(writer_.write(LogMessage{log_number_++, entry}));
  }
  static std::string_view take(std::deque<std::string>& from, std::span<char> buffer) {
    if (from.empty()) return {};
    const std::size_t size = from.front().copy(buffer.data(), buffer.size());
    from.pop_front();
    return {buffer.data(), size};
  }

  MessageWriter writer_{5};
  MessageReader reader_;
  std::deque<std::string> replies_, states_, log_;
  std::uint32_t log_number_ = 0;
};

// Earlier, if the state of the tick before a command came after its reply, a recording could not be replayed,
// and a step ended before it began.
TEST(RemoteDriver, AStateFromBeforeACommandDoesNotShowWhatTheHandDoesAfterIt) {
  using device::OperatorPhase;
  ScriptedDevice device;
  DeviceEnd end(device, nullptr, [](const std::string&) {});
  ASSERT_TRUE(end.waitForDevice());
  const Scene scene = twoPins();
  const std::unique_ptr<Hand> hand = remoteHand(end, scene);
  const std::unique_ptr<HapticDriver> driver = hand->makeDriver(
      {}, 5e-3, [](const std::string&) {}, nullptr);
  driver->resume();
  device.answer.tick = 10;
  device.answer.hand = device::toByte({OperatorPhase::Insert, {}});
  driver->begin({}, 0, 0);
  EXPECT_EQ(driver->phase(), OperatorPhase::Insert);
  device.addState(9, OperatorPhase::Idle);
  device.addState(10, OperatorPhase::Done);
  ASSERT_TRUE(driver->advance());
  EXPECT_EQ(driver->phase(), OperatorPhase::Insert);
  device.addState(11, OperatorPhase::Press);
  ASSERT_TRUE(driver->advance());
  EXPECT_EQ(driver->phase(), OperatorPhase::Press);
}

/// The log entries of physics, in words.
class WrittenLog final : public device::RunLog {
 public:
  void add(const device::LogEntry& entry) noexcept override {
    if (std::holds_alternative<device::RunEvent>(entry)) order += "fault; ";
    if (const auto* event = std::get_if<device::SyncEvent>(&entry))
      if (event->kind == device::SyncEventKind::Step) order += "step " + std::to_string(event->tick) + "; ";
  }
  std::string order;
};

device::RunEvent faultIn(const std::string& words) {
  device::RunEvent event;
  event.setWords(words);
  return event;
}

// A replay reads the loop's state after it has logged the step. A run that reported the fault before the step
// was not replayed: "comes with /run/sync_event where the recording has /run/event".
TEST(RemoteDriver, AFaultIsReportedAfterTheStepThatSeesIt) {
  ScriptedDevice device;
  DeviceEnd end(device, nullptr, [](const std::string&) {});
  ASSERT_TRUE(end.waitForDevice());
  const Scene scene = twoPins();
  WrittenLog written;
  MergedLog log(written);
  const std::unique_ptr<Hand> hand = remoteHand(end, scene, &log);
  const std::unique_ptr<HapticDriver> driver = hand->makeDriver(
      {}, 5e-3, [&log](const std::string& words) { log.add(faultIn(words)); }, &log);
  driver->resume();
  device.addState(1, device::OperatorPhase::Insert);
  ASSERT_TRUE(driver->advance());
  device.addState(2, device::OperatorPhase::Insert, 1);
  for (int tick = 1; tick <= 3; ++tick) device.addLogOfTick(tick);
  ASSERT_TRUE(driver->advance());
  EXPECT_EQ(written.order, "step 1; step 2; fault; ");
}

/// The command that a faulted loop gets after others requested that it be re-armed.
std::optional<device::SyncEventKind> commandAfterRearm(bool may_rearm) {
  ScriptedDevice device(may_rearm);
  RunRequests requests;
  DeviceEnd end(
      device, nullptr, [](const std::string&) {}, &requests);
  EXPECT_TRUE(end.waitForDevice());
  const Scene scene = twoPins();
  const std::unique_ptr<Hand> hand = remoteHand(end, scene);
  const std::unique_ptr<HapticDriver> driver = hand->makeDriver(
      {}, 5e-3, [](const std::string&) {}, nullptr);
  driver->resume();
  for (int tick = 1; tick <= 2; ++tick) {
    device.addState(tick, device::OperatorPhase::Insert, 1);
    EXPECT_TRUE(driver->advance());
  }
  EXPECT_FALSE(device.last_command) << "nobody has requested it";
  requests.rearm();
  device.addState(3, device::OperatorPhase::Insert, 1);
  EXPECT_TRUE(driver->advance());
  return device.last_command;
}

// The request handler refuses the request with a reason; a device that joined in the meantime must be safe as
// well.
TEST(RemoteDriver, OnlyADeviceThatAllowsItIsRearmedForOthers) {
  EXPECT_EQ(commandAfterRearm(true), device::SyncEventKind::Rearm);
  EXPECT_EQ(commandAfterRearm(false), std::nullopt);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The two threads of a real-time run, without a scene: a handle that oscillates, a part that follows it.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>

#include "haptics/haptic_driver.h"
#include "support/device/fake_device.h"
#include "vps_device/recording.h"

namespace vps::scenes {
namespace {

constexpr double kDriverPeriod_s = 1e-3;

/// A device that oscillates by itself; only the loop's thread uses it.
class Swing final : public device::Device {
 public:
  device::DeviceSample read() noexcept override { return sample; }
  void write(const Wrench& F) noexcept override { written = F; }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 30}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "swing"; }
  device::DeviceSample sample;
  Wrench written;
};

class SwingingHand final : public Hand {
 public:
  device::Device& device() override { return swing_; }
  void prepare(const device::OperatorTask&, std::size_t step, double) override {
    next_ = static_cast<double>(step);
  }
  void begin() override { speed_ = next_; }
  void goBack(std::size_t) override { speed_ = 0; }
  void recentre() override { speed_ = -1; }
  void goOn() override { speed_ = 1; }
  void step(const device::HeldPart&, const device::HapticLoop&, double dt_s) override {
    device::DeviceSample& sample = swing_.sample;
    sample.time_s += dt_s;
    sample.V_DH.v = Vec3(0.02 * speed_ * std::cos(10 * sample.time_s), 0, 0);
    sample.X_DH.p += dt_s * sample.V_DH.v;
  }
  [[nodiscard]] device::OperatorPhase phase() const override {
    return speed_ == 0 ? device::OperatorPhase::Done : device::OperatorPhase::Reach;
  }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  Swing swing_;
  double speed_ = 0, next_ = 0;
};

/// A device that repeats the samples of a log.
class RepeatedSamples final : public Hand, public device::Device {
 public:
  explicit RepeatedSamples(const std::vector<device::LogEntry>& entries) {
    for (const device::LogEntry& entry : entries)
      if (const auto* sample = std::get_if<device::DeviceSample>(&entry)) samples_.push_back(*sample);
  }
  device::Device& device() override { return *this; }
  device::DeviceSample read() noexcept override { return samples_[next_++]; }
  void write(const Wrench&) noexcept override {}
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 30}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "repeated_samples"; }
  void prepare(const device::OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}
  void step(const device::HeldPart&, const device::HapticLoop&, double) override {}
  [[nodiscard]] device::OperatorPhase phase() const override { return device::OperatorPhase::Reach; }
  [[nodiscard]] bool canGoOn(int ticks) const override {
    return next_ + static_cast<std::size_t>(ticks) <= samples_.size();
  }

 private:
  std::vector<device::DeviceSample> samples_;
  std::size_t next_ = 0;
};

device::LoopSettings settings() {
  device::LoopSettings s;
  s.period_s = kDriverPeriod_s;
  s.extrapolates_part = true;
  s.physics_limit_s = physicsLimit_s(kDriverPeriod_s);
  return s;
}

/// A run with every command: hand-over, work, re-grasp, release and return.
/// @return the proxies that the physics thread used
std::vector<Vec3> drive(HapticDriver& driver, int steps) {
  std::vector<Vec3> seen;
  std::optional<double> stored_J;
  CouplingState part;
  part.is_coupled = true;
  const auto go = [&](int count) {
    for (int i = 0; i < count; ++i) {
      if (!driver.advance()) return;
      const CouplingState& proxy = driver.proxy();
      seen.push_back(proxy.X_W.p);
      part.X_W.p += 0.1 * (proxy.X_W.p - part.X_W.p);  // lags behind
      part.time_s = proxy.time_s;
      stored_J = 1e-3 * part.X_W.p.norm();
      driver.publish({part, 0, stored_J, {}});
    }
  };
  for (int round = 0; round < 3; ++round) {
    driver.handOver(part.X_W);
    driver.publish({part, 0, {}, {}});
    driver.resume();
    go(steps);
    driver.begin(device::OperatorTask{}, 1, 0);
    go(steps);
    driver.openClutch();
    go(steps);
    driver.recentre();
    go(steps);
    driver.closeClutch();
    go(steps);
    driver.goOn();
    go(steps);
    driver.letGo();
    driver.goBack(0);
    go(steps);
    if (round == 1) driver.pause();
    EXPECT_TRUE(driver.hasSettled(true));
  }
  driver.pause();
  return seen;
}

TEST(RealTimeDriver, ARecordedEventComesWithWhatPhysicsKnewOfTheHandThen) {
  const auto event = [](device::SyncEventKind kind) {
    device::SyncEvent e;
    e.kind = kind;
    return e;
  };
  const auto phase = [](device::OperatorPhase to) {
    device::RunEvent e;
    e.kind = device::RunEventKind::Phase;
    e.phase = device::toByte({to, device::OperatorStrategy::None});
    return e;
  };
  using enum device::SyncEventKind;
  using device::OperatorPhase;
  // Two steps without a tick between them. Entries that are logged after a tick still belong to the earlier
  // step.
  const std::vector<RecordedEvent> events =
      recordedEvents({event(Begin), phase(OperatorPhase::Reach), event(Tick), event(Step), event(Step),
                      phase(OperatorPhase::Done), event(Tick), event(Step), event(LetGo)});
  std::vector<OperatorPhase> phases;
  for (const RecordedEvent& e : events) phases.push_back(e.hand.phase);
  using enum device::OperatorPhase;
  EXPECT_EQ(phases, (std::vector{Reach, Reach, Reach, Done, Done, Done, Done}));
}

TEST(RealTimeDriver, AReplayOnOneThreadRepeatsARunOfTwoThreads) {
  test::KeptLog log;
  device::CouplingPort port, replay_port;
  SwingingHand hand;
  const ReportFault ignore = [](const std::string&) {};  // on a busy machine physics may stall
  const auto driver = makeRealTimeDriver(hand, port, settings(), 0.7e-3, ignore, &log);
  const std::vector<Vec3> seen = drive(*driver, 60);
  EXPECT_EQ(log.lost, 0u);
  EXPECT_EQ(seen.size(), 3u * 7 * 60);

  device::RecordedRun run;
  run.entries = log.entries;
  device::ReplayCheck check(run);
  RepeatedSamples recorded(run.entries);
  device::TappedDevice tapped(recorded, check);
  const auto replay = makeReplayedDriver(recorded, recordedEvents(run.entries), tapped, replay_port,
                                         settings(), ignore, check);
  EXPECT_EQ(drive(*replay, 60), seen);
  EXPECT_EQ(check.departure(), "");
  EXPECT_EQ(check.left(), 0u);
  EXPECT_EQ(driver->passivity().to_hand_J, replay->passivity().to_hand_J);
  EXPECT_EQ(driver->passivity().injected_J, replay->passivity().injected_J);
  EXPECT_GT(driver->passivity().from_hand_J, 0);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/real_time_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/device/fake_device.h"
#include "support/no_alloc.h"

namespace vps::device {
namespace {

using test::FakeClock;
using test::PlainDevice;

constexpr std::int64_t kLoopPeriod_ns = 1'000'000;

LoopSettings plainSettings(DeviceEventQueue& events) {
  LoopSettings settings;
  settings.gains.k_N_per_m = 1000;
  settings.gains.b_Ns_per_m = 0;
  settings.safety.slew_N_per_s = 2000;
  settings.events = &events;
  return settings;
}

/// A loop whose beats the test calls, on a clock of the test: the handle is 2 mm from the part.
struct Rig {
  FakeClock clock;
  PlainDevice device;
  CouplingPort port;
  DeviceEventQueue events;
  RealTimeLoop loop;
  Metronome metronome{kLoopPeriod_ns, clock};
  double physics_s = 0;

  explicit Rig(RealTimeSettings settings = {})
      : loop(device, port, plainSettings(events), onClock(settings, clock)) {
    metronome.start();
    publish();
    loop.grasp(Pose{});
    beat();
    device.sample.X_DH.p.x() = 2e-3;
  }
  static RealTimeSettings onClock(RealTimeSettings settings, FakeClock& clock) {
    settings.clock = &clock;
    return settings;
  }
  void publish() {
    physics_s += 1e-3;
    port.physics.write({{Pose{}, Twist{}, physics_s, true}, 0, {}, {}});
  }
  void beat() {
    const Beat beat = metronome.wait();
    device.sample.time_s = 1e-9 * static_cast<double>(beat.woke_ns);
    loop.beat(beat);
  }
  void run(int ticks, bool is_physics_alive = true) {
    for (int i = 0; i < ticks; ++i) {
      if (is_physics_alive) publish();
      beat();
    }
  }
  [[nodiscard]] double force_N() const { return device.F_written_D.f.norm(); }
  std::vector<DeviceEvent> heard() {
    std::vector<DeviceEvent> all;
    for (DeviceEvent event; events.pop(event);) all.push_back(event);
    return all;
  }
};

TEST(RealTimeLoop, EachBeatIsATickWithTheCouplingsForce) {
  Rig rig;
  {
    vps_test::NoAllocScope guard;
    rig.run(100);
  }
  EXPECT_NEAR(rig.device.F_written_D.f.x(), -2, 1e-12);
  EXPECT_EQ(rig.port.haptic.read().report.F_hand_D.f, rig.device.F_written_D.f);
  EXPECT_EQ(rig.loop.statistics().summary().tick.count, 101u);
  EXPECT_EQ(rig.loop.statistics().summary().missed, 0u);
}

// The force is that of 2 mm at 1000 N/m, then at 250 N/m; an excessive stiffness is refused.
TEST(RealTimeLoop, SofterGainsActFromTheNextTickAndUnusableOnesAreAFault) {
  Rig rig;
  rig.run(100);
  CouplingGains gains = plainSettings(rig.events).gains;
  gains.k_N_per_m = 250;
  {
    vps_test::NoAllocScope guard;
    EXPECT_TRUE(rig.loop.setGains(gains));
    rig.run(1);
  }
  EXPECT_NEAR(rig.device.F_written_D.f.x(), -0.5, 1e-12);
  gains.k_N_per_m = 1e9;
  rig.loop.setGains(gains);
  rig.run(1);
  EXPECT_EQ(rig.force_N(), 0);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::BadGains);
}

// The proxy holds the part at an offset of 2 mm while the handle moves; after the hand-over the offset is
// zero.
TEST(RealTimeLoop, ClutchRequestsOpenCloseAndHandOver) {
  Rig rig;
  rig.run(100);
  const int clutch_ticks = static_cast<int>(1e3 * LoopSettings{}.clutch_s) + 2;
  const auto after = [&](bool (RealTimeLoop::*ask)() noexcept) {
    vps_test::NoAllocScope guard;
    EXPECT_TRUE((rig.loop.*ask)());
    rig.run(clutch_ticks);
    return rig.port.haptic.read().report.clutch_ratio;
  };
  EXPECT_EQ(after(&RealTimeLoop::disengage), 0);
  EXPECT_EQ(rig.force_N(), 0);
  rig.device.sample.X_DH.p = Vec3(2e-3, 5e-3, 0);
  rig.run(10);
  EXPECT_EQ(after(&RealTimeLoop::engage), 1);
  EXPECT_NEAR(rig.device.F_written_D.f.x(), -2, 1e-12);
  EXPECT_NEAR(rig.device.F_written_D.f.y(), 0, 1e-12);
  EXPECT_TRUE(rig.loop.handOver(Pose{}));
  rig.run(clutch_ticks);
  EXPECT_EQ(rig.port.haptic.read().report.clutch_ratio, 1);
  EXPECT_NEAR(rig.force_N(), 0, 1e-12);
}

TEST(RealTimeLoop, PhysicsThatStallsForASecondGivesNoForceUntilRearmed) {
  Rig rig;
  rig.run(100);
  rig.run(99, false);
  EXPECT_GT(rig.force_N(), 1.9) << "the fault needs a tenth of a second";
  rig.run(901, false);
  EXPECT_EQ(rig.force_N(), 0);
  const std::vector<DeviceEvent> told = rig.heard();
  ASSERT_EQ(told.size(), 1u) << "reported once";
  EXPECT_EQ(told[0].kind, DeviceEventKind::PhysicsStalled);
  EXPECT_NEAR(told[0].value, 0.1, 2e-3);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::PhysicsStalled);

  rig.run(200);
  EXPECT_EQ(rig.force_N(), 0) << "the fault stays latched when physics continues";
  rig.loop.rearm();
  rig.run(500);
  EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::Rearmed);
  EXPECT_EQ(rig.force_N(), 0) << "the part is grasped again where it is";
  rig.device.sample.X_DH.p.x() += 1e-3;
  rig.run(1);
  EXPECT_NEAR(rig.force_N(), 1, 1e-9) << "the coupling pulls again";
}

TEST(RealTimeLoop, RearmedWhilePhysicsStillStallsItGivesNoForce) {
  Rig rig;
  rig.run(10);
  rig.run(200, false);
  rig.loop.rearm();
  rig.device.sample.X_DH.p.x() = 8e-3;
  for (int i = 0; i < 200; ++i) {
    rig.run(1, false);
    ASSERT_EQ(rig.force_N(), 0);
  }
}

TEST(RealTimeLoop, NothingHeldNeedsNoPhysics) {
  Rig rig;
  rig.loop.release();
  rig.run(1000, false);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::None);
}

TEST(RealTimeLoop, AStateWhoseTimeIsNotANumberIsNotNew) {
  Rig rig;
  for (int i = 0; i < 200; ++i) {
    rig.port.physics.write({{Pose{}, Twist{}, std::nan(""), true}, 0, {}, {}});
    rig.beat();
  }
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::PhysicsStalled);
}

TEST(RealTimeLoop, AHostClockThatGoesBackwardsIsAFaultAndBeatsContinue) {
  Rig rig;
  rig.run(10);
  rig.clock.now = 100;
  rig.run(1);
  EXPECT_EQ(rig.force_N(), 0);
  EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::ClockBackwards);
  rig.loop.rearm();
  rig.run(300);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::None);
}

TEST(RealTimeLoop, ADeviceThatIsLostGivesNoForceUntilItIsBackAndRearmed) {
  Rig rig;
  rig.run(10);
  rig.device.sample.status = Status::Fault;
  rig.run(1);
  EXPECT_EQ(rig.force_N(), 0);
  EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::DeviceLost);
  rig.loop.rearm();
  rig.run(5);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::DeviceLost) << "the device is still lost";
  rig.device.sample.status = Status::Ok;
  rig.run(5);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::DeviceLost) << "latched";
  rig.loop.rearm();
  rig.run(5);
  EXPECT_EQ(rig.port.haptic.read().safety.fault, SafetyFault::None);
}

TEST(RealTimeLoop, ASlowDeviceIsNamedAsTheCauseOfMissesAndOfTheWorst) {
  static FakeClock* clock = nullptr;
  Rig rig;
  clock = &rig.clock;
  rig.run(50);
  rig.device.on_read = [](PlainDevice&) { clock->now += 2'500'000; };
  rig.run(1);
  rig.device.on_read = nullptr;
  rig.run(50);
  const TickStatistics::Summary all = rig.loop.statistics().summary();
  EXPECT_EQ(all.missed, 2u);
  EXPECT_EQ(all.missed_by[static_cast<int>(TickCause::Device)], 2u);
  EXPECT_EQ(all.worst.cause(), TickCause::Device);
  EXPECT_EQ(all.worst.device_ns, 2'500'000);
  EXPECT_EQ(all.worst.tick, 52u);
  EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::TicksMissed);
}

TEST(RealTimeLoop, WorkAfterTheTickAndALateWakeUpAreNamedAsCauses) {
  static FakeClock* clock = nullptr;
  static int count = 0;
  count = 0;
  RealTimeSettings settings;
  settings.after_tick = [](HapticLoop&, double) {
    if (++count == 20) clock->now += 1'200'000;
  };
  Rig* rig = nullptr;
  FakeClock unused;
  clock = &unused;
  Rig made(settings);
  rig = &made;
  clock = &rig->clock;
  rig->run(40);
  rig->clock.oversleep = 3'400'000;
  rig->run(1);
  rig->clock.oversleep = 0;
  rig->run(10);
  const TickStatistics::Summary all = rig->loop.statistics().summary();
  EXPECT_EQ(all.missed_by[static_cast<int>(TickCause::AfterTick)], 1u);
  EXPECT_EQ(all.missed_by[static_cast<int>(TickCause::WokenLate)], 3u);
  EXPECT_EQ(all.missed, 4u);
  EXPECT_EQ(all.worst.cause(), TickCause::WokenLate);
}

TEST(RealTimeLoop, AfterAPauseTheForceGrowsNoFasterThanInFourPeriods) {
  Rig rig;
  rig.run(10);
  rig.device.sample.X_DH.p.x() = 2e-3 + 19e-3;  // 21 N, within the accepted jump
  rig.clock.now += 50'000'000;                  // a pause of 50 ms
  rig.run(1);
  EXPECT_NEAR(rig.force_N(), 2 + 4 * 2000 * 1e-3, 1e-9);
  rig.device.sample.X_DH.p.x() = 2e-3;
  rig.run(10);
  EXPECT_NEAR(rig.force_N(), 2, 1e-9);
}

TEST(RealTimeLoop, OldPhysicsStatesAreCounted) {
  Rig rig;
  const std::uint64_t before = rig.loop.statistics().summary().stale;
  rig.run(10);
  rig.run(10, false);
  rig.run(10);
  EXPECT_EQ(rig.loop.statistics().summary().stale - before, 8u) << "older than 2 ms";
}

TEST(RealTimeLoop, CallsAreCarriedOutInOrderBeforeTheNextTickAndAcknowledged) {
  std::vector<std::int32_t> codes;
  codes.reserve(4);
  RealTimeSettings settings;
  settings.on_call = [&](HapticLoop& loop, std::int32_t code) {
    codes.push_back(code);
    if (code == 7) loop.release();
  };
  Rig rig(settings);
  rig.run(2);
  EXPECT_TRUE(rig.loop.call(7));
  EXPECT_TRUE(rig.loop.call(8));
  EXPECT_TRUE(rig.loop.hasOpenRequests());
  EXPECT_TRUE(codes.empty());
  rig.run(1);
  EXPECT_FALSE(rig.loop.hasOpenRequests());
  EXPECT_EQ(codes, (std::vector<std::int32_t>{7, 8}));
  EXPECT_FALSE(rig.port.haptic.read().proxy.is_coupled) << "released before the tick";
  rig.loop.call(9);
  rig.loop.handleRequests();  // as a driver does while the loop is stopped
  EXPECT_FALSE(rig.loop.hasOpenRequests());
  EXPECT_EQ(codes.back(), 9);
}

TEST(RealTimeLoop, RequestsToAFullRingAreRefusedNotLost) {
  Rig rig;
  int taken = 0;
  while (rig.loop.release()) ++taken;
  EXPECT_EQ(taken, 64);
  rig.beat();
  EXPECT_FALSE(rig.loop.loop().isHolding());
  EXPECT_TRUE(rig.loop.grasp(Pose{}));
  rig.run(2);
  EXPECT_TRUE(rig.loop.loop().isHolding());
}

TEST(RealTimeLoop, WithTwoThreadsForceStaysFiniteAndIsZeroAfterStop) {
  // For the thread sanitizer: haptic thread, physics thread and a reader of events, concurrently.
  PlainDevice device;
  CouplingPort port;
  DeviceEventQueue events;
  LoopSettings settings = plainSettings(events);
  settings.period_s = 0.25e-3;
  std::atomic<double> strongest_N{0};
  RealTimeSettings real_time;
  real_time.locks_memory = false;
  real_time.physics_limit_s = 10;  // a busy machine is no fault here
  real_time.after_tick = [&](HapticLoop& loop, double dt_s) {
    strongest_N.store(std::max(strongest_N.load(), loop.last().F_hand_D.f.norm()));
    device.sample.time_s += dt_s;
    device.sample.X_DH.p.x() = 1e-3 * std::sin(20 * device.sample.time_s);
  };
  RealTimeLoop loop(device, port, settings, real_time);
  PeriodicThread physics({.rate_hz = 1000});
  double physics_s = 0;
  std::int32_t step = 0;
  port.physics.write({{Pose{}, Twist{}, 0, true}, 0, {}, {}});
  loop.start();
  loop.grasp(Pose{});
  physics.start([&](const Beat& beat) {
    const HapticState& haptic = port.haptic.read();
    EXPECT_TRUE(haptic.report.F_hand_D.isFinite());
    const CouplingState& proxy = haptic.proxy;
    physics_s += 1e-3 * static_cast<double>(beat.periods);
    CouplingState part{proxy.X_W, proxy.V_W, physics_s, true};
    part.X_W.p.x() *= 0.5;
    port.physics.write({part, ++step, 0.0, {}});
  });
  DeviceEvent event;
  while (loop.statistics().summary().tick.count < 400) {
    while (events.pop(event)) EXPECT_NE(severityOf(event.kind), Severity::Fault) << toText(event.kind);
  }
  loop.stop();
  physics.stop();
  EXPECT_TRUE(loop.loop().isHolding());
  EXPECT_GT(strongest_N.load(), 0);
  EXPECT_EQ(device.F_written_D.f.norm(), 0) << "stopped: no force";
}

}  // namespace
}  // namespace vps::device

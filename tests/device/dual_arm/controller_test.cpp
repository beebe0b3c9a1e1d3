// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "support/device/hostile_arm.h"
#include "support/no_alloc.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

constexpr double kDt_s = 1e-3;

HandForce stillHand() {
  return vps_test::firmHand(500, 30);
}

void expect(bool claim, const char* promise) {
  EXPECT_TRUE(claim) << promise;
}

// A controller on hardware that can simulate faults.
struct Rig {
  explicit Rig(const DualArmControllerSettings& settings = {}) : controller(hardware, settings, &events) {}
  DualArmPlant plant;
  vps_test::HostileArm hardware{plant, expect};
  DeviceEventQueue events;
  DualArmController controller;
  HandForce hand = stillHand();

  DeviceSample tick(const Wrench& F = {}) {
    const DeviceSample sample = controller.read();
    controller.write(F);
    plant.step(kDt_s, hand);
    return sample;
  }
  std::vector<DeviceEvent> heard() {
    std::vector<DeviceEvent> list;
    for (DeviceEvent event; events.pop(event);) list.push_back(event);
    return list;
  }
};

TEST(DualArmController, EachFaultIsNamedSwitchesTheMotorsOffAndIsClearedByRearm) {
  using Hostile = vps_test::HostileArm;
  struct Case {
    Hostile::Trouble trouble;
    unsigned detail;
    DeviceEventKind kind;
    int ticks;
  };
  const Case cases[] = {
      {Hostile::kNan, 2, DeviceEventKind::BadEncoder, 1},
      {Hostile::kNan, 3, DeviceEventKind::BadEncoder, 1},
      {Hostile::kHuge, 2, DeviceEventKind::EncoderJump, 1},
      {Hostile::kJump, 21, DeviceEventKind::EncoderJump,
       1},  // the plate jumps by 40 mrad, which is 30 mm at 0.75 m
      {Hostile::kApart, 7, DeviceEventKind::PulledApart,
       1},  // 20 mm are not yet a jump, but the distance of the arms' ends is no longer L
      {Hostile::kLeftLost, 0, DeviceEventKind::LeftArmLost, 1},
      {Hostile::kRightLost, 0, DeviceEventKind::RightArmLost, 1},
      {Hostile::kClockBack, 5, DeviceEventKind::ClockBackwards, 1},
      {Hostile::kClockNan, 0, DeviceEventKind::BadEncoder, 1},
      {Hostile::kSilent, 0, DeviceEventKind::Silent, 22},  // after the watchdog's 20 ms and one tick
  };
  const Wrench wanted{Vec3(0.1, 0, 0), Vec3(1, 2, 3)};
  for (const Case& c : cases) {
    Rig rig;
    for (int i = 0; i < 50; ++i) ASSERT_EQ(rig.tick(wanted).status, Status::Ok);
    EXPECT_TRUE(rig.heard().empty());
    rig.hardware.set(c.trouble, c.detail);
    for (int i = 0; i < c.ticks; ++i) rig.tick(wanted);
    EXPECT_TRUE(rig.controller.hasFault()) << toText(c.kind);
    EXPECT_EQ(rig.controller.fault(), c.kind)
        << toText(c.kind) << " against " << toText(rig.controller.fault());
    const std::vector<DeviceEvent> events = rig.heard();
    ASSERT_EQ(events.size(), 1u) << toText(c.kind);
    EXPECT_EQ(events[0].kind, c.kind);
    EXPECT_EQ(severityOf(events[0].kind), Severity::Fault);
    rig.hardware.set(Hostile::kNone, 0);
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(rig.tick(wanted).status, Status::Fault) << "latched";
      EXPECT_TRUE(rig.controller.efforts().isZero());
    }
    rig.controller.rearm();
    EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::Rearmed);
    EXPECT_EQ(rig.tick(wanted).status, Status::Ok) << toText(c.kind);
    EXPECT_GT(rig.controller.efforts().norm(), 0.5);
  }
}

TEST(DualArmController, ALostPeerLeavesOnlyTheHandlesWeightCarried) {
  Rig rig;
  const Wrench wanted{Vec3::Zero(), Vec3(0, 5, 0)};
  for (int i = 0; i < 50; ++i) rig.tick(wanted);
  // The peer process hangs: no wrench is written, while the controller is still read.
  for (int i = 0; i < 25; ++i) {
    rig.controller.read();
    rig.plant.step(kDt_s, rig.hand);
  }
  EXPECT_TRUE(rig.controller.hasFault());
  EXPECT_EQ(rig.controller.fault(), DeviceEventKind::PeerLost);
  rig.tick(wanted);
  Wrench F;
  ASSERT_EQ(handleWrench(rig.plant.settings().arms, rig.plant.pose(), rig.controller.efforts(), F),
            Status::Ok);
  EXPECT_NEAR(F.f.z(), 9.81 * 0.2,
              2e-3);  // the handle's weight, at a pose that is off by 1 mm in arms of 0.75 m
  EXPECT_LT(F.f.head<2>().norm(), 5e-3);
  rig.controller.rearm();
  rig.tick(wanted);
  ASSERT_EQ(handleWrench(rig.plant.settings().arms, rig.plant.pose(), rig.controller.efforts(), F),
            Status::Ok);
  EXPECT_NEAR(F.f.y(), 5, 0.02);
}

TEST(DualArmController, SharpMotionSwitchesTheMotorsOff) {
  Rig rig;
  for (int i = 0; i < 10; ++i) rig.tick();
  rig.hand = {};
  rig.hand.F.f = Vec3(0, 0, 40);  // 40 N accelerate 0.8 kg to 3 m/s in 60 ms
  int ticks = 0;
  while (!rig.controller.hasFault() && ticks < 200) {
    rig.tick({Vec3::Zero(), Vec3(0, 0, 5)});
    ++ticks;
  }
  EXPECT_EQ(rig.controller.fault(), DeviceEventKind::SharpMotion);
  EXPECT_GT(rig.plant.twist().v.norm(), 2.5);
  EXPECT_LT(rig.plant.twist().v.norm(), 3.5);  // the filter lags by 2 ms at an acceleration of 50 m/s^2
  EXPECT_TRUE(rig.controller.efforts().isZero());
}

TEST(DualArmController, SaturationKeepsTheWrenchsDirectionAndCarriesTheHandle) {
  Rig rig;
  rig.hand.k_N_per_m *= 10;  // a hand so stiff that 100 N do not move the handle far
  rig.hand.k_Nm_per_rad *= 10;
  rig.tick();
  const DualArmParameters& p = rig.plant.settings().arms;
  Random random(3);
  int saturated = 0;
  for (int i = 0; i < 500; ++i) {
    const Wrench wanted{2 * random.normal3(), 40 * random.normal3()};
    const DeviceSample sample = rig.tick(wanted);
    Wrench F;
    ASSERT_EQ(handleWrench(p, sample.X_DH, rig.controller.efforts(), F), Status::Ok);
    F.f.z() -= 9.81 * p.handle_kg;
    const double share = F.f.dot(wanted.f) / wanted.f.squaredNorm();
    EXPECT_LT((F.f - share * wanted.f).norm(), 1e-9);
    EXPECT_LT((F.tau - share * wanted.tau).norm(), 1e-9);
    EXPECT_LE(share, 1 + 1e-12);
    saturated += share < 0.999 ? 1 : 0;
  }
  EXPECT_GT(saturated, 300);
}

TEST(DualArmController, IncrementalEncodersGiveNoForceUntilCalibratedInTheCradle) {
  DualArmControllerSettings settings;
  settings.needs_calibration = true;
  Rig rig(settings);
  const Wrench wanted{Vec3::Zero(), Vec3(3, 0, 0)};
  EXPECT_EQ(rig.heard().at(0).kind, DeviceEventKind::NotCalibrated);
  EXPECT_EQ(rig.tick(wanted).status, Status::Fault);
  EXPECT_TRUE(rig.controller.efforts().isZero());
  rig.controller.rearm();
  EXPECT_EQ(rig.tick(wanted).status, Status::Fault) << "re-arming does not calibrate";

  // The encoders count from the position at which they were switched on.
  rig.hardware.set(vps_test::HostileArm::kDrift, 4);
  for (int i = 0; i < 100; ++i) rig.controller.read();  // each joint is then read 40 mrad or 40 mm off
  rig.hardware.set(vps_test::HostileArm::kNone, 0);
  EXPECT_EQ(rig.controller.calibrate(Pose::translation(Vec3(0, 5, 0))), Status::Ok) << "any pose has joints";
  const Pose cradle(rotationFromVector(Vec3(0.1, 0, -0.2)), Vec3(0.02, -0.03, 0.01));
  DualArmPlantSettings bare;
  rig.plant.moveTo(cradle);
  // In the cradle the motors are off and nothing deflects, so the test waits for the plant's watchdog.
  rig.hand.X_eq = cradle;
  rig.hand.k_N_per_m = 1e6 * Mat3::Identity();
  rig.hand.k_Nm_per_rad = 1e4 * Mat3::Identity();
  for (int i = 0; i < 300; ++i) rig.plant.step(kDt_s, rig.hand);
  ASSERT_EQ(rig.controller.calibrate(cradle), Status::Ok);
  const DeviceSample sample = rig.controller.read();
  ASSERT_EQ(sample.status, Status::Ok);
  // The error is that of a reading, and the deflection of 0.14 mm, which the controller subtracts although
  // the motors carry no weight here.
  EXPECT_LT((sample.X_DH.p - cradle.p).norm(), 0.25e-3);
  EXPECT_EQ(rig.controller.calibrate(Pose::translation(Vec3(NAN, 0, 0))), Status::BadPose);
  rig.hardware.set(vps_test::HostileArm::kNan, 0);
  EXPECT_EQ(rig.controller.calibrate(cradle), Status::Fault);
}

TEST(DualArmController, WarnsOnceOfStopsHeatSaturationAndBadWrenches) {
  Rig rig;
  const auto kinds = [&] {
    std::string out;
    for (const DeviceEvent& event : rig.heard()) {
      EXPECT_EQ(severityOf(event.kind), Severity::Warning) << toText(event.kind);
      out += std::string(toText(event.kind)) + "; ";
    }
    return out;
  };
  for (int i = 0; i < 5; ++i) rig.tick({Vec3::Zero(), Vec3(NAN, 0, 0)});
  EXPECT_EQ(kinds(), "the commanded force is not a number and counts as zero; ");
  for (int i = 0; i < 5; ++i) rig.tick({Vec3::Zero(), Vec3(50, 0, 0)});
  EXPECT_EQ(kinds(), "the commanded force exceeds the motors' limits; ");
  rig.tick();
  for (int i = 0; i < 5; ++i) rig.tick({Vec3::Zero(), Vec3(50, 0, 0)});
  EXPECT_EQ(kinds(), "the commanded force exceeds the motors' limits; ") << "a second warning";
  rig.hand.k_N_per_m *= 4;
  for (int i = 0; i < 8000; ++i) rig.tick({Vec3::Zero(), Vec3(20, 20, 0)});
  EXPECT_NE(kinds().find("a motor is hot: the peak force decreases"), std::string::npos);
  rig.hand.X_eq.p = Vec3(0, 0.35, 0);
  for (int i = 0; i < 1000; ++i) {
    rig.hand.X_eq.p.y() = 0.35 * i / 1000.0;
    rig.tick();
  }
  EXPECT_NE(kinds().find("an arm is near its end"), std::string::npos);
}

TEST(DeviceEvents, EachHasTextAndSoundAndAFullQueueKeepsTheOldest) {
  for (int i = 0; i <= static_cast<int>(DeviceEventKind::Rearmed); ++i) {
    const auto kind = static_cast<DeviceEventKind>(i);
    EXPECT_STRNE(toText(kind), "unknown") << i;
    const Severity severity = severityOf(kind);
    EXPECT_EQ(beepOf(kind).count, severity == Severity::Fault ? 3 : severity == Severity::Warning ? 1 : 0);
    EXPECT_EQ(std::string(remedyOf(kind)).empty(), severity == Severity::Notice) << i;
  }
  DeviceEventQueue queue;
  for (int i = 0; i < 300; ++i) queue.push({i * 1.0, DeviceEventKind::Saturated, 0});
  EXPECT_EQ(queue.lost(), 300 - DeviceEventQueue::kCapacity);
  DeviceEvent event;
  for (std::size_t i = 0; i < DeviceEventQueue::kCapacity; ++i) {
    ASSERT_TRUE(queue.pop(event));
    EXPECT_EQ(event.time_s, static_cast<double>(i));
  }
  EXPECT_FALSE(queue.pop(event));
}

TEST(DeviceEvents, PassFromOneThreadToAnotherInOrder) {
  DeviceEventQueue queue;
  constexpr int kCount = 20000;
  std::thread haptic([&] {
    for (int i = 0; i < kCount; ++i)
      while (!queue.push({i * 1.0, DeviceEventKind::Saturated, i * 2.0})) std::this_thread::yield();
  });
  for (int i = 0; i < kCount;) {
    DeviceEvent event;
    if (!queue.pop(event)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(event.time_s, static_cast<double>(i));
    ASSERT_EQ(event.value, i * 2.0);
    ++i;
  }
  haptic.join();
}

TEST(DualArmController, ReadsAndWritesWithoutAllocating) {
  Rig rig;
  rig.tick();
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 100; ++i) rig.tick({Vec3::Zero(), Vec3(1, 50, 3)});
  rig.hardware.set(vps_test::HostileArm::kNan, 1);
  rig.tick();
  rig.controller.rearm();
}

// Thousands of byte sequences from a fixed seed, which select faults of hardware, physics and operator.
TEST(DualArmController, NoHostileSequenceCausesAForceAboveTheLimitOrAPermanentFault) {
  Random random(20);
  int faulted = 0, recovered = 0;
  double strongest_N = 0;
#ifdef VPS_ASSERT_ON
  constexpr int kSequences = 600;  // Debug and sanitized builds are many times slower; fuzz_device tries more
#else
  constexpr int kSequences = 3000;
#endif
  for (int run = 0; run < kSequences && !::testing::Test::HasFailure(); ++run) {
    std::vector<std::uint8_t> bytes(2 + 2 * (random.next() % 60));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    const vps_test::HostileRun result = vps_test::runHostile(bytes.data(), bytes.size(), expect);
    faulted += result.has_faulted ? 1 : 0;
    recovered += result.has_faulted && result.has_recovered ? 1 : 0;
    strongest_N = std::max(strongest_N, result.strongest_N);
  }
  RecordProperty("faulted", faulted);
  RecordProperty("recovered", recovered);
  RecordProperty("strongest_N", std::to_string(strongest_N));
  EXPECT_GT(faulted, kSequences / 2);
  EXPECT_GT(recovered, kSequences / 4);
  EXPECT_GT(strongest_N, 25) << "forces near the limit were tried";
}

}  // namespace
}  // namespace vps::device

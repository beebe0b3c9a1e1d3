// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vps_device/random.h"

namespace vps::device {
namespace {

constexpr double kDt_s = 1e-3;

Wrench settled(SafetyGuard& guard, const DeviceSample& sample, const Wrench& wanted) {
  Wrench F;
  for (int i = 0; i < 500; ++i) F = guard.guard(sample, wanted, kDt_s);
  return F;
}

TEST(SafetyGuard, PassesASmallWrenchUnchanged) {
  SafetyGuard guard;
  const Wrench wanted{Vec3(0.1, 0.2, -0.3), Vec3(1, -2, 3)};
  const Wrench F = settled(guard, {}, wanted);
  EXPECT_EQ(F.f, wanted.f);
  EXPECT_EQ(F.tau, wanted.tau);
  EXPECT_EQ(guard.state().limited, 0u);
}

TEST(SafetyGuard, ScalesForceAndTorqueTogetherKeepingDirection) {
  SafetyGuard guard;
  const Wrench F = settled(guard, {}, {Vec3(0, 1, 0), Vec3(300, 0, 400)});
  EXPECT_NEAR(F.f.x(), 18, 1e-9);
  EXPECT_NEAR(F.f.z(), 24, 1e-9);
  EXPECT_NEAR(F.tau.y(), 0.06, 1e-9);
  EXPECT_GT(guard.state().limited, 0u);
}

TEST(SafetyGuard, LimitsTheRateOfChangeOfTheForce) {
  const SafetyLimits limits;
  SafetyGuard guard(limits);
  settled(guard, {}, {Vec3::Zero(), Vec3(25, 0, 0)});
  const Wrench F = guard.guard({}, {Vec3::Zero(), Vec3(-25, 0, 0)}, kDt_s);
  EXPECT_NEAR(F.f.x(), 25 - limits.slew_N_per_s * kDt_s, 1e-9);
}

TEST(SafetyGuard, AFaultIsLatchedUntilRearmAndForceReturnsSlowly) {
  SafetyGuard guard;
  const Wrench wanted{Vec3::Zero(), Vec3(10, 0, 0)};
  settled(guard, {}, wanted);
  EXPECT_EQ(guard.guard({}, {Vec3::Zero(), Vec3(NAN, 0, 0)}, kDt_s).f, Vec3(Vec3::Zero()));
  EXPECT_EQ(guard.state().fault, SafetyFault::BadWrench);
  EXPECT_EQ(guard.guard({}, wanted, kDt_s).f, Vec3(Vec3::Zero()));
  guard.rearm();
  EXPECT_LT(guard.guard({}, wanted, kDt_s).f.norm(), 0.1);
  EXPECT_NEAR(settled(guard, {}, wanted).f.x(), 10, 1e-12);
  EXPECT_EQ(guard.state().faults, 1u);
}

TEST(SafetyGuard, DetectsJumpsLostDevicesAndBadPoses) {
  SafetyGuard guard;
  DeviceSample sample;
  settled(guard, sample, {});
  sample.X_DH.p = Vec3(0.05, 0, 0);
  guard.guard(sample, {}, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::Jump);
  guard.rearm();
  guard.guard(sample, {}, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::None) << "after re-arming the first pose may be anywhere";
  sample.status = Status::Fault;
  guard.guard(sample, {}, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::DeviceLost);
  guard.rearm();
  sample.status = Status::Ok;
  sample.X_DH.R(0, 0) = 2;
  guard.guard(sample, {}, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::BadPose);
}

TEST(SafetyGuard, DetectsAClockThatGoesBackwards) {
  SafetyGuard guard;
  DeviceSample sample;
  sample.time_s = 1;
  const Wrench wanted{Vec3::Zero(), Vec3(1, 0, 0)};
  EXPECT_GT(guard.guard(sample, wanted, kDt_s).f.norm(), 0);
  EXPECT_GT(guard.guard(sample, wanted, kDt_s).f.norm(), 0) << "an unchanged time is no fault";
  sample.time_s = 0.999;
  EXPECT_EQ(guard.guard(sample, wanted, kDt_s).f, Vec3(Vec3::Zero()));
  EXPECT_EQ(guard.state().fault, SafetyFault::ClockBackwards);
  guard.rearm();
  guard.guard(sample, wanted, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::None);
  sample.time_s = NAN;
  guard.guard(sample, wanted, kDt_s);
  EXPECT_EQ(guard.state().fault, SafetyFault::BadPose);
}

TEST(SafetyGuard, NothingEverExceedsTheLimits) {
  const SafetyLimits limits;
  SafetyGuard guard(limits);
  Random random(1);
  const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, std::numeric_limits<double>::denorm_min(),
                        0,   1e6};
  const auto value = [&] { return random.uniform() < 0.02 ? odd[random.next() % 8] : 40 * random.normal(); };
  for (int i = 0; i < 200000; ++i) {
    DeviceSample sample;
    sample.X_DH.p = 1e-3 * random.normal3();
    if (random.uniform() < 0.01) sample.X_DH.p[static_cast<int>(random.next() % 3)] = value();
    if (random.uniform() < 0.01) sample.V_DH.w[0] = value();
    if (random.uniform() < 0.01) sample.X_DH.R(1, 1) = value();
    if (random.uniform() < 0.01) sample.status = Status::Fault;
    Wrench wanted;
    for (int k = 0; k < 3; ++k) {
      wanted.f[k] = value();
      wanted.tau[k] = value();
    }
    const Wrench F = guard.guard(sample, wanted, random.uniform() < 0.01 ? value() : kDt_s);
    ASSERT_TRUE(F.isFinite());
    ASSERT_LE(F.f.norm(), limits.force_N * (1 + 1e-12));
    ASSERT_LE(F.tau.norm(), limits.torque_Nm * (1 + 1e-12));
    if (random.uniform() < 0.3) guard.rearm();
  }
  EXPECT_GT(guard.state().faults, 1000u);
}

}  // namespace
}  // namespace vps::device

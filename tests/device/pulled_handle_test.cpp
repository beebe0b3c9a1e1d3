// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/pulled_handle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/no_alloc.h"

namespace vps::device {
namespace {

constexpr double kTick_s = 1e-3;

/// Steps for some seconds at 1 kHz.
DeviceSample pulled(PulledHandle& handle, const Pose& wish, const Wrench& F, double seconds,
                    double t0_s = 0) {
  DeviceSample sample;
  for (int i = 0; i <= std::lround(seconds / kTick_s); ++i) sample = handle.step(wish, F, t0_s + kTick_s * i);
  return sample;
}

TEST(PulledHandle, FollowsItsWishWithTheTimeConstantOfSpringAndDamper) {
  const PulledHandleSettings s;
  PulledHandle handle;
  const double way_m = 1e-3;  // 3 N: below the limit
  const DeviceSample sample = pulled(handle, Pose::translation({way_m, 0, 0}), {}, 0.02);
  // With backward Euler the remaining distance shrinks by 1 / (1 + k dt / b) per tick.
  const double rest_m = way_m * std::pow(1 + s.k_N_per_m * kTick_s / s.b_Ns_per_m, -20);
  EXPECT_NEAR(sample.X_DH.p.x(), way_m - rest_m, 20 * 1e-18);
  EXPECT_EQ(sample.X_DH.p.y(), 0);
}

TEST(PulledHandle, IsPulledWithItsGreatestForceAtMost) {
  const PulledHandleSettings s;
  PulledHandle handle;
  const DeviceSample sample = pulled(handle, Pose::translation({0, 10, 0}), {}, 0.1);
  EXPECT_NEAR(sample.V_DH.v.y(), s.force_N / s.b_Ns_per_m, 1e-12);
  PulledHandle held;
  const Wrench against{Vec3::Zero(), Vec3(0, -s.force_N, 0)};
  EXPECT_NEAR(pulled(held, Pose::translation({0, 10, 0}), against, 1).X_DH.p.norm(), 0, 1e-15)
      << "a force as great as the pull stops it";
}

TEST(PulledHandle, ComesToRestWhereTheForceStretchesTheSpring) {
  const PulledHandleSettings s;
  PulledHandle handle;
  const DeviceSample sample = pulled(handle, {}, {Vec3(0, 0.5, 0), Vec3(0, 0, -6)}, 1);
  EXPECT_NEAR(sample.X_DH.p.z(), -6 / s.k_N_per_m, 1e-12);
  EXPECT_NEAR(rotationVector(sample.X_DH.R).y(), 0.5 / s.k_Nm_per_rad, 1e-12);
}

TEST(PulledHandle, TurnsToItsWishAndStaysARotation) {
  PulledHandle handle;
  const Pose wish(rotationFromVector(Vec3(0.3, -2, 0.4)), Vec3::Zero());
  const DeviceSample sample = pulled(handle, wish, {}, 5);
  EXPECT_LT((sample.X_DH.R - wish.R).norm(), 1e-12);
  EXPECT_LT((sample.X_DH.R.transpose() * sample.X_DH.R - Mat3::Identity()).norm(), 1e-14);
}

TEST(PulledHandle, HasNoMotionWithoutTimeAndNoJumpAfterAGap) {
  const PulledHandleSettings s;
  PulledHandle handle;
  const Pose wish = Pose::translation({1, 0, 0});
  EXPECT_EQ(handle.step(wish, {}, 5).X_DH.p.norm(), 0) << "the first call only sets the clock";
  EXPECT_EQ(handle.step(wish, {}, 5).X_DH.p.norm(), 0);
  EXPECT_EQ(handle.step(wish, {}, 4).X_DH.p.norm(), 0);
  EXPECT_LE(handle.step(wish, {}, 1000).X_DH.p.x(), 0.02 * s.force_N / s.b_Ns_per_m + 1e-15);
}

TEST(PulledHandle, TakesWhatIsNotFiniteAsNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PulledHandle handle;
  handle.step({}, {}, 0);
  EXPECT_TRUE(handle.step(Pose::translation({nan, 0, 0}), {}, 1e-3).X_DH.isFinite());
  EXPECT_TRUE(handle.step({}, {Vec3::Zero(), Vec3(nan, 0, 0)}, 2e-3).X_DH.isFinite());
  EXPECT_TRUE(handle.step({}, {}, nan).X_DH.isFinite());
}

TEST(Mouse, ReadsTheWishWithoutAllocating) {
  const auto wish = std::make_shared<HandleWish>();
  const std::unique_ptr<Device> mouse = openMouse(wish);
  mouse->read();
  wish->write(Pose::translation({1e-3, 0, 0}));
  const vps_test::NoAllocScope scope;
  DeviceSample sample;
  for (int i = 0; i < 1000000 && sample.X_DH.p.x() < 0.9e-3; ++i) sample = mouse->read();
  EXPECT_GE(sample.X_DH.p.x(), 0.9e-3);
  EXPECT_EQ(sample.status, Status::Ok);
}

}  // namespace
}  // namespace vps::device

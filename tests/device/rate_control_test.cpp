// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/rate_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/no_alloc.h"

namespace vps::device {
namespace {

/// Steps for some seconds at 1 kHz from time t0_s; returns the last sample.
DeviceSample held(RateControl& control, const Deflection& deflection, double seconds, double t0_s = 0) {
  DeviceSample sample;
  const int ticks = static_cast<int>(std::lround(1000 * seconds));
  for (int i = 0; i <= ticks; ++i) sample = control.step(deflection, t0_s + 1e-3 * i);
  return sample;
}

Deflection pushed(double x, double y, double z) {
  Deflection d;
  d.push = Vec3(x, y, z);
  return d;
}

TEST(RateShare, IsZeroInTheDeadZoneContinuousAtItsEdgeAndOneAtTheEnd) {
  const RateSettings settings;
  EXPECT_EQ(rateShare(0.1, settings), 0);
  EXPECT_EQ(rateShare(-0.1, settings), 0);
  EXPECT_LT(rateShare(0.1 + 1e-6, settings), 1e-11);  // (1e-6 / 0.9)^2
  EXPECT_EQ(rateShare(1, settings), 1);
  EXPECT_EQ(rateShare(-7, settings), -1);
  EXPECT_EQ(rateShare(std::nan(""), settings), 0);
  // The deflection is half way from the edge to the end, and the share is its square.
  EXPECT_DOUBLE_EQ(rateShare(0.55, settings), 0.25);
}

TEST(RateControl, FullDeflectionMovesAtFullSpeedAndStopsOnRelease) {
  RateControl control;
  const DeviceSample moved = held(control, pushed(0, 1, 0), 2);
  EXPECT_NEAR(moved.X_DH.p.y(), 0.08 * 2, 2000 * 1e-17);  // the error is one rounding of 0.1 per tick
  EXPECT_NEAR(moved.V_DH.v.y(), 0.08, 1e-12);
  const DeviceSample still = held(control, pushed(0.05, -0.05, 0), 1, 2);
  EXPECT_EQ(still.X_DH.p, moved.X_DH.p);
  EXPECT_EQ(still.V_DH.v, Vec3(Vec3::Zero()));
}

TEST(RateControl, LongTurnsStayRotations) {
  RateControl control;
  Deflection d;
  d.turn = Vec3(0, 0, 1);
  const DeviceSample sample = held(control, d, 100);
  EXPECT_LT((sample.X_DH.R.transpose() * sample.X_DH.R - Mat3::Identity()).norm(), 1e-14);
  const Mat3 R = rotationFromVector(Vec3(0, 0, 0.8 * 100));
  EXPECT_LT((sample.X_DH.R - R).norm(), 1e5 * 1e-15);  // in each of 1e5 ticks, a few roundings of 1e-16
}

TEST(RateControl, TheHandleStaysInTheWorkspaceAndItsVelocityIsThatOfItsMotion) {
  RateControl control;
  const DeviceSample sample = held(control, pushed(1, 1, -1), 20);
  EXPECT_EQ(sample.X_DH.p, Vec3(0.2, 0.3, -0.2));
  EXPECT_EQ(sample.V_DH.v, Vec3(Vec3::Zero()));
}

TEST(RateControl, RecentringReturnsWithoutAJumpAndStopsInTheMiddle) {
  RateControl control;
  Deflection d = pushed(1, 0, 1);
  d.turn = Vec3(1, 0, 0);
  Vec3 last = held(control, d, 2).X_DH.p;
  d.is_recentring = true;
  DeviceSample sample;
  for (int i = 1; i <= 2000; ++i) {
    sample = control.step(d, 2 + 1e-3 * i);
    ASSERT_LE((sample.X_DH.p - last).norm(), 0.2e-3 * (1 + 1e-12));
    last = sample.X_DH.p;
  }
  EXPECT_LT(sample.X_DH.p.norm(), 1e-15);
  EXPECT_LT(rotationVector(sample.X_DH.R).norm(), 1e-12);
  EXPECT_LT(sample.V_DH.v.norm(), 1e-12);
}

TEST(RateControl, ALateReaderSeesNoJumpAndAClockThatGoesBackMovesNothing) {
  RateControl control;
  held(control, pushed(0, 0, 1), 0.1);
  const double before_m = control.step(pushed(0, 0, 1), 0.1).X_DH.p.z();
  const double after_m = control.step(pushed(0, 0, 1), 60).X_DH.p.z();
  EXPECT_NEAR(after_m - before_m, 0.08 * 0.05, 1e-15);
  EXPECT_EQ(control.step(pushed(0, 0, 1), 30).X_DH.p.z(), after_m);
  EXPECT_EQ(control.step(pushed(0, 0, 1), std::nan("")).X_DH.p.z(), after_m);
  EXPECT_EQ(control.step(pushed(0, 0, std::nan("")), 31).X_DH.p.z(), after_m);
}

TEST(RateControl, StatesThatItHasNoForce) {
  const DeviceLimits limits = RateControl().limits();
  EXPECT_EQ(limits.peak_force_N, 0);
  EXPECT_EQ(limits.peak_torque_Nm, 0);
  EXPECT_EQ(limits.workspace_max_D, Vec3(0.2, 0.3, 0.2));
}

TEST(RateControl, NeverAllocates) {
  RateControl control;
  const vps_test::NoAllocScope guard;
  held(control, pushed(1, 0.5, 0), 0.1);
}

}  // namespace
}  // namespace vps::device

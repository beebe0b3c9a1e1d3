// SPDX-License-Identifier: BSD-3-Clause
// States in 40 bytes: accurate to their rounding, replaced by whole states if necessary, and robust against
// loss, late joining and damage.
#include "messages/dense_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "messages/messages.h"
#include "support/no_alloc.h"

namespace vps::scenes {
namespace {

constexpr double kPeriod_s = 1.0 / 1600;
constexpr int kWhole = 8;  ///< number of whole states at the beginning

Pose poseAt(double x) {
  return {rotationFromVector({0.1 * x, -0.2 * x, 0.3}), Vec3(0.01 * x, 0.4 - 0.02 * x, -0.3)};
}

HapticMessage hapticAt(int tick) {
  HapticMessage m;
  const double x = 0.01 * tick;
  m.state.tick = tick;
  m.state.report = {1.25 + kPeriod_s * tick + 1e-9,
                    Status::Ok,
                    poseAt(x),
                    {{0.1, 2, -3e-3}, {0.4, -0.05, 6e-3}},
                    {{0.7, 0.01, 0.2}, {1, -2, 30}},
                    {{3, 2, 1}, {6, 5, 4}},
                    1};
  m.state.proxy.is_coupled = true;
  m.hand = 0xB6;
  return m;
}

const Pose kX_GP = {rotationFromVector({0.3, 0, -1}), Vec3(0.02, 0.01, -0.05)};

PhysicsMessage physicsAt(int step, const Pose& X_GP = kX_GP) {
  PhysicsMessage m;
  device::PhysicsState& state = m.state;
  state.part = {poseAt(0.01 * step), {{0.2, -0.1, 0.5}, {0.02, 0.03, -0.01}}, 2 + kPeriod_s * step, true};
  state.step = step;
  state.stored_J = 0.25;
  state.held.X_WP = state.part.X_W * X_GP;
  state.held.V_WP = {state.part.V_W.w,
                     state.part.V_W.v + state.part.V_W.w.cross(state.held.X_WP.p - state.part.X_W.p)};
  state.held.weight_W = {0, 0, -2};
  return m;
}

double angle(const Mat3& a, const Mat3& b) {
  return rotationVector(a * b.transpose()).norm();
}

// Half a micrometre in each coordinate; rotations four times as coarse as with 20 bits (4.7e-6); mantissas of
// 9 and 8 bits: half of 1/127 and 1/63 of the greatest component.
constexpr double kNear_m = 0.87e-6, kNear_rad = 19e-6, kNearTwist = 1.74 * 0.5 / 127,
                 kNearForce = 1.74 * 0.5 / 63;

TEST(DenseState, AHapticStateIsRightToItsRounding) {
  MessageWriter writer(77, WireForm::Compact);
  MessageReader reader;
  reader.bindTo(77);
  HapticMessage read;
  int dense = 0;
  for (int tick = 1; tick < 1000; ++tick) {
    const HapticMessage sent = hapticAt(tick);
    const std::string_view bytes = writer.write(sent);
    const bool is_dense = isDense(bytes);
    dense += is_dense;
    EXPECT_EQ(is_dense, tick > kWhole && bytes.size() == kDenseMessageBytes) << tick;
    ASSERT_EQ(reader.read(bytes, read), Reading::Good) << tick;
    const device::TickReport &a = sent.state.report, &b = read.state.report;
    EXPECT_EQ(read.state.tick, tick);
    EXPECT_EQ(read.hand, sent.hand);
    EXPECT_TRUE(read.state.proxy.is_coupled);
    EXPECT_NEAR(b.time_s, a.time_s, 0.6e-6);
    EXPECT_LT((b.X_WG.p - a.X_WG.p).norm(), kNear_m);
    EXPECT_LT(angle(b.X_WG.R, a.X_WG.R), kNear_rad);
    EXPECT_LT((b.V_WG.v - a.V_WG.v).norm(), kNearTwist * a.V_WG.v.norm());
    EXPECT_LT((b.V_WG.w - a.V_WG.w).norm(), kNearTwist * a.V_WG.w.norm());
    EXPECT_LT((b.F_hand_W.f - a.F_hand_W.f).norm(), kNearForce * a.F_hand_W.f.norm());
    EXPECT_LT((b.F_hand_W.tau - a.F_hand_W.tau).norm(), kNearForce * a.F_hand_W.tau.norm());
    EXPECT_EQ(b.F_hand_D.f, a.F_hand_D.f);  // only whole states contain it
    EXPECT_GT(reader.envelope().time_ns, 0);
  }
  EXPECT_GT(dense, 970);  // 1 of 65 states is whole
}

TEST(DenseState, APhysicsStateTellsWhereThePartInHandIs) {
  MessageWriter writer(77, WireForm::Compact);
  MessageReader reader;
  PhysicsMessage read;
  for (int step = 1; step < 1000; ++step) {
    const PhysicsMessage sent = physicsAt(step);
    ASSERT_EQ(reader.read(writer.write(sent), read), Reading::Good) << step;
    const device::PhysicsState &a = sent.state, &b = read.state;
    EXPECT_EQ(b.step, step);
    EXPECT_EQ(b.stored_J, 0.25);  // a float represents it exactly
    EXPECT_NEAR(b.part.time_s, a.part.time_s, 0.6e-6);
    EXPECT_LT((b.part.X_W.p - a.part.X_W.p).norm(), kNear_m);
    const double lever_m = kX_GP.p.norm();
    EXPECT_LT((b.held.X_WP.p - a.held.X_WP.p).norm(), 2 * kNear_m + 2 * lever_m * kNear_rad);
    EXPECT_LT(angle(b.held.X_WP.R, a.held.X_WP.R), 2 * kNear_rad);
    EXPECT_LT((b.held.V_WP.v - a.held.V_WP.v).norm(),
              kNearTwist * (a.part.V_W.v.norm() + lever_m * a.part.V_W.w.norm()));
    EXPECT_EQ(b.held.weight_W, a.held.weight_W);
  }
}

// Under load, one second of physics may take four seconds of the loop.
TEST(DenseState, APartThatPhysicsMovesMoreSlowlyNeedsNoWholeStates) {
  MessageWriter writer(77, WireForm::Compact);
  MessageReader reader;
  PhysicsMessage read;
  int dense = 0;
  for (int step = 1; step < 200; ++step) {
    PhysicsMessage sent = physicsAt(step);
    sent.state.held.V_WP = {4 * sent.state.held.V_WP.w, 4 * sent.state.held.V_WP.v};
    const std::string_view bytes = writer.write(sent);
    dense += isDense(bytes);
    ASSERT_EQ(reader.read(bytes, read), Reading::Good);
    EXPECT_LT((read.state.held.V_WP.v - sent.state.held.V_WP.v).norm(), 0.02 * sent.state.held.V_WP.v.norm());
  }
  EXPECT_GT(dense, 180);
}

// A new grasp of the part is sent immediately and repeated, since some messages are lost.
TEST(DenseState, ANewGraspIsSentWholeEightTimes) {
  MessageWriter writer(77, WireForm::Compact);
  int step = 1;
  for (; step < 30; ++step) writer.write(physicsAt(step));
  const Pose other = {kX_GP.R, kX_GP.p + Vec3(1e-3, 0, 0)};
  for (int i = 0; i < kWhole; ++i, ++step) EXPECT_FALSE(isDense(writer.write(physicsAt(step, other)))) << i;
  EXPECT_TRUE(isDense(writer.write(physicsAt(step, other))));
}

TEST(DenseState, AFaultIsSentWholeAtOnce) {
  MessageWriter writer(77, WireForm::Compact);
  int tick = 1;
  for (; tick < 30; ++tick) writer.write(hapticAt(tick));
  HapticMessage faulted = hapticAt(tick);
  faulted.state.safety = {device::SafetyFault::PhysicsStalled, 1, 2, 3};
  EXPECT_FALSE(isDense(writer.write(faulted)));
}

TEST(DenseState, WhatIsOutOfRangeIsSentWhole) {
  const auto isSentDense = [](const auto& change) {
    MessageWriter writer(77, WireForm::Compact);
    for (int tick = 1; tick < 30; ++tick) writer.write(hapticAt(tick));
    HapticMessage m = hapticAt(30);
    change(m.state);
    return isDense(writer.write(m));
  };
  EXPECT_TRUE(isSentDense([](auto&) {}));
  EXPECT_TRUE(isSentDense([](auto& s) { s.report.X_WG.p.x() = -2.09; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.X_WG.p.x() = -2.1; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.X_WG.p.y() = std::nan(""); }));
  EXPECT_TRUE(isSentDense([](auto& s) { s.report.V_WG.v.z() = 1.3e5; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.V_WG.v.z() = 1.4e5; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.V_WG.w.z() = HUGE_VAL; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.F_hand_W.tau = s.report.F_hand_W.f = Vec3(0, 0, 7e4); }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.report.time_s += 1001; }));
  EXPECT_FALSE(isSentDense([](auto& s) { s.tick += 40; }));
}

// 2 of 10 messages are lost, and 1 of 10 arrives after its successor, during a change of the grasp.
TEST(DenseState, LossAndReorderingMakeNoStateWrong) {
  MessageWriter haptics(77, WireForm::Compact), physics(78, WireForm::Compact);
  MessageReader haptic_reader, physics_reader;
  haptic_reader.bindTo(77);
  physics_reader.bindTo(78);
  HapticMessage haptic;
  PhysicsMessage part;
  std::mt19937 random(3);
  std::string late_haptic, late_part;
  int newest = 0;
  for (int tick = 1; tick < 20'000; ++tick) {
    const Pose X_GP = tick < 9'000 ? kX_GP : Pose(kX_GP.R, Vec3(0, 0, 0.03));
    const std::string sent_haptic(haptics.write(hapticAt(tick))),
        sent_part(physics.write(physicsAt(tick, X_GP)));
    const unsigned fate = random() % 10;
    if (fate < 2) continue;
    if (fate == 2 && late_haptic.empty()) {
      late_haptic = sent_haptic;
      late_part = sent_part;
      continue;
    }
    const auto take = [&](const std::string& h, const std::string& p) {
      haptic_reader.read(h, haptic);
      physics_reader.read(p, part);
    };
    take(sent_haptic, sent_part);
    newest = tick;
    if (!late_haptic.empty()) take(late_haptic, late_part);
    late_haptic.clear();
    if (newest < 20) continue;
    ASSERT_EQ(haptic.state.tick, newest);
    ASSERT_EQ(part.state.step, newest);
    ASSERT_NEAR(haptic.state.report.time_s, hapticAt(newest).state.report.time_s, 0.6e-6);
    ASSERT_LT((part.state.part.X_W.p - physicsAt(newest).state.part.X_W.p).norm(), kNear_m);
    // At most the eight whole states after the new grasp were lost.
    if (tick >= 9'000 && tick < 9'008) continue;
    ASSERT_LT((part.state.held.X_WP.p - physicsAt(newest, X_GP).state.held.X_WP.p).norm(), 5e-6) << tick;
  }
  EXPECT_EQ(haptic_reader.counts()[static_cast<std::size_t>(Reading::BadValue)], 0u);
}

TEST(DenseState, WhoJoinsLateWaitsForAWholeOneAndCallsNothingRefused) {
  MessageWriter writer(77, WireForm::Compact);
  for (int tick = 1; tick <= 20; ++tick) writer.write(hapticAt(tick));
  MessageReader reader;  // accepts any device
  HapticMessage read;
  int early = 0;
  for (int tick = 21; tick < 200; ++tick) {
    const Reading reading = reader.read(writer.write(hapticAt(tick)), read);
    if (reading == Reading::Early) {
      ++early;
      continue;
    }
    ASSERT_EQ(reading, Reading::Good);
    ASSERT_EQ(read.state.tick, tick);
  }
  EXPECT_GT(early, 0);
  EXPECT_LE(early, 64);
  EXPECT_EQ(reader.refused(), 0u);
}

TEST(DenseState, ReplayedForeignAndDamagedOnesAreRefused) {
  MessageWriter writer(77, WireForm::Compact), other(78, WireForm::Compact);
  MessageReader reader;
  reader.bindTo(77);
  HapticMessage read;
  for (int tick = 1; tick <= 20; ++tick) reader.read(writer.write(hapticAt(tick)), read);
  for (int tick = 1; tick <= 20; ++tick) other.write(hapticAt(tick));
  const std::string dense(writer.write(hapticAt(21))), foreign(other.write(hapticAt(21)));
  ASSERT_TRUE(isDense(dense) && isDense(foreign));
  EXPECT_EQ(reader.read(foreign, read), Reading::WrongSender);
  std::string bytes = dense;
  bytes[0] = static_cast<char>(bytes[0] ^ 1);
  EXPECT_EQ(reader.read(bytes, read), Reading::BadVersion);
  bytes = dense;
  bytes[0] = static_cast<char>(bytes[0] ^ 0x20);
  EXPECT_EQ(reader.read(bytes, read), Reading::BadKind);
  bytes = dense;
  bytes[7] = static_cast<char>(bytes[7] | 0x38);  // an invalid status
  EXPECT_EQ(reader.read(bytes, read), Reading::BadValue);
  EXPECT_EQ(read.state.tick, 20);
  EXPECT_EQ(reader.read(dense, read), Reading::Good);
  EXPECT_EQ(reader.read(dense, read), Reading::Replayed);
  EXPECT_EQ(reader.refused(), 5u);
  PhysicsMessage physics;
  EXPECT_EQ(reader.read(dense, physics), Reading::BadKind);
}

// Found by fuzzing: a float can hold energies that a whole state must not have.
TEST(DenseState, AnEnergyBeyondWhatNodesSendIsRefused) {
  MessageWriter writer(77, WireForm::Compact);
  MessageReader reader;
  PhysicsMessage read;
  int step = 1;
  for (; step <= 20; ++step) ASSERT_EQ(reader.read(writer.write(physicsAt(step)), read), Reading::Good);
  PhysicsMessage sent = physicsAt(step);
  sent.state.stored_J = 2e12;
  const std::string bytes(writer.write(sent));
  ASSERT_TRUE(isDense(bytes));
  EXPECT_EQ(reader.read(bytes, read), Reading::BadValue);
}

// After one flipped bit, the state is correct again with the next whole state at the latest.
TEST(DenseState, AFlippedBitIsOverWithTheNextWholeState) {
  for (std::size_t bit = 0; bit < 8 * kDenseMessageBytes; ++bit) {
    MessageWriter writer(77, WireForm::Compact);
    MessageReader reader;
    reader.bindTo(77);
    HapticMessage read;
    int tick = 1;
    for (; tick <= 20; ++tick) reader.read(writer.write(hapticAt(tick)), read);
    std::string bytes(writer.write(hapticAt(tick++)));
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    reader.read(bytes, read);
    for (int i = 0; i < 70; ++i) reader.read(writer.write(hapticAt(tick++)), read);
    ASSERT_EQ(read.state.tick, tick - 1) << bit;
    ASSERT_NEAR(read.state.report.time_s, hapticAt(tick - 1).state.report.time_s, 0.6e-6) << bit;
  }
}

TEST(DenseState, WritingAndReadingDoesNotAllocate) {
  MessageWriter writer(77, WireForm::Compact);
  MessageReader reader;
  HapticMessage haptic = hapticAt(1), haptic_read;
  PhysicsMessage physics = physicsAt(1), physics_read;
  const vps_test::NoAllocScope scope;
  for (int i = 1; i < 100; ++i) {
    haptic.state.tick = physics.state.step = i;
    reader.read(writer.write(haptic), haptic_read);
    reader.read(writer.write(physics), physics_read);
  }
  EXPECT_EQ(haptic_read.state.tick, 99);
}

}  // namespace
}  // namespace vps::scenes

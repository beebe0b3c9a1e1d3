// SPDX-License-Identifier: BSD-3-Clause
// Messages between nodes: read back bit for bit, and refused if any part of them is invalid.
#include "messages/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "link/link.h"
#include "messages/dense_state.h"
#include "support/no_alloc.h"

namespace vps::scenes {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Pose somePose(double x) {
  return {rotationFromVector({0.1 * x, -0.2, 0.3}), Vec3(x, 2 * x, -1 / (1 + x * x))};
}

HapticMessage someHaptic() {
  HapticMessage m;
  m.state.tick = 7;
  m.state.report = {1.25,
                    Status::Fault,
                    somePose(1),
                    {{1, 2, 3}, {4, 5, 6}},
                    {{7, 8, 9}, {1, 2, 3}},
                    {{3, 2, 1}, {6, 5, 4}},
                    0.5};
  m.state.proxy.is_coupled = true;
  m.state.safety = {device::SafetyFault::Jump, 1, 2, 3};
  m.state.passivity = {1, 2, 3, 4, 5, 6, 7};
  m.hand = 0x21;
  return m;
}

PhysicsMessage somePhysics() {
  PhysicsMessage m;
  m.state.part = {somePose(2), {{1, 0, 0}, {0, 1, 0}}, 3.5, true};
  m.state.step = 9;
  m.state.stored_J = 0.25;
  m.state.held = {somePose(3), {{0, 0, 1}, {1, 1, 1}}, {0, 0, -2}};
  return m;
}

template <typename Message>
std::string bytesOf(const Message& message, std::uint64_t sender = 5) {
  MessageWriter writer(sender);
  return std::string(writer.write(message));
}

template <typename Message>
Reading readingOf(std::string_view bytes) {
  MessageReader reader;
  Message message;
  return reader.read(bytes, message);
}

/// A message that was written again after reading has the same bytes.
template <typename Message>
void expectReadBack(const Message& message) {
  const std::string bytes = bytesOf(message);
  ASSERT_LE(bytes.size(), kLongestMessage);
  MessageReader reader;
  Message read;
  ASSERT_EQ(reader.read(bytes, read), Reading::Good);
  constexpr std::size_t kEnvelope = 28;
  EXPECT_EQ(bytesOf(read).substr(kEnvelope), bytes.substr(kEnvelope));
  EXPECT_EQ(reader.envelope().sender, 5u);
  EXPECT_EQ(reader.envelope().number, 1u);
  EXPECT_GT(reader.envelope().time_ns, 0);
}

TEST(Messages, EachKindIsReadBackToTheBit) {
  expectReadBack(someHaptic());
  expectReadBack(somePhysics());
  RequestMessage request;
  request.command = device::SyncEventKind::Begin;
  request.task.X_WP_target = somePose(4);
  request.task.has_corners = true;
  request.way_points_left = 3;
  expectReadBack(request);
  expectReadBack(ReplyMessage{4, 2, 9});
  HelloMessage hello;
  hello.limits.peak_force_N = 30;
  std::strcpy(hello.name.data(), "dual_arm");
  expectReadBack(hello);
  TimesMessage times;
  times.missed_by = {1, 2, 3, 4};
  times.worst_cause = 2;
  expectReadBack(times);
  expectReadBack(LogMessage{8, device::SyncEvent{1, 2, 3, 4, device::SyncEventKind::Rearm}});
  SnapshotMessage snapshot;
  snapshot.snapshot.bodies.resize(3);
  snapshot.snapshot.contacts.resize(5);
  expectReadBack(snapshot);
  NewsMessage news{NewsKind::Ended, 1, Verdict::Fits, 2.5, {}};
  std::strcpy(news.text.data(), "fits");
  expectReadBack(news);
}

TEST(Messages, ALogKeepsTheValuesOfAFaultyDevice) {
  device::DeviceSample sample;
  sample.X_DH.p.x() = kNan;
  sample.time_s = -kInfinite;
  expectReadBack(LogMessage{1, sample});
}

TEST(Messages, TheLongestSnapshotFitsIntoAMessage) {
  SnapshotMessage snapshot;
  snapshot.snapshot.bodies.resize(300);
  snapshot.snapshot.contacts.resize(400);
  expectReadBack(snapshot);
}

TEST(Messages, EveryCutAndEveryExtraByteIsRefused) {
  const std::string haptic = bytesOf(someHaptic()), physics = bytesOf(somePhysics());
  for (std::size_t length = 0; length < haptic.size(); ++length)
    EXPECT_NE(readingOf<HapticMessage>(haptic.substr(0, length)), Reading::Good) << length;
  for (std::size_t length = 0; length < physics.size(); ++length)
    EXPECT_NE(readingOf<PhysicsMessage>(physics.substr(0, length)), Reading::Good) << length;
  EXPECT_EQ(readingOf<HapticMessage>(haptic + '\0'), Reading::BadSize);
}

TEST(Messages, AnotherVersionKindOrSenderIsRefusedByName) {
  std::string bytes = bytesOf(somePhysics());
  EXPECT_EQ(readingOf<HapticMessage>(bytes), Reading::BadKind);
  MessageReader reader;
  PhysicsMessage message;
  reader.bindTo(6);
  EXPECT_EQ(reader.read(bytes, message), Reading::WrongSender);
  bytes[2] = static_cast<char>(kMessageVersion + 1);
  EXPECT_EQ(readingOf<PhysicsMessage>(bytes), Reading::BadVersion);
  EXPECT_EQ(reader.refused(), 1u);
}

TEST(Messages, AMessageThatWasReadBeforeIsRefused) {
  MessageWriter writer(5);
  const std::string first(writer.write(somePhysics())), second(writer.write(somePhysics()));
  MessageReader reader;
  PhysicsMessage message;
  EXPECT_EQ(reader.read(second, message), Reading::Good);
  EXPECT_EQ(reader.read(second, message), Reading::Replayed);
  EXPECT_EQ(reader.read(first, message), Reading::Replayed);
  EXPECT_EQ(reader.counts()[static_cast<std::size_t>(Reading::Replayed)], 2u);
}

TEST(Messages, ValuesThatNoNodeSendsInGoodFaithAreRefused) {
  const auto refused = [](const auto& spoil) {
    PhysicsMessage m = somePhysics();
    spoil(m.state);
    return readingOf<PhysicsMessage>(bytesOf(m)) == Reading::BadValue;
  };
  EXPECT_TRUE(refused([](auto& s) { s.part.X_W.p.y() = kNan; }));
  EXPECT_TRUE(refused([](auto& s) { s.part.V_W.w.z() = kInfinite; }));
  EXPECT_TRUE(refused([](auto& s) { s.part.time_s = 1e300; }));
  EXPECT_TRUE(refused([](auto& s) { s.held.X_WP.R *= 1.001; }));                      // not a rotation
  EXPECT_TRUE(refused([](auto& s) { s.part.X_W.R.col(0) = -s.part.X_W.R.col(0); }));  // a reflection
  EXPECT_FALSE(refused([](auto& s) { s.part.X_W.p.x() = 1e3; }));

  std::string flag = bytesOf(HelloMessage{});
  flag.back() = 2;  // the byte of may_rearm
  EXPECT_EQ(readingOf<HelloMessage>(flag), Reading::BadValue);
  HelloMessage endless;
  endless.name.fill('x');
  EXPECT_EQ(readingOf<HelloMessage>(bytesOf(endless)), Reading::BadValue);
  NewsMessage news;
  news.verdict = static_cast<Verdict>(7);
  EXPECT_EQ(readingOf<NewsMessage>(bytesOf(news)), Reading::BadValue);
}

TEST(Messages, WhatIsRefusedChangesNothing) {
  MessageReader reader;
  PhysicsMessage message = somePhysics();
  message.state.step = 77;
  PhysicsMessage bad = somePhysics();
  bad.state.held.weight_W.x() = kNan;
  EXPECT_EQ(reader.read(bytesOf(bad), message), Reading::BadValue);
  EXPECT_EQ(message.state.step, 77);
}

TEST(Messages, TheHapticThreadsMessagesAreWrittenAndReadWithoutAllocating) {
  MessageWriter writer(5);
  MessageReader reader;
  HapticMessage haptic = someHaptic(), haptic_read;
  PhysicsMessage physics = somePhysics(), physics_read;
  const LogMessage log{1, device::DeviceSample{}};
  const vps_test::NoAllocScope scope;
  EXPECT_EQ(reader.read(writer.write(haptic), haptic_read), Reading::Good);
  EXPECT_EQ(reader.read(writer.write(physics), physics_read), Reading::Good);
  EXPECT_FALSE(writer.write(log).empty());
}

// Tests the whole states that are sent over UDP. A pose is accurate to a float's rounding (6e-8 of a length)
// and to 20 bits of a quaternion, twist and wrench to a half float's rounding (5e-4).
TEST(Messages, CompactStatesAreRightToTheirRounding) {
  MessageWriter compact(5, WireForm::Compact);
  MessageReader reader;
  reader.bindTo(5);
  HapticMessage sent = someHaptic(), read;
  ASSERT_EQ(reader.read(compact.write(sent), read), Reading::Good);
  const device::TickReport &a = sent.state.report, &b = read.state.report;
  EXPECT_EQ(b.time_s, a.time_s);
  EXPECT_EQ(b.status, a.status);
  EXPECT_EQ(read.state.tick, sent.state.tick);
  EXPECT_EQ(read.state.safety.fault, sent.state.safety.fault);
  EXPECT_EQ(read.hand, sent.hand);
  EXPECT_LT((b.X_WG.p - a.X_WG.p).norm(), 1e-7 * a.X_WG.p.norm());
  EXPECT_LT(rotationVector(b.X_WG.R * a.X_WG.R.transpose()).norm(), 4e-6);
  EXPECT_LT((b.V_WG.v - a.V_WG.v).norm(), 5e-4 * a.V_WG.v.norm());
  EXPECT_LT((b.F_hand_W.f - a.F_hand_W.f).norm(), 5e-4 * a.F_hand_W.f.norm());
  EXPECT_EQ(read.state.passivity.injected_J, 6);
}

TEST(Messages, EveryRotationIsPackedToTwentyBits) {
  double worst_rad = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 turn = Vec3(std::sin(0.7 * i), std::cos(1.3 * i), std::sin(2.1 * i + 1)).normalized() *
                      (3.1415926 * i / 20000);
    const Mat3 R = rotationFromVector(turn);
    const std::optional<Mat3> read = unpackedRotation(packedRotation(R));
    ASSERT_TRUE(read.has_value());
    worst_rad = std::max(worst_rad, rotationVector(*read * R.transpose()).norm());
  }
  // Three components are off by half a step of 1.35e-6 each, and the rotation angle is twice the distance of
  // the quaternions; the largest component follows from the others.
  EXPECT_LT(worst_rad, 5e-6);
  EXPECT_FALSE(unpackedRotation(~std::uint64_t{0}).has_value());
  EXPECT_FALSE(unpackedRotation((std::uint64_t{1} << 60U) - 1).has_value());
}

}  // namespace
}  // namespace vps::scenes

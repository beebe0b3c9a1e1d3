// SPDX-License-Identifier: BSD-3-Clause
// The link over UDP on the loopback interface. Both ends are in this process; DDS uses no shortcut for that.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "link/link.h"
#include "messages/messages.h"
#include "record/scene_archive.h"
#include "scenes/two_pins.h"
#include "support/no_alloc.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/recording.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/run/replay.h"

#if __has_include(<dds/dds.h>)
#include "dds/topics.h"
#endif

namespace vps::scenes {
namespace {

class NetworkLink : public testing::Test {
 protected:
  void SetUp() override {
    try {
      render_ = makeSession(session_, "a scene", "lo");
    } catch (const LoadError& error) {
      if (std::string(error.what()).find("this build has no network") == std::string::npos) throw;
      GTEST_SKIP() << "this build has no network";
    }
  }
  std::unique_ptr<Link> join(NodeRole role) const {
    for (int i = 0; i < 10; ++i)
      if (auto link = joinSession(session_, role, "lo")) return link;
    return nullptr;
  }
  /// Waits for a few seconds until the condition holds.
  static bool soon(const std::function<bool()>& isSo) {
    for (int i = 0; i < 500; ++i) {
      if (isSo()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  std::string receive(Link& link, Channel channel) { return std::string(link.receive(channel, buffer_)); }

  std::string session_ = "udp-" + std::to_string(getpid());
  std::unique_ptr<Link> render_;
  std::vector<char> buffer_ = std::vector<char>(kLongestMessage);
};

TEST_F(NetworkLink, ADeviceFindsTheSessionAndItsScene) {
  EXPECT_FALSE(render_->isAlive(NodeRole::Device));
  const auto device = join(NodeRole::Device);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->sceneBytes(), "a scene");
  EXPECT_EQ(device->sessionId(), render_->sessionId());
  EXPECT_TRUE(device->isAlive(NodeRole::Render));
  EXPECT_TRUE(soon([&] { return render_->isAlive(NodeRole::Device); }));
}

TEST_F(NetworkLink, StatesAndRequestsArriveBothWaysAndSendingDoesNotAllocate) {
  const auto device = join(NodeRole::Device);
  ASSERT_NE(device, nullptr);
  EXPECT_TRUE(soon([&] {
    device->send(Channel::Haptic, "proxy");
    return receive(*render_, Channel::Haptic) == "proxy";
  }));
  EXPECT_TRUE(soon([&] {
    render_->send(Channel::Request, "request");
    return receive(*device, Channel::Request) == "request";
  }));
  const vps_test::NoAllocScope scope;
  device->send(Channel::Haptic, "proxy");
  (void)device->receive(Channel::Physics, buffer_);
}

TEST_F(NetworkLink, BothKnowTheRoundTripAndThatTheClocksAreOne) {
  const auto device = join(NodeRole::Device);
  ASSERT_NE(device, nullptr);
  ASSERT_TRUE(soon([&] { return render_->timing(NodeRole::Device).has_value(); }));
  const PeerTiming timing = *render_->timing(NodeRole::Device);
  EXPECT_GT(timing.round_trip_s, 0);
  // Both ends read the same clock, so the offset is 0.
  EXPECT_LE(std::abs(timing.clock_offset_s), timing.clock_error_s);
}

#if __has_include(<dds/dds.h>)
// The peer claims to have received a beat a second before it was sent, so that the round trip is negative.
TEST_F(NetworkLink, APeerThatLiesAboutTimeIsReportedOnceAndItsBadBeatsAreCounted) {
  const DdsParticipant participant("lo");
  std::atomic<std::uint64_t> render{0};
  std::atomic<std::int64_t> sent_ns{0};
  const auto hear = [&](std::string_view bytes) {
    MessageReader reader;
    BeatMessage beat;
    if (reader.read(bytes, beat) != Reading::Good || beat.role != NodeRole::Render) return;
    render = reader.envelope().sender;
    sent_ns = reader.envelope().time_ns;
  };
  DdsTopic out(participant, topicName(session_, "beat"), Delivery::Newest, nullptr);
  const DdsTopic in(participant, topicName(session_, "beat"), Delivery::Newest, hear);
  MessageWriter writer(77);
  ClockDoubts doubts;
  EXPECT_TRUE(doubts.takeNew(*render_).empty());
  std::vector<std::string> said;
  ASSERT_TRUE(soon([&] {
    const std::int64_t lie_ns = device::monotonicClock().now_ns() - 1'000'000'000;
    const BeatMessage beat{NodeRole::Device, render_->sessionId(), false, render, sent_ns, lie_ns};
    if (render != 0) out.write(writer.write(beat));
    said = doubts.takeNew(*render_);
    return !said.empty();
  }));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("the device node"), std::string::npos) << said[0];
  EXPECT_TRUE(doubts.takeNew(*render_).empty());
  EXPECT_NE(ClockDoubts::summary(*render_).find("from the device node"), std::string::npos);
  const std::uint64_t before = render_->refusedBeats();
  ASSERT_TRUE(soon([&] {
    out.write("no beat");
    return render_->refusedBeats() > before;
  }));
}
#endif

// Earlier, snapshots were stamped with the time at which they were read, so that a busy watcher showed old
// snapshots as new.
TEST_F(NetworkLink, AWatcherKnowsWhenASnapshotWasSentByItsOwnClock) {
  render_.reset();
  render_ = makeSession(session_ + "-clock", sceneToBytes(twoPins()), "lo");
  std::unique_ptr<SessionWatcher> watcher;
  ASSERT_TRUE(soon([&] { return (watcher = SessionWatcher::join(session_ + "-clock", "lo")) != nullptr; }));
  ASSERT_TRUE(soon([&] { return render_->timing(NodeRole::Watch).has_value(); }));
  MessageWriter writer(render_->sessionId(), render_->form());
  const auto now_ns = [] { return device::monotonicClock().now_ns(); };
  bool is_known = false;
  for (int i = 0; i < 50 && !is_known; ++i) {
    const std::int64_t before_ns = now_ns();
    render_->send(Channel::Snapshot, writer.write(SnapshotMessage{}));
    const std::int64_t sent_ns = now_ns();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (!watcher->takeSnapshot()) continue;
    const double error_ns =
        1e9 * render_->timing(NodeRole::Watch)->round_trip_s + 1000;  // plus the rounding of compact times
    is_known = static_cast<double>(watcher->snapshotSent_ns() - sent_ns) < error_ns &&
               static_cast<double>(before_ns - watcher->snapshotSent_ns()) < error_ns && error_ns < 1e8;
  }
  EXPECT_TRUE(is_known);
}

TEST_F(NetworkLink, AnEndedSessionSaysSo) {
  const auto watcher = join(NodeRole::Watch);
  ASSERT_NE(watcher, nullptr);
  EXPECT_FALSE(watcher->hasEnded());
  render_.reset();
  EXPECT_TRUE(soon([&] { return watcher->hasEnded(); }));
  EXPECT_FALSE(watcher->isAlive(NodeRole::Render));
}

TEST_F(NetworkLink, ASecondRenderAndASecondDeviceAreRefused) {
  const auto device = join(NodeRole::Device);
  ASSERT_NE(device, nullptr);
  EXPECT_THROW(makeSession(session_, "", "lo"), LoadError);
  EXPECT_THROW(joinSession(session_, NodeRole::Device, "lo"), LoadError);
}

TEST_F(NetworkLink, ARunOverUdpHasTheVerdictOfOneProcess) {
  render_.reset();
  Scene scene = twoPins();
  RenderOptions render;
  render.session = session_ + "-run";
  render.network = "lo";
  DeviceNodeResult device_result;
  std::thread device([&] {
    device_result = deviceNode({render.session, render.network, nullptr, {}, false, false});
  });
  const AssembleResult result = renderNode(scene, render);
  device.join();
  for (const StepResult& step : result.steps)
    EXPECT_EQ(step.verdict, Verdict::Fits)
        << step.part << ": " << step.reason << "; " << step.failure_reason << " in " << step.duration_s
        << " s, off by " << 1e6 * step.final_error_m << " um, drifted " << 1e6 * step.rest_drift_m << " um; "
        << device_result.missed << " of " << device_result.ticks << " ticks late, " << device_result.faults
        << " faults";
  EXPECT_EQ(result.verdict, Verdict::Fits);
  EXPECT_EQ(device_result.refused, 0u);
}

// During a recording, states are sent with all bits, and the loop's log arrives later than the states that
// physics answers.
TEST_F(NetworkLink, ARunOverUdpIsReplayedBitForBit) {
  render_.reset();
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Scene scene = twoPins();
  RenderOptions render;
  render.session = session_ + "-recorded";
  render.network = "lo";
  std::thread device([&] { deviceNode({render.session, render.network, nullptr, {}, false, false}); });
  const AssembleResult result = renderNode(scene, render, file);
  device.join();
  const device::RecordedRun run = device::loadRecording(file);
  EXPECT_EQ(run.damage, "");
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
  EXPECT_GT(replayed.equal, result.haptic.count);
}

}  // namespace
}  // namespace vps::scenes

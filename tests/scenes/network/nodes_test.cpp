// SPDX-License-Identifier: BSD-3-Clause
// Render node, device node and watcher of one session. Each node is a thread here, so that sanitizers check
// all of them; tests/program/nodes_test.cpp runs processes.
#include "vps_scenes/network/nodes.h"
#include "scenes/session_name.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <vector>

#include "scenes/two_pins.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/recording.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

struct Ran {
  AssembleResult result;
  DeviceNodeResult device;
};

/// Runs two pins with the device node in its own thread.
Ran runTwoPins(const std::string& file = "") {
  Scene scene = twoPins();
  RenderOptions render;
  render.session = sessionName("nodes");
  Ran ran;
  std::thread device([&ran, name = render.session] {
    ran.device = deviceNode({name, "", nullptr, {}, false, false});
  });
  ran.result = renderNode(scene, render, file);
  device.join();
  return ran;
}

TEST(Nodes, TheRunOfTwoNodesHasTheVerdictOfOneProcess) {
  const Ran ran = runTwoPins();
  ASSERT_EQ(ran.result.steps.size(), 2u);
  EXPECT_EQ(ran.result.verdict, Verdict::Fits);
  ASSERT_TRUE(ran.result.real_time.has_value());
  EXPECT_GT(ran.result.haptic.count, 0u);
  EXPECT_EQ(ran.result.haptic.count, ran.device.ticks);
  EXPECT_EQ(ran.device.sessions, 1);
  EXPECT_EQ(ran.device.lost, 0);
  EXPECT_EQ(ran.device.refused, 0u);
}

TEST(Nodes, ARecordingOfTwoNodesIsReplayedBitForBitByOne) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  const Ran ran = runTwoPins(file);
  const device::RecordedRun run = device::loadRecording(file);
  EXPECT_EQ(run.damage, "");
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
  EXPECT_GT(replayed.equal, ran.result.haptic.count);
}

// A long physics step must not count as a lost node. Earlier the device released the part after 15 ms, and a
// part of the sample scene did not reach its target. On a busy machine the thread that sends the signs of
// life may be delayed for 15 ms, which is a true fault. Therefore one session of five must be without faults:
// if long steps were faults, each session would have several.
TEST(Nodes, ALongStepOfPhysicsIsNoFault) {
  constexpr int kSessions = 5;
  for (int i = 0; i < kSessions; ++i) {
    Scene scene = twoPins();
    RenderOptions render;
    render.session = sessionName("nodes") + "-" + std::to_string(i);
    int steps = 0;
    render.after_step = [&steps](double) {
      if (++steps % 100 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
    DeviceNodeResult result;
    std::thread device([&] { result = deviceNode({render.session, "", nullptr, {}, false, false}); });
    const AssembleResult ran = renderNode(scene, render);
    device.join();
    EXPECT_GT(steps, 1000);
    if (result.faults > 0) continue;
    EXPECT_EQ(ran.verdict, Verdict::Fits);
    return;
  }
  FAIL() << "each of " << kSessions << " sessions had faults";
}

TEST(Nodes, AWatcherSeesStepsForcesAndVerdict) {
  const std::string name = sessionName("nodes");
  std::size_t snapshots = 0, forces = 0;
  std::vector<SessionNews> news;
  std::thread watch([&] {
    std::unique_ptr<SessionWatcher> watcher;
    while ((watcher = SessionWatcher::join(name)) == nullptr) std::this_thread::yield();
    EXPECT_EQ(watcher->scene().steps.size(), 2u);
    for (bool is_over = false; !is_over;) {
      is_over = watcher->isOver();
      while (auto one = watcher->takeNews()) news.push_back(*one);
      snapshots += watcher->takeSnapshot().has_value();
      forces += watcher->takeForce().has_value();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(watcher->hasEnded());
    EXPECT_EQ(watcher->refused(), 0u);
  });
  const Ran ran = runTwoPins();
  watch.join();
  EXPECT_GT(snapshots, 10u);
  EXPECT_GT(forces, 10u);
  std::size_t steps = 0;
  for (const SessionNews& one : news) steps += one.kind == SessionNews::Kind::StepDone;
  EXPECT_EQ(steps, 2u);
  ASSERT_FALSE(news.empty());
  EXPECT_EQ(news.back().kind, SessionNews::Kind::Ended);
  EXPECT_EQ(news.back().verdict, ran.result.verdict);
}

TEST(Nodes, ASecondDeviceIsRefusedInWords) {
  const std::string name = sessionName("nodes");
  std::atomic<bool> stop{false};
  Scene scene = twoPins();
  RenderOptions render;
  render.session = name;
  render.stop = &stop;
  std::string refused;
  std::thread first([&] { deviceNode({name, "", &stop, {}, false, false}); });
  std::thread second;
  render.after_step = [&](double) {
    if (second.joinable()) return;
    second = std::thread([&] {
      try {
        deviceNode({name, "", &stop, {}, false, false});
      } catch (const LoadError& error) {
        refused = error.what();
      }
      stop = true;
    });
  };
  renderNode(scene, render);
  first.join();
  second.join();
  EXPECT_NE(refused.find("has a device already"), std::string::npos) << refused;
}

TEST(Nodes, LocalContactIsRefusedInWords) {
  Scene scene = twoPins();
  RenderOptions render;
  render.session = sessionName("nodes");
  render.has_local_contact = true;
  EXPECT_THROW(renderNode(scene, render), LoadError);
}

}  // namespace
}  // namespace vps::scenes

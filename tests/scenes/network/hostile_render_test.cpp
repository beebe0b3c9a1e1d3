// SPDX-License-Identifier: BSD-3-Clause
// A device node whose render node sends invalid data.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "link/link.h"
#include "messages/messages.h"
#include "record/scene_archive.h"
#include "scenes/two_pins.h"
#include "vps_scenes/network/nodes.h"
#include "world/loop_settings.h"

namespace vps::scenes {
namespace {

/// The render node's end of a session, implemented by hand.
class HostileRender : public testing::Test {
 protected:
  void SetUp() override {
    session_ = "hostile-" + std::to_string(getpid());
    link_ = makeSession(session_, sceneToBytes(scene_));
    writer_.emplace(link_->sessionId());
    device_ = std::thread([this] {
      DeviceNodeOptions options;
      options.session = session_;
      options.stop = &stop_;
      options.say = [this](const std::string& words) {
        const std::lock_guard lock(mutex_);
        said_ += words + "\n";
      };
      result_ = deviceNode(options);
    });
    ASSERT_TRUE(soon([this] { return hear() && hello_.limits.peak_force_N > 0; }));
    replies_.bindTo(hello_reader_.envelope().sender);
  }
  void TearDown() override { endDevice(); }

  void endDevice() {
    stop_ = true;
    if (device_.joinable()) device_.join();
  }
  static bool soon(const std::function<bool()>& isSo) {
    for (int i = 0; i < 10'000; ++i) {
      if (isSo()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  bool hear() {
    const std::string_view bytes = link_->receive(Channel::Reply, buffer_);
    return !bytes.empty() && hello_reader_.read(bytes, hello_) == Reading::Good;
  }
  ReplyMessage ask(const RequestMessage& request) {
    link_->send(Channel::Request, writer_->write(request));
    ReplyMessage reply;
    EXPECT_TRUE(soon([&] {
      const std::string_view bytes = link_->receive(Channel::Reply, buffer_);
      return kindOf(bytes) == MessageKind::Reply && replies_.read(bytes, reply) == Reading::Good &&
             reply.request == writer_->number(MessageKind::Request);
    }));
    return reply;
  }
  /// The newest state of the loop.
  const device::HapticState& state() {
    EXPECT_TRUE(soon([this] {
      const std::string_view bytes = link_->receive(Channel::Haptic, buffer_);
      return !bytes.empty() && states_.read(bytes, haptic_) == Reading::Good;
    }));
    return haptic_.state;
  }
  std::string said() {
    const std::lock_guard lock(mutex_);
    return said_;
  }

  Scene scene_ = twoPins();
  std::string session_;
  std::unique_ptr<Link> link_;
  std::optional<MessageWriter> writer_;
  MessageReader hello_reader_, replies_, states_;
  HelloMessage hello_;
  HapticMessage haptic_;
  std::vector<char> buffer_ = std::vector<char>(kLongestMessage);
  std::atomic<bool> stop_{false};
  std::thread device_;
  DeviceNodeResult result_;
  std::mutex mutex_;
  std::string said_;
};

TEST_F(HostileRender, NoPhysicsTakesTheForceBeyondTheDevicesLimits) {
  CouplingGains stiff;
  stiff.k_N_per_m = stiff.b_Ns_per_m = stiff.k_Nm_per_rad = stiff.b_Nms_per_rad = 1e9;
  stiff.max_force_N = stiff.max_torque_Nm = 1e9;
  ask({.kind = RequestKind::Setup, .gains = stiff});
  ask({.kind = RequestKind::Start});
  RequestMessage hand_over{.command = device::SyncEventKind::HandOver};
  hand_over.X_WG = state().report.X_WG;
  ask(hand_over);
  double most_N = 0, most_Nm = 0;
  int with_force = 0;
  for (int i = 0; i < 3000; ++i) {
    const device::HapticState& now = state();
    most_N = std::max(most_N, now.report.F_hand_D.f.norm());
    most_Nm = std::max(most_Nm, now.report.F_hand_D.tau.norm());
    with_force += now.report.F_hand_D.f.norm() > 1;
    if (now.safety.fault != device::SafetyFault::None) ask({.command = device::SyncEventKind::Rearm});
    // A part that is pulled away by half a metre and turned; later a part that jumps from side to side at the
    // speed of a bullet, spins, and weighs as much as a ship.
    const bool jumps = i > 1500;
    const double side = jumps && i / 40 % 2 == 0 ? -0.5 : 0.5;
    PhysicsMessage physics;
    physics.state.part = {now.report.X_WG, {}, now.report.time_s, true};
    physics.state.part.X_W.p.x() += side;
    physics.state.part.X_W.R = rotationFromVector(Vec3(0, 2 * side, 0)) * physics.state.part.X_W.R;
    if (jumps) physics.state.part.V_W = {Vec3(0, 1e4 * side, 0), Vec3(1e3 * side, 0, 0)};
    if (jumps) physics.state.held.weight_W = Vec3(0, 0, -1e6);
    physics.state.step = i;
    link_->send(Channel::Physics, writer_->write(physics));
  }
  // Tolerance for the rounding of the scaling to the limit: a few parts in 1e16.
  EXPECT_LE(most_N, hello_.limits.peak_force_N * (1 + 1e-12));
  EXPECT_LE(most_Nm, hello_.limits.peak_torque_Nm * (1 + 1e-12));
  EXPECT_GT(with_force, 100) << "the test never reached the device";
  EXPECT_GT(most_N, 0.5 * hello_.limits.peak_force_N);
  EXPECT_NE(said().find("this device is only passive up to"), std::string::npos) << said();
}

// Without the bound, a spring of 1 GN/m would reach its force limit at any measurable distance.
TEST_F(HostileRender, StiffnessIsBoundedByWhatTheDevicesPassivityAllows) {
  const CouplingGains most = passiveGains(scene_, hello_.limits, scene_.fidelity.physics_rate_hz);
  CouplingGains stiff = most;
  stiff.k_N_per_m = 1e5;  // accepted by areUsable(), but hundreds of times too stiff
  stiff.b_Ns_per_m = 0;
  ask({.kind = RequestKind::Setup, .gains = stiff});
  ask({.kind = RequestKind::Start});
  RequestMessage hand_over{.command = device::SyncEventKind::HandOver};
  hand_over.X_WG = state().report.X_WG;
  ask(hand_over);
  // The part is held 2 mm away. The force ramps up after the grasp, so the greatest force is compared.
  constexpr double kAway_m = 2e-3;
  const Vec3 p_W = hand_over.X_WG.p + Vec3(kAway_m, 0, 0);
  double stiffest_N_per_m = 0;
  for (int i = 0; i < 1500; ++i) {
    const device::HapticState& now = state();
    // The device waits 15 ms for physics, and on a busy machine this thread may be delayed for longer. A
    // re-armed device grasps the part without force at its pose, so the part is moved 2 mm away again.
    if (now.safety.fault != device::SafetyFault::None) {
      ask({.command = device::SyncEventKind::Rearm});
      ask(hand_over);
    }
    const double away_m = (p_W - now.report.X_WG.p).norm();
    if (away_m > 0.5 * kAway_m)
      stiffest_N_per_m = std::max(stiffest_N_per_m, now.report.F_hand_W.f.norm() / away_m);
    PhysicsMessage physics;
    physics.state.part = {now.report.X_WG, {}, now.report.time_s, true};
    physics.state.part.X_W.p = p_W;
    physics.state.step = i;
    link_->send(Channel::Physics, writer_->write(physics));
  }
  EXPECT_GT(stiffest_N_per_m, 0.1 * most.k_N_per_m) << "the test never reached the spring";
  // The part's state is a few ticks old, and the damper contributes; the sum is far below the requested
  // factor of 100.
  EXPECT_LT(stiffest_N_per_m, 2 * most.k_N_per_m);
}

TEST_F(HostileRender, AStepThatTheSceneDoesNotHaveIsRefusedInWords) {
  RequestMessage begin{.command = device::SyncEventKind::Begin};
  begin.step = static_cast<std::uint32_t>(scene_.steps.size());
  EXPECT_NE(std::string(ask(begin).refusal.data()).find("requests step 3, but the scene has 2 steps"),
            std::string::npos);
  RequestMessage back{.command = device::SyncEventKind::GoBack};
  back.step =
      static_cast<std::uint32_t>(scene_.steps.size());  // the step after the last one: the home position
  EXPECT_STREQ(ask(back).refusal.data(), "");
  back.step = 0xffffffff;
  EXPECT_STRNE(ask(back).refusal.data(), "");
  endDevice();
  EXPECT_EQ(result_.refused_requests, 2u);
}

// Viewers use the step as an index.
TEST_F(HostileRender, ASnapshotOfAStepThatTheSceneDoesNotHaveIsNotTaken) {
  const std::unique_ptr<SessionWatcher> watcher = SessionWatcher::join(session_);
  ASSERT_NE(watcher, nullptr);
  const auto isTaken = [&](int step) {
    SnapshotMessage message;
    message.snapshot.step = step;
    EXPECT_TRUE(link_->send(Channel::Snapshot, writer_->write(message)));
    const std::optional<Snapshot> taken = watcher->takeSnapshot();
    EXPECT_EQ(taken.value_or(message.snapshot).step, step);
    return taken.has_value();
  };
  const int steps = static_cast<int>(scene_.steps.size());
  EXPECT_TRUE(isTaken(-1)) << "outside of a step";
  EXPECT_TRUE(isTaken(0));
  EXPECT_TRUE(isTaken(steps - 1));
  EXPECT_FALSE(isTaken(steps));
  EXPECT_FALSE(isTaken(-2));
}

TEST_F(HostileRender, NegativeGainsAreNotRead) {
  RequestMessage setup{.kind = RequestKind::Setup};
  setup.gains.b_Ns_per_m = -1;
  link_->send(Channel::Request, writer_->write(setup));
  ask({.kind = RequestKind::Start});  // requests are read in order, so the previous one was read
  endDevice();
  EXPECT_EQ(result_.refused, 1u);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The three nodes as processes: one run, and the consequences of killing each node. tests/benchmarks/nodes
// kills each node a hundred times.
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/process/node_processes.h"

namespace vps {
namespace {

using nlohmann::json;

class NodesProgram : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    // A pin that is set down on a plate, with the default device and operator. The pin is not guided: the
    // tolerance is six standard deviations of the aim, and the hand may aim twice.
    write("pin_down.toml",
          std::string(kScene) +
              "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 12]}\ntarget = {position = [0, 0, 9]}\n"
              "tolerance = '2mm'\n");
    nodes_.emplace(VPS_PROGRAM, (folder_ / "pin_down.toml").string(), "program-" + std::to_string(getpid()),
                   folder_);
  }
  void TearDown() override {
    nodes_.reset();
    Program::TearDown();
  }
  [[nodiscard]] std::string texts() const {
    return slurp(folder_ / "render.txt") + slurp(folder_ / "device.txt") + slurp(folder_ / "watch.txt");
  }

  std::optional<test::NodeProcesses> nodes_;
};

TEST_F(NodesProgram, ThreeProcessesRunASceneAndAllSayTheVerdict) {
  nodes_->startWatch();
  nodes_->startDevice();
  nodes_->startRender();
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
  EXPECT_EQ(nodes_->watch.wait(), 0) << texts();
  const json data = json::parse(slurp(folder_ / "run.json"));
  EXPECT_EQ(data["verdict"], "fits");
  EXPECT_GT(data["haptic"]["ticks"].get<long>(), 0);
  EXPECT_NE(slurp(folder_ / "watch.txt").find("step 1 of 1: pin"), std::string::npos) << texts();
  EXPECT_EQ(nodes_->segments(), 0u);
}

// The benchmark measures the bound of 20 ms on an idle machine. This test only requires that the device
// becomes safe, since the scheduler of a busy machine may keep the device from running for longer.
TEST_F(NodesProgram, ADeviceIsSafeWhenRenderIsKilledAndJoinsTheNextOne) {
  nodes_->startDevice();
  nodes_->startRender();
  ASSERT_TRUE(nodes_->join()) << texts();
  ASSERT_TRUE(nodes_->waitForHold()) << texts();
  ASSERT_TRUE(nodes_->waitForPhysics(0.2)) << texts();
  const std::int64_t killed_ns = nodes_->render.sendKill();
  EXPECT_TRUE(nodes_->safeAfter_s(killed_ns, 10).has_value()) << texts();
  nodes_->render.killNow();
  nodes_->startRender();
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
  EXPECT_NE(slurp(folder_ / "device.txt").find("the render node was lost"), std::string::npos) << texts();
  EXPECT_EQ(nodes_->segments(), 0u);
}

TEST_F(NodesProgram, PhysicsWaitsForAKilledDeviceAndTheNextOneFinishesTheStep) {
  nodes_->startDevice();
  nodes_->startRender();
  ASSERT_TRUE(nodes_->join()) << texts();
  ASSERT_TRUE(nodes_->waitForHold()) << texts();
  ASSERT_TRUE(nodes_->waitForPhysics(0.2)) << texts();
  nodes_->device.killNow();
  EXPECT_FALSE(nodes_->waitForPhysics(0.2, 0.5)) << texts();
  nodes_->startDevice();
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
  EXPECT_NE(slurp(folder_ / "render.txt").find("the device is back"), std::string::npos) << texts();
}

// In an earlier version the simulated motors had no command for longer than their watchdog allows, and the
// hand did nothing more in this step.
TEST_F(NodesProgram, ASimulatedDeviceThatWasHeldUpGoesOn) {
  nodes_->startDevice();
  nodes_->startRender();
  ASSERT_TRUE(nodes_->join()) << texts();
  ASSERT_TRUE(nodes_->waitForHold()) << texts();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(nodes_->waitForPhysics(0.5)) << texts();
    nodes_->device.holdUp(std::chrono::milliseconds(60));
  }
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
  EXPECT_GT(json::parse(slurp(folder_ / "run.json"))["wall"]["haptic"]["missed"].get<int>(), 100) << texts();
}

TEST_F(NodesProgram, AKilledWatcherHarmsNobody) {
  nodes_->startWatch();
  nodes_->startDevice();
  nodes_->startRender();
  ASSERT_TRUE(nodes_->join()) << texts();
  ASSERT_TRUE(nodes_->waitForPhysics(0.2)) << texts();
  nodes_->watch.killNow();
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
}

TEST_F(NodesProgram, ASecondRenderOfASessionIsRefused) {
  nodes_->startRender();
  ASSERT_TRUE(nodes_->join()) << texts();
  const Ran second = run("render pin_down.toml --out other --session program-" + std::to_string(getpid()));
  EXPECT_EQ(second.status, 2);
  EXPECT_NE(second.err.find("another vps render already runs this session"), std::string::npos) << second.err;
}

TEST_F(NodesProgram, BadSessionNamesAreRefused) {
  for (const char* command : {"render pin_down.toml", "device", "watch"})
    expectRefused(std::string(command) + " --session a/b", "letters, digits");
}

/// The nodes over UDP on this machine, with certificates.
class NodesOverUdp : public NodesProgram {
 protected:
  void SetUp() override {
    NodesProgram::SetUp();
    write("one.toml", kScene);
    if (run("render one.toml --network none0 --session a").err.find("has no network") != std::string::npos)
      GTEST_SKIP() << "this build has no network";
    if (std::system("command -v openssl >/dev/null 2>&1") != 0) GTEST_SKIP() << "openssl is not installed";
    for (const char* keys : {"keys", "foreign_keys"}) {
      const std::string command = "'" VPS_SOURCE_DIR "/scenes/make_certificates.sh' '" +
                                  (folder_ / keys).string() + "' render device watch > /dev/null";
      ASSERT_EQ(std::system(command.c_str()), 0);
    }
    nodes_.emplace(VPS_PROGRAM, (folder_ / "pin_down.toml").string(), session_, folder_, "lo");
  }
  /// Starts another process in the session. `security`: folder of certificates below the test's folder;
  /// empty: none.
  test::ChildProcess start(const std::string& command, const std::string& security,
                           const std::string& output) {
    std::vector<std::string> words = {VPS_PROGRAM, command, "--session", session_, "--network", "lo"};
    if (command == "watch") words.emplace_back("--terminal");
    if (!security.empty()) words.insert(words.end(), {"--security", (folder_ / security).string()});
    return {std::move(words), (folder_ / output).string()};
  }

  std::string session_ = "udp-program-" + std::to_string(getpid());
};

TEST_F(NodesOverUdp, WithoutCertificatesNobodyReadsOrMovesAnything) {
  nodes_->security = (folder_ / "keys/render").string();
  nodes_->startRender();
  {
    // A device without a certificate, a device with a certificate of another authority, and a watcher that
    // poses as a device.
    const test::ChildProcess bare = start("device", "", "bare.txt"),
                             foreign = start("device", "foreign_keys/device", "foreign.txt"),
                             posing = start("device", "keys/watch", "posing.txt"),
                             spy = start("watch", "", "spy.txt"),
                             foreign_spy = start("watch", "foreign_keys/watch", "foreign_spy.txt");
    const auto says = [this](const char* file, const char* words) {
      return test::NodeProcesses::waitFor(
          [&] { return slurp(folder_ / file).find(words) != std::string::npos; }, 30);
    };
    for (const char* file : {"bare.txt", "foreign.txt", "spy.txt", "foreign_spy.txt"})
      EXPECT_TRUE(says(file, "waiting for")) << file << ": " << slurp(folder_ / file);
    EXPECT_TRUE(says("posing.txt", "Not Allowed By Security")) << slurp(folder_ / "posing.txt");
    std::this_thread::sleep_for(std::chrono::seconds(2));  // time for two more attempts of each to join
  }
  for (const char* file : {"bare.txt", "foreign.txt", "posing.txt"})
    EXPECT_EQ(slurp(folder_ / file).find("joins"), std::string::npos) << slurp(folder_ / file);
  for (const char* file : {"spy.txt", "foreign_spy.txt"})
    EXPECT_EQ(slurp(folder_ / file).find("watching"), std::string::npos) << slurp(folder_ / file);
  EXPECT_EQ(texts().find("has joined"), std::string::npos) << texts();
  nodes_->security = (folder_ / "keys/watch").string();
  nodes_->startWatch();
  nodes_->security = (folder_ / "keys/device").string();
  nodes_->startDevice();
  EXPECT_EQ(nodes_->render.wait(), 0) << texts();
  EXPECT_EQ(nodes_->watch.wait(), 0) << texts();
}

// The topics of ROS 2 are not encrypted, so a session with certificates publishes them only if an option asks
// for them.
TEST_F(NodesOverUdp, RosTopicsOfASecuredSessionNeedAnOptionOfTheirOwn) {
  const std::string watch = "watch --network lo --session x --security keys/watch --ros 77";
  expectRefused(watch, "add --ros-in-clear");
  test::ChildProcess allowed(
      {VPS_PROGRAM, "watch", "--terminal", "--network", "lo", "--session", "x", "--security",
       (folder_ / "keys/watch").string(), "--ros", "77", "--ros-in-clear"},
      (folder_ / "allowed.txt").string());
  EXPECT_TRUE(test::NodeProcesses::waitFor(
      [&] { return slurp(folder_ / "allowed.txt").find("waiting for") != std::string::npos; }, 30));
  expectRefused("watch --session x --ros-in-clear", "--ros");
}

TEST_F(NodesOverUdp, InterfacesThatOthersReachNeedCertificates) {
  expectRefused("watch --network eth7 --session x", "add --security FOLDER");
  expectRefused("watch --network lo --session x --security nowhere", "has no ca.pem");
}

}  // namespace
}  // namespace vps

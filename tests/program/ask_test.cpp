// SPDX-License-Identifier: BSD-3-Clause
// vps ask, with real processes.
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/process/node_processes.h"

namespace vps {
namespace {

using test::ChildProcess;

/// Two pins that are set down on a plate without a guide.
class AskProgram : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("pins.toml", sceneText("'pins'"));
    write("other.toml", sceneText("'other pins'"));
  }
  void TearDown() override {
    for (ChildProcess* process : {&watch_, &render_, &device_}) process->killNow();
    fs::remove_all(out_);
    Program::TearDown();
  }
  static std::string sceneText(const std::string& name) {
    std::string text = "name = " + name + "\n" + kScene;
    text += "[[part]]\nfile = 'pin.stl'\nname = 'second'\npose = {position = [7, 0, 9.1]}\n";
    for (const char* step :
         {"part = 'pin'\nstart = {position = [0, 0, 12]}\ntarget = {position = [0, 0, 9]}\n",
          "part = 'second'\nstart = {position = [7, 0, 12]}\ntarget = {position = [7, 0, 9]}\n"})
      text += "[[step]]\n" + std::string(step) + "tolerance = '2mm'\n";
    return text;
  }
  ChildProcess start(std::vector<std::string> words, const std::string& output) {
    words.insert(words.begin(), VPS_PROGRAM);
    words.insert(words.end(), {"--session", session_});
    return {std::move(words), (folder_ / output).string()};
  }
  void startRender(std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"render",     (folder_ / "pins.toml").string(), "--no-pictures",
                                      "--cache",    (folder_ / "cache").string(),     "--out",
                                      out_.string()};
    words.insert(words.end(), more.begin(), more.end());
    render_ = start(std::move(words), "render.txt");
  }
  void startDevice() { device_ = start({"device", "--stay"}, "device.txt"); }
  Ran ask(const std::string& what) const { return run("ask " + what + " --session " + session_); }
  /// Waits until `vps ask who` prints these words.
  bool whoSays(const std::string& words, double limit_s = 60) {
    return test::NodeProcesses::waitFor(
        [&] {
          who_ = ask("who").out;
          return who_.find(words) != std::string::npos;
        },
        limit_s);
  }
  [[nodiscard]] std::string texts() const {
    return who_ + slurp(folder_ / "render.txt") + slurp(folder_ / "device.txt");
  }

  std::string session_ = "ask-" + std::to_string(getpid()), who_;
  /// A folder of its own, since a refused request must leave nothing unfinished in the test's folder.
  fs::path out_ = fs::temp_directory_path() / session_;
  ChildProcess render_, device_, watch_;
};

TEST_F(AskProgram, WhoIsThereAndWhatTheyDo) {
  expectRefused("ask who --session " + session_, "no vps render that accepts requests runs this session");
  startRender();
  ASSERT_TRUE(whoSays("device: none, the run waits for a device")) << texts();
  watch_ = start({"watch", "--terminal"}, "watch.txt");
  EXPECT_TRUE(whoSays("watchers: 1")) << texts();
  startDevice();
  EXPECT_TRUE(whoSays("step 1 of 2: 'pin' is in hand")) << texts();
  EXPECT_NE(who_.find("N/m"), std::string::npos) << who_;
  const Ran as_json = ask("who --json who.json");
  EXPECT_EQ(as_json.status, 0) << as_json.err;
  EXPECT_EQ(nlohmann::json::parse(slurp(folder_ / "who.json"))["done"], true);
  EXPECT_EQ(render_.wait(), 0) << texts();
}

TEST_F(AskProgram, PartsAreTakenAndReleasedOnRequest) {
  startRender({"--on-request"});
  startDevice();
  ASSERT_TRUE(whoSays("N/m")) << texts();  // the device has joined
  EXPECT_TRUE(whoSays("before its first step")) << texts();
  expectRefused("ask take second --session " + session_, "the next part is 'pin'");
  EXPECT_EQ(ask("take pin").out, "'pin' is taken next\n");
  ASSERT_TRUE(whoSays("'pin' is in hand")) << texts();
  expectRefused("ask take --session " + session_, "the hand has 'pin'");
  ASSERT_TRUE(whoSays("'pin' was let go of")) << texts();
  EXPECT_EQ(ask("gains 150").status, 0);
  EXPECT_EQ(ask("take").status, 0);
  ASSERT_TRUE(whoSays("'second' is in hand")) << texts();
  EXPECT_NE(who_.find("150 N/m"), std::string::npos) << who_;
  EXPECT_EQ(ask("release").status, 0);
  const int status = render_.wait();
  EXPECT_NE(slurp(folder_ / "render.txt").find("released on request"), std::string::npos) << texts();
  EXPECT_EQ(status, 3) << texts();  // not shown
}

TEST_F(AskProgram, AnotherSceneIsSentOnceRunsAndIsRecorded) {
  fs::remove(fs::current_path() / "run_2.mcap");  // the recording of a run that was stopped
  startRender({"--stay"});
  startDevice();
  ASSERT_TRUE(whoSays("step 1 of 2")) << texts();
  EXPECT_NE(ask("record run_2.mcap").out.find("the next run is recorded"), std::string::npos);
  expectRefused("ask record ../run.mcap --session " + session_, "without a folder");
  EXPECT_EQ(ask("load other.toml").out, "this run ends, and 'other pins' begins\n");
  ASSERT_TRUE(whoSays("'other pins' (scene")) << texts();
  EXPECT_NE(who_.find("run_2.mcap"), std::string::npos) << who_;
  const std::string hash = who_.substr(who_.find("(scene ") + 7, 32);
  EXPECT_TRUE(fs::exists(folder_ / "cache/scenes" / (hash + ".scene")));
  expectRefused("ask load 00000000000000000000000000000000 --session " + session_,
                "is unknown to this vps render");
  ASSERT_TRUE(whoSays("no run")) << texts();  // the run has ended, and render waits
  EXPECT_EQ(ask("stop-recording").status, 0);
  EXPECT_EQ(ask("load " + hash).status, 0);
  EXPECT_TRUE(whoSays("step 1 of 2")) << texts();
  EXPECT_EQ(who_.find("recorded in"), std::string::npos) << who_;
  render_.interrupt();
  render_.wait();
  // The recording is in the folder in which vps render was started.
  const fs::path file = fs::current_path() / "run_2.mcap";
  const Ran replayed = run("replay '" + file.string() + "' --out replayed");
  EXPECT_NE((replayed.out + replayed.err).find("the same bits"), std::string::npos)
      << replayed.out << replayed.err;
  fs::remove(file);
}

TEST_F(AskProgram, AWatcherAndTheDeviceReceiveARecordingOfTheRunThatReplaysBitForBit) {
  const auto file = [this](const char* name) { return (folder_ / name).string(); };
  const std::string kept = "ask_test_" + std::to_string(getpid()) + ".mcap";  // where vps render runs
  startRender();
  watch_ = start({"watch", "--terminal", "--record", file(kept.c_str())}, "watch.txt");
  ASSERT_TRUE(test::NodeProcesses::waitFor(
      [&] { return slurp(folder_ / "watch.txt").find("run is recorded in") != std::string::npos; }, 60))
      << texts() << slurp(folder_ / "watch.txt");
  device_ = start({"device", "--record", file("device.mcap")}, "device.txt");
  EXPECT_EQ(render_.wait(), 0) << texts();
  EXPECT_EQ(watch_.wait(), 0) << slurp(folder_ / "watch.txt");
  EXPECT_EQ(device_.wait(), 0) << texts();
  const std::string bytes = slurp(folder_ / kept);
  EXPECT_GT(bytes.size(), 1000u);
  EXPECT_TRUE(bytes == slurp(folder_ / "device.mcap"));
  const Ran replayed = run("replay '" + file("device.mcap") + "' --out replayed");
  EXPECT_NE((replayed.out + replayed.err).find("the same bits"), std::string::npos)
      << replayed.out << replayed.err;
  for (const char* name : {kept.c_str(), "device.mcap"}) fs::remove(fs::current_path() / name);
}

TEST_F(AskProgram, RightsAreRefusedInWords) {
  startRender({"--requests", "who"});
  ASSERT_TRUE(whoSays("render: 'pins'")) << texts();
  for (const char* what :
       {"take", "release", "rearm", "again", "gains 100", "record a.mcap", "load other.toml"})
    expectRefused("ask " + std::string(what) + " --session " + session_, "only `who` is allowed here");
  expectRefused("render pins.toml --requests none --stay --session x-" + session_,
                "contradicts --on-request and --stay");
}

/// Over UDP on this machine, with certificates.
TEST_F(AskProgram, OverANetworkWhoMayNotAskIsNotHeard) {
  if (run("render pins.toml --network none0 --session a").err.find("has no network") != std::string::npos)
    GTEST_SKIP() << "this build has no network";
  if (std::system("command -v openssl >/dev/null 2>&1") != 0) GTEST_SKIP() << "openssl is not installed";
  ASSERT_EQ(std::system(("'" VPS_SOURCE_DIR "/scenes/make_certificates.sh' '" + (folder_ / "keys").string() +
                         "' render watch operate > /dev/null")
                            .c_str()),
            0);
  startRender({"--network", "lo", "--security", (folder_ / "keys/render").string()});
  const std::string all = "ask who --network lo --session " + session_;
  ASSERT_TRUE(test::NodeProcesses::waitFor(
      [&] { return run(all + " --security keys/operate").out.find("render: 'pins'") != std::string::npos; },
      60))
      << texts();
  expectRefused(all, "no answer");
  expectRefused(all + " --security keys/watch", "Not Allowed By Security");
}

}  // namespace
}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C at moments that no command chooses: it ends soon, says so, and leaves no half-written file. A time
// limit and a bad file among several are told in time, too.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>

#include <unistd.h>

#include "program.h"

namespace vps {
namespace {

/// Far more than the second that a command takes, since machines that run tests may be busy.
constexpr double kMost_s = 20;

struct StoppedRun {
  int status = -1;
  double latency_s = 0;  ///< from the signal to the end; 0 if the command ended before
  std::string err;
};

class Stopping : public Program {
 protected:
  /// Starts a command in the folder and sends it a signal after some time.
  StoppedRun stopAfter(const std::string& arguments, double seconds, int signal) const {
    using Clock = std::chrono::steady_clock;
    const std::string command = "cd '" + folder_.string() + "' && XDG_CACHE_HOME='" + folder_.string() +
                                ".cache' exec '" VPS_PROGRAM "' " + arguments +
                                " >stdout.txt 2>stderr.txt </dev/null";
    const pid_t id = ::fork();
    if (id == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    const Clock::time_point sent = Clock::now();
    ::kill(id, signal);
    int status = 0;
    StoppedRun run;
    while (::waitpid(id, &status, WNOHANG) == 0) {
      run.latency_s = std::chrono::duration<double>(Clock::now() - sent).count();
      if (run.latency_s > kMost_s) ::kill(id, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    run.err = slurp(folder_ / "stderr.txt");
    return run;
  }

  [[nodiscard]] bool hasUnfinishedFiles() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      if (entry.path().filename().string().find(".unfinished") != std::string::npos) return true;
    return false;
  }

  /// Moments that are spread over the first seconds of a command, more densely at its beginning.
  static double moment(std::uint32_t i) {
    std::uint32_t x = 2654435761U * (i + 1);
    x ^= x >> 16U;
    const double share = static_cast<double>(x % 1000U) / 1000;
    return 0.01 + 0.6 * share * share;
  }
};

TEST_F(Stopping, ASignalAtAnyMomentEndsEachCommandSoonAndLeavesNoHalfWrittenFile) {
  const std::string block = VPS_SOURCE_DIR "/scenes/bearing_block/",
                    peg = VPS_SOURCE_DIR "/scenes/peg_in_hole/";
  const std::string commands[] = {
      "import " + block + "bearing_block.step -o made --force --no-cache --json import.json",
      "check " + block + "bearing_block.step --no-cache --json check.json --html check.html",
      "check " + peg + "scene.toml --no-cache --json check.json",
      "plan " + block + "bearing_block.step -o plan --no-cache",
      "assemble " + block + "scene.toml --out run --no-cache --json run.json",
      "simulate " + peg + "scene.toml --no-cache --json simulate.json",
      "study " + peg + "study.toml --log study.log --json study.json",
      "margin " + peg + "scene.toml --json margin.json",
      "export " + peg + "peg.stl --units mm -o peg.ply --no-cache",
  };
  // For a longer search: VPS_STOP_ROUNDS=20.
  const char* const wish = std::getenv("VPS_STOP_ROUNDS");
  const int rounds = wish == nullptr ? 1 : std::atoi(wish);
  std::uint32_t i = 0;
  for (int round = 0; round < rounds; ++round)
    for (const std::string& command : commands) {
      const int signal = i % 2 == 0 ? SIGINT : SIGTERM;
      const double after_s = moment(i++);
      const StoppedRun run = stopAfter(command, after_s, signal);
      SCOPED_TRACE(command + " after " + std::to_string(after_s) + " s\n" + run.err);
      EXPECT_LT(run.latency_s, kMost_s);
      // A signal before the program has begun to catch signals ends it by that signal.
      EXPECT_TRUE(run.status >= 0 || run.status == -signal) << run.status;
      EXPECT_FALSE(hasUnfinishedFiles() && run.status >= 0);
    }
}

TEST_F(Stopping, TheTimeLimitNamesTheWorkThatWasGoingOn) {
  expectRefused("import '" VPS_SOURCE_DIR
                "/scenes/bearing_block/bearing_block.step' -o made --no-cache --time-limit 0.001",
                "took more than 0.001 s to read (");
  EXPECT_FALSE(fs::exists(folder_ / "made"));
}

TEST_F(Stopping, ABadFileAmongSeveralIsToldBeforeTheOthersAreRead) {
  write("empty.stl", "");
  const std::string slow = "'" VPS_SOURCE_DIR "/scenes/bearing_block/bearing_block.step'";
  // Reading the first file would exceed the limit: the last file is therefore looked at before.
  for (const std::string command : {"check", "import -o made", "plan -o made"}) {
    expectRefused(command + " --no-cache --units mm --time-limit 0.001 " + slow + " empty.stl",
                  "empty.stl: is empty");
    expectRefused(command + " --no-cache --units mm --time-limit 0.001 " + slow + " cut.stl",
                  "cut.stl: is truncated");
    expectRefused(command + " --no-cache --units mm --time-limit 0.001 " + slow + " gone.stl",
                  "gone.stl: no such file");
    expectRefused(command + " --no-cache --time-limit 0.001 " + slow + " pin.stl", "pin.stl: ");
  }
}

}  // namespace
}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// A program that runs in parallel with a test.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

extern char** environ;

namespace vps::test {

/// Resources that a process uses.
struct Usage {
  double memory_MB = 0;
  long files = 0, threads = 0;
};

inline Usage usageOf(pid_t id) {
  const std::string folder = "/proc/" + std::to_string(id);
  Usage usage;
  std::ifstream status(folder + "/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> usage.memory_MB;
    if (word == "Threads:") status >> usage.threads;
  }
  usage.memory_MB /= 1024;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/fd", gone)) {
    (void)entry;
    ++usage.files;
  }
  return usage;
}

/// A process that runs until it ends by itself or is killed.
class ChildProcess {
 public:
  ChildProcess() = default;
  /// @param output  file to which its output is appended
  ChildProcess(std::vector<std::string> words, const std::string& output) {
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 1, output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&files, 1, 2);
    if (posix_spawn(&id_, argv[0], &files, nullptr, argv.data(), environ) != 0) id_ = 0;
    posix_spawn_file_actions_destroy(&files);
  }
  ChildProcess(ChildProcess&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  ChildProcess& operator=(ChildProcess&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~ChildProcess() { killNow(); }

  /// The id of the process; 0: there is no process.
  [[nodiscard]] pid_t id() const { return id_; }
  /// Asks the process to end, as Ctrl-C does.
  void interrupt() const {
    if (id_ > 0) kill(id_, SIGINT);
  }
  /// Does not wait for the process.
  [[nodiscard]] bool isRunning() const {
    siginfo_t info{};
    const bool is_known =
        id_ > 0 && waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0;
    return is_known && info.si_pid == 0;
  }
  /// Stops the process for this time, as if a busy machine did not schedule it.
  void holdUp(std::chrono::milliseconds time) const {
    if (id_ > 0) kill(id_, SIGSTOP);
    std::this_thread::sleep_for(time);
    if (id_ > 0) kill(id_, SIGCONT);
  }
  /// Kills the process without waiting for its end. Returns the time of the kill by the monotonic clock [ns].
  [[nodiscard]] std::int64_t sendKill() const {
    const std::int64_t now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                    std::chrono::steady_clock::now().time_since_epoch())
                                    .count();
    if (id_ > 0) kill(id_, SIGKILL);
    return now_ns;
  }
  /// Kills the process and waits for its end, after which the system has freed its memory.
  void killNow() {
    if (id_ <= 0) return;
    kill(id_, SIGKILL);
    waitpid(std::exchange(id_, 0), nullptr, 0);
  }
  /// Waits for the end of the process. Returns its exit status; -1: a signal ended it.
  int wait() {
    int status = -1;
    if (id_ > 0) waitpid(std::exchange(id_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t id_ = 0;
};

}  // namespace vps::test

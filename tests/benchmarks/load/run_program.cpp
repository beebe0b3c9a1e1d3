// SPDX-License-Identifier: BSD-3-Clause
#include "run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace vps::bench {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProgramRun runProgram(const std::vector<std::string>& words, const std::filesystem::path& output,
                      double limit_s) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t id = 0;
  const int error = posix_spawn(&id, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error("cannot start " + words.front());

  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
  ProgramRun run;
  int status = 0;
  rusage usage{};
  for (;;) {
    run.is_ended = wait4(id, &status, WNOHANG, &usage) == id;
    if (run.is_ended) break;
    if (elapsed_s() > limit_s) {
      kill(id, SIGKILL);
      wait4(id, &status, 0, &usage);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  run.wall_s = elapsed_s();
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  return run;
}

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
// The program and its terminal: messages and progress on stderr, Ctrl-C, and settings of the process (POSIX).
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <string_view>

#include "vps/errors.h"

namespace vps::viewer {

/// Whether stderr is a terminal.
bool isTerminal();

/// Prints "vps: WORDS" on stderr as one line; control characters become spaces.
void say(std::string words);
/// Prints "vps: warning: WORDS": the answer is valid, but the user should check its cause.
void warn(const std::string& words);

/// The process id, for names of temporary files.
long processId();

/// Makes the first Ctrl-C (or SIGTERM) set stopRequested(), so that the program can remove unfinished files
/// before it ends; a second signal ends the program at once.
void catchStop();
const std::atomic<bool>& stopRequested();

/// Thrown by long work after stopRequested().
struct Stopped : std::exception {
  [[nodiscard]] const char* what() const noexcept override {
    return "stopped; earlier results are untouched";
  }
};
void throwIfStopped();

/// Shows the progress of long work on stderr: on a terminal as a bar, from the first second on; elsewhere as
/// a line every ten seconds.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// A callback for the work, which refers to this bar. The callback throws Stopped after Ctrl-C.
  Progress progress() {
    return [this](std::string_view doing, double share) { show(doing, share); };
  }
  /// Clears the line for other output.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::string_view doing, double share);

  bool is_on_ = false;
  bool is_drawn_ = false;
  Clock::time_point begun_, drawn_;
};

/// Lowers the priority of this process, so that others run first on a busy processor. Threads that are
/// started later get the lower priority, too.
void giveWay();

/// Gives threads that are started later stacks of 1 MiB. A process that drives a device locks its memory, so
/// the whole stack of a thread occupies memory, also after the thread has ended, until another thread reuses
/// it.
void limitStacks();

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Messages on stderr, and the POSIX functions of the program: terminal, process id and Ctrl-C.
#pragma once

#include <atomic>
#include <exception>
#include <string>

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
/// before it ends; a second one ends it at once.
void catchStop();
const std::atomic<bool>& stopRequested();

/// Thrown by long work after stopRequested().
struct Stopped : std::exception {
  [[nodiscard]] const char* what() const noexcept override {
    return "stopped; earlier results are untouched";
  }
};
void throwIfStopped();

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The little of POSIX that a command line needs: is anybody watching, and did they press Ctrl-C. And how it
// speaks on stderr.
#pragma once

#include <atomic>
#include <exception>
#include <string>

namespace vps::viewer {

/// Is stderr a terminal?
bool isTerminal();

/// Prints "vps: WORDS" on stderr as one line, whatever the words hold.
void say(std::string words);
/// The same with "warning: " before the words: the answer stands, but should be looked at.
void warn(const std::string& words);

/// This process's number, for names of temporary files.
long processId();

/// Makes the first Ctrl-C (or SIGTERM) set stopRequested(), so that unfinished files are removed on the way
/// out; a second one ends the program at once.
void catchStop();
const std::atomic<bool>& stopRequested();

/// Thrown where long work notices the request.
struct Stopped : std::exception {
  [[nodiscard]] const char* what() const noexcept override {
    return "stopped; earlier results are untouched";
  }
};
void throwIfStopped();

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "output/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace vps::viewer {

namespace {
std::atomic<bool> is_stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not wait for a lock");

void onStop(int) {
  is_stop_requested.store(true, std::memory_order_relaxed);
}
}  // namespace

bool isTerminal() {
  return isatty(STDERR_FILENO) == 1;
}

void say(std::string words) {
  std::replace_if(
      words.begin(), words.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  words.erase(words.find_last_not_of(' ') + 1);
  std::fprintf(stderr, "vps: %s\n", words.c_str());
}

void warn(const std::string& words) {
  say("warning: " + words);
}

long processId() {
  return getpid();
}

void catchStop() {
  struct sigaction action = {};
  action.sa_handler = onStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second signal has its default effect
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const std::atomic<bool>& stopRequested() {
  return is_stop_requested;
}

void throwIfStopped() {
  if (is_stop_requested.load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace vps::viewer

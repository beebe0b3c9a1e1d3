// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.h"

#include <unistd.h>

#include <csignal>

namespace vps {

namespace {
std::atomic<bool> is_stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch it");

void onStop(int) {
  is_stop_requested.store(true, std::memory_order_relaxed);
}
}  // namespace

bool isTerminal() {
  return isatty(STDERR_FILENO) == 1;
}

long processId() {
  return getpid();
}

void catchStop() {
  struct sigaction action = {};
  action.sa_handler = onStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second one has its usual effect
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const std::atomic<bool>& stopRequested() {
  return is_stop_requested;
}

void throwIfStopped() {
  if (is_stop_requested.load(std::memory_order_relaxed)) throw Stopped();
}

}  // namespace vps

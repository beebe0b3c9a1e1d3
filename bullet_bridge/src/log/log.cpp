// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/log.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <utility>

#include "log/report.h"

namespace vps::bullet {

namespace {

using Clock = std::chrono::steady_clock;

struct Log {
  std::mutex mutex;
  LogHook hook;
  LogLevel least = LogLevel::Warning;
  Clock::time_point second_began;
  int passed = 0;  ///< messages passed in the second that began at second_began
  int dropped = 0;
};

Log& theLog() {
  static Log log;
  return log;
}

/// Returns false if the limit of messages is reached. Otherwise sets `dropped` to the number of messages
/// dropped before this one.
bool mayPass(Log& log, int& dropped) {
  const Clock::time_point now = Clock::now();
  if (now - log.second_began >= std::chrono::seconds(1)) {
    log.second_began = now;
    log.passed = 0;
  }
  if (log.passed >= kLogLimit) {
    ++log.dropped;
    return false;
  }
  ++log.passed;
  dropped = std::exchange(log.dropped, 0);
  return true;
}

}  // namespace

void setLogHook(LogHook hook) {
  Log& log = theLog();
  const std::lock_guard lock(log.mutex);
  log.hook = std::move(hook);
  log.passed = log.dropped = 0;
}

void setLogLevel(LogLevel least) {
  Log& log = theLog();
  const std::lock_guard lock(log.mutex);
  log.least = least;
}

void report(LogLevel level, const std::string& message) noexcept {
  try {
    Log& log = theLog();
    LogHook hook;
    int dropped = 0;
    {
      const std::lock_guard lock(log.mutex);
      if (level < log.least || !mayPass(log, dropped)) return;
      hook = log.hook;
    }
    std::string words = message;
    if (dropped > 0)
      words.append(" (").append(std::to_string(dropped)).append(" messages before this one were left out)");
    if (hook)
      hook(level, words);
    else
      std::fprintf(stderr, "vps: %s\n", words.c_str());
  } catch (...) {  // out of memory, or a hook that throws: the step must continue
  }
}

namespace {

std::atomic<bool> g_is_installed{false};
std::atomic<int> g_boxes{0};

}  // namespace

void setContactInstalled() {
  g_is_installed = true;
}

bool isContactInstalled() {
  return g_is_installed.load(std::memory_order_relaxed);
}

void warnOfForgottenInstall() {
  // Bullet requests a body's box once when it is added and once per step. Assumed: a world with one part that
  // is stepped for a hundredth of a second.
  constexpr int kBoxes = 12;
  if (++g_boxes != kBoxes) return;
  report(LogLevel::Error,
         "a bullet::Shape is in a world, and install() was not called for any dispatcher: the Shape collides "
         "with nothing, or as a mesh that Bullet does not support. Call vps::bullet::install(dispatcher) "
         "before the first step");
}

}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause
#include "output/terminal.h"

#if defined(__unix__)
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#endif
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstddef>
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

namespace {

/// "42 %: "; empty if the share is not known.
std::string inWords(double share) {
  if (!std::isfinite(share)) return {};
  return std::to_string(static_cast<int>(100 * std::clamp(share, 0.0, 1.0))).append(" %: ");
}

}  // namespace

ProgressBar::ProgressBar() : is_on_(isTerminal()), begun_(Clock::now()), drawn_(begun_) {}

void ProgressBar::show(std::string_view doing, double share) {
  throwIfStopped();
  const auto now = Clock::now();
  if (!is_on_) {
    constexpr auto kSayEvery = std::chrono::seconds(10);
    if (now - drawn_ < kSayEvery) return;
    drawn_ = now;
    say(inWords(share) + std::string(doing));
    return;
  }
  // The bar is drawn at most ten times a second.
  if (now - begun_ < std::chrono::seconds(1) || (is_drawn_ && now - drawn_ < std::chrono::milliseconds(100)))
    return;
  drawn_ = now;
  is_drawn_ = true;
  constexpr int kWidth = 30;
  constexpr std::size_t kWords = 40;
  share = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0;
  const int filled = static_cast<int>(share * kWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3d %% %.*s", bar.c_str(), static_cast<int>(100 * share),
               static_cast<int>(std::min(doing.size(), kWords)), doing.data());
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (is_drawn_) std::fputs("\r\033[K", stderr);
  is_drawn_ = false;
}

void giveWay() {
#if defined(__unix__)
#ifdef SCHED_BATCH
  // A batch thread that wakes up does not preempt another thread, however long it has slept.
  const sched_param none{};
  sched_setscheduler(0, SCHED_BATCH, &none);  // if the system refuses, nothing changes
#endif
  constexpr int kNice = 10;
  if (getpriority(PRIO_PROCESS, 0) < kNice) setpriority(PRIO_PROCESS, 0, kNice);
#endif
}

void limitStacks() {
#ifdef __GLIBC__
  constexpr std::size_t kStack_bytes = 1024 * 1024;  // assumed: four times a haptic thread's need
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return;
  if (pthread_attr_setstacksize(&attributes, kStack_bytes) == 0) pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
#endif
}

}  // namespace vps::viewer

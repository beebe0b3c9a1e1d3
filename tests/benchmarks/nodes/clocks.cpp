// SPDX-License-Identifier: BSD-3-Clause
// Two nodes whose clocks differ, over UDP on loopback. The other node is a process in a time namespace, whose
// monotonic clock is 3 s ahead; its drift is simulated, since a kernel does not provide one.
#include <dlfcn.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "link/link.h"
#include "rows.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"

namespace vps::bench {

namespace {

constexpr double kDrift = 100e-6;
constexpr double kBar_s = 50e-6;
constexpr std::int64_t kAhead_ns = 3'000'000'000;

std::int64_t drift_from_ns = 0;  ///< time of this process's clock from which it drifts; 0: no drift

int systemTime(clockid_t clock, timespec* time) noexcept {
  using Call = int (*)(clockid_t, timespec*);
  static const Call call = reinterpret_cast<Call>(dlsym(RTLD_NEXT, "clock_gettime"));
  return call(clock, time);
}
std::int64_t toNs(const timespec& time) {
  return 1'000'000'000 * static_cast<std::int64_t>(time.tv_sec) + time.tv_nsec;
}
std::int64_t systemNow_ns() {
  timespec time{};
  systemTime(CLOCK_MONOTONIC, &time);
  return toNs(time);
}

/// The state of the other node's clock, which that node writes.
struct Other {
  std::atomic<std::int64_t> drift_from_ns{0};  ///< time of the other clock from which the other clock drifts
  std::atomic<bool> is_refused{false};
};

[[noreturn]] void beOther(const std::string& session, Other& other) {
  drift_from_ns = systemNow_ns();
  other.drift_from_ns = drift_from_ns;
  std::unique_ptr<scenes::Link> link;
  while ((link = scenes::joinSession(session, scenes::NodeRole::Device, "lo")) == nullptr) usleep(1000);
  for (;;) pause();
}

/// Starts the other node by a process that creates a time namespace for its children. Returns the process
/// that creates the namespace.
pid_t startOther(const std::string& session, Other& other) {
  const pid_t first = fork();
  if (first != 0) return first;
  setpgid(0, 0);  // its child belongs to the same group
  bool is_made = unshare(CLONE_NEWTIME) == 0;
  if (is_made) {
    std::ofstream offsets("/proc/self/timens_offsets");
    offsets << "monotonic " << kAhead_ns / 1'000'000'000 << " 0" << std::flush;
    is_made = offsets.good();
  }
  other.is_refused = !is_made;
  if (is_made && fork() == 0) beOther(session, other);
  for (;;) pause();
}

}  // namespace

bool clockRow(double seconds) {
  const char* what = "clock 3 s ahead that gains 100 ppm, UDP on lo";
  const char* bar = "estimated within 50 us";
  const std::string session = "bench-clock-" + std::to_string(getpid());
  auto* other = static_cast<Other*>(
      mmap(nullptr, sizeof(Other), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  new (other) Other;
  // The other node is started before this process has threads of DDS. The other node's process group is
  // killed at the end.
  const pid_t group = startOther(session, *other);
  setpgid(group, group);
  std::unique_ptr<scenes::Link> render;
  try {
    render = scenes::makeSession(session, "no scene", "lo");
  } catch (const LoadError& error) {
    kill(-group, SIGKILL);
    waitpid(group, nullptr, 0);
    printRow(what, bar, error.what(), false);
    return false;
  }
  double worst_s = 0, worst_bound_s = 0, drift = 0;
  int count = 0, outside = 0;
  const std::int64_t begun_ns = systemNow_ns();
  constexpr double kSettle_s = 5;  // the estimate of the drift needs a history of exchanges
  for (double now_s = 0; now_s < seconds && !other->is_refused;) {
    usleep(20'000);
    now_s = 1e-9 * static_cast<double>(systemNow_ns() - begun_ns);
    const std::int64_t before_ns = systemNow_ns();
    const auto timing = render->timing(scenes::NodeRole::Device);
    if (!timing || now_s < kSettle_s) continue;
    // The true value that the other clock shows at a time of this clock.
    const double since_s = 1e-9 * static_cast<double>(before_ns + kAhead_ns - other->drift_from_ns);
    const double error_s = std::abs(timing->clock_offset_s - (1e-9 * kAhead_ns + kDrift * since_s));
    worst_s = std::max(worst_s, error_s);
    worst_bound_s = std::max(worst_bound_s, timing->clock_error_s);
    outside += error_s > timing->clock_error_s;
    drift = timing->clock_drift;
    ++count;
  }
  kill(-group, SIGKILL);
  waitpid(group, nullptr, 0);
  const bool is_refused = other->is_refused;
  munmap(other, sizeof(Other));
  if (is_refused) {
    printRow(what, bar, "the system makes no time namespaces", false);
    return false;
  }
  char words[200];
  std::snprintf(words, sizeof words,
                "off by %.1f us at most in %d looks, %d of them by more than the stated bound (%.1f us at "
                "most); drift %.1f ppm",
                1e6 * worst_s, count, outside, 1e6 * worst_bound_s, 1e6 * drift);
  const bool is_reached = count > 0 && worst_s <= kBar_s && outside == 0;
  printRow(what, bar, words, is_reached);
  return is_reached;
}

}  // namespace vps::bench

/// This program and the libraries that it loads read the clock by this function.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using namespace vps::bench;
  const int result = systemTime(clock, time);
  if (result != 0 || clock != CLOCK_MONOTONIC || drift_from_ns == 0) return result;
  const std::int64_t now_ns = toNs(*time);
  const auto gained_ns = static_cast<std::int64_t>(kDrift * static_cast<double>(now_ns - drift_from_ns));
  time->tv_sec = (now_ns + gained_ns) / 1'000'000'000;
  time->tv_nsec = (now_ns + gained_ns) % 1'000'000'000;
  return 0;
}

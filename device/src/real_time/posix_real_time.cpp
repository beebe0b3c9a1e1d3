// SPDX-License-Identifier: BSD-3-Clause
// Clocks, priorities and memory locking by POSIX; the only file of this folder that calls it.
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "vps_device/device.h"
#include "vps_device/periodic_thread.h"

namespace vps::device {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class MonotonicClock final : public RealTimeClock {
 public:
  [[nodiscard]] std::int64_t now_ns() noexcept override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * kSecond_ns + now.tv_nsec;
  }
  void sleepUntil(std::int64_t time_ns) noexcept override {
    const timespec until{time_ns / kSecond_ns, time_ns % kSecond_ns};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
};

std::string refusal(DeviceEventKind kind, int error) {
  return std::string(toText(kind)) + " (" + std::strerror(error) + "); " + remedyOf(kind);
}

// If locked memory is limited, only the present pages are locked: later allocations would fail otherwise.
int lockMemory() {
  rlimit limit{};
  const bool is_free =
      geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  return mlockall(is_free ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0 ? 0 : errno;
}

// Constant-initialised: a function's static variable might be initialised, and allocate, on the haptic
// thread.
constinit MonotonicClock the_monotonic_clock;  // the clock has no state

}  // namespace

RealTimeClock& monotonicClock() noexcept {
  return the_monotonic_clock;
}

void leaveRealTime() noexcept {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
}

RealTimeReport requestRealTime(int priority, bool locks_memory) {
  RealTimeReport report;
  if (priority > 0) {
    const sched_param wish{priority};
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wish);
    report.has_priority = error == 0;
    if (error != 0) report.warnings.push_back(refusal(DeviceEventKind::NoPriority, error));
  }
  if (locks_memory) {
    const int error = lockMemory();
    report.has_locked_memory = error == 0;
    if (error != 0) report.warnings.push_back(refusal(DeviceEventKind::NotLocked, error));
  }
  return report;
}

}  // namespace vps::device

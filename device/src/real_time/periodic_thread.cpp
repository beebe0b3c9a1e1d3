// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/periodic_thread.h"

#include <cmath>
#include <future>
#include <utility>

#include "vps/errors.h"

namespace vps::device {
namespace {

constexpr std::size_t kStack_bytes = 256 * 1024;  // assumed: a tick needs some kilobytes
constexpr std::size_t kPage_bytes = 4096;

// Touches the stack's pages once. The pointer is volatile, so that the compiler keeps the writes.
void touchStack() noexcept {
  char room[kStack_bytes];
  volatile char* const page = room;
  for (std::size_t i = 0; i < kStack_bytes; i += kPage_bytes) page[i] = 0;
}

}  // namespace

PeriodicThread::PeriodicThread(const PeriodicSettings& settings) : settings_(settings) {
  if (!(settings.rate_hz >= 1 && settings.rate_hz <= 1e5))
    throw LoadError("", "",
                    "a rate of " + std::to_string(settings.rate_hz) +
                        " Hz cannot be kept; choose one from 1 to 100000 Hz");
}

PeriodicThread::~PeriodicThread() {
  is_ending_.store(true);
  if (thread_.joinable()) thread_.join();
}

RealTimeReport PeriodicThread::start(std::function<void(const Beat&)> work) {
  stop();
  is_ending_.store(false);
  std::promise<RealTimeReport> asked;
  std::future<RealTimeReport> answer = asked.get_future();
  thread_ = std::thread([this, work = std::move(work), asked = std::move(asked)]() mutable {
    RealTimeReport report = requestRealTime(settings_.priority, settings_.locks_memory);
    touchStack();
    is_running_.store(true, std::memory_order_release);
    asked.set_value(std::move(report));
    run(work);
    is_running_.store(false, std::memory_order_release);
  });
  return answer.get();
}

void PeriodicThread::run(const std::function<void(const Beat&)>& work) {
  RealTimeClock& clock = settings_.clock != nullptr ? *settings_.clock : monotonicClock();
  Metronome metronome(std::llround(1e9 / settings_.rate_hz), clock);
  metronome.start();
  try {
    while (!is_ending_.load(std::memory_order_relaxed)) work(metronome.wait());
  } catch (...) {
    failure_ = std::current_exception();
  }
}

void PeriodicThread::stop() {
  is_ending_.store(true);
  if (thread_.joinable()) thread_.join();
  if (const std::exception_ptr failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
}

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/real_time_loop.h"

#include <cmath>

namespace vps::device {
namespace {

constexpr std::int64_t kQuietTicks = 1000;  // misses are reported once, and again after this many good ticks

RealTimeClock& clockOf(const RealTimeSettings& settings) {
  return settings.clock != nullptr ? *settings.clock : monotonicClock();
}

LoopSettings watched(LoopSettings settings, const RealTimeSettings& real_time) {
  if (!(settings.physics_limit_s > 0)) settings.physics_limit_s = real_time.physics_limit_s;
  return settings;
}

std::int64_t nanoseconds(double s) {
  return std::llround(1e9 * s);
}

}  // namespace

DeviceSample TimedDevice::read() noexcept {
  const std::int64_t begun_ns = clock_->now_ns();
  const DeviceSample sample = device_->read();
  spent_ns_ += clock_->now_ns() - begun_ns;
  return sample;
}

void TimedDevice::write(const Wrench& F_Ho_D) noexcept {
  const std::int64_t begun_ns = clock_->now_ns();
  device_->write(F_Ho_D);
  spent_ns_ += clock_->now_ns() - begun_ns;
}

std::int64_t TimedDevice::takeSpent_ns() noexcept {
  const std::int64_t spent_ns = spent_ns_;
  spent_ns_ = 0;
  return spent_ns;
}

RealTimeLoop::RealTimeLoop(Device& device, CouplingPort& port, const LoopSettings& settings,
                           const RealTimeSettings& real_time)
    : settings_(real_time),
      clock_(&clockOf(real_time)),
      events_(settings.events),
      device_(device, *clock_),
      loop_(device_, port, watched(settings, real_time)),
      thread_({1 / settings.period_s, real_time.priority, real_time.locks_memory, real_time.clock}),
      statistics_(nanoseconds(real_time.stale_s)) {}

RealTimeLoop::~RealTimeLoop() {
  stop();
}

RealTimeReport RealTimeLoop::start() {
  stop();
  const RealTimeReport report = thread_.start([this](const Beat& beat) { this->beat(beat); });
  lacks_priority_.store(settings_.priority > 0 && !report.has_priority);
  lacks_locking_.store(settings_.locks_memory && !report.has_locked_memory);
  return report;
}

void RealTimeLoop::stop() {
  const bool was_running = thread_.isRunning();
  thread_.stop();
  if (was_running) device_.write({});  // the motors hold the last command
}

void RealTimeLoop::beat(const Beat& beat) noexcept {
  const std::int64_t begun_ns = clock_->now_ns();
  if (beat.has_clock_gone_back) loop_.latchFault(SafetyFault::ClockBackwards);
  reportMisses(beat);
  reportRefusals();
  handleRequests();
  loop_.receivePart();
  if (settings_.before_tick) settings_.before_tick(loop_, beat.periods);
  const double dt_s = loop_.settings().period_s * static_cast<double>(beat.periods);
  device_.takeSpent_ns();
  loop_.tickWithReceivedPart(dt_s);
  const std::int64_t done_ns = clock_->now_ns();

  TickTiming timing;
  timing.tick = loop_.ticks();
  timing.late_ns = begun_ns - beat.due_ns;
  timing.device_ns = device_.takeSpent_ns();
  timing.own_ns = done_ns - begun_ns - timing.device_ns;
  timing.snapshot_ns = nanoseconds(loop_.isHolding() ? loop_.snapshotAge_s() : 0);
  if (settings_.after_tick) settings_.after_tick(loop_, dt_s);
  timing.after_tick_ns = clock_->now_ns() - done_ns;
  statistics_.add(timing);
  timing_before_ = timing;
}

void RealTimeLoop::reportMisses(const Beat& beat) noexcept {
  if (beat.missed_before > 0)
    statistics_.miss(static_cast<std::uint64_t>(beat.missed_before), timing_before_.cause(true));
  if (beat.missed_asleep > 0)
    statistics_.miss(static_cast<std::uint64_t>(beat.missed_asleep), TickCause::WokenLate);
  const std::int64_t missed = beat.periods - 1;
  if (missed > 0 && quiet_ticks_ <= 0 && events_ != nullptr)
    events_->push({loop_.last().time_s, DeviceEventKind::TicksMissed, static_cast<double>(missed)});
  quiet_ticks_ = missed > 0 ? kQuietTicks : quiet_ticks_ - 1;
}

// The event queue has one writer, this thread.
void RealTimeLoop::reportRefusals() noexcept {
  const auto report = [this](std::atomic<bool>& is_unreported, DeviceEventKind kind) {
    if (!is_unreported.load(std::memory_order_relaxed)) return;
    is_unreported.store(false, std::memory_order_relaxed);
    if (events_ != nullptr) events_->push({loop_.last().time_s, kind, 0});
  };
  report(lacks_priority_, DeviceEventKind::NoPriority);
  report(lacks_locking_, DeviceEventKind::NotLocked);
}

void RealTimeLoop::handle(const Request& request) noexcept {
  switch (request.kind) {
    case Request::Grasp:
      return loop_.grasp(request.X_WG);
    case Request::HandOver:
      return loop_.handOver(request.X_WG);
    case Request::Disengage:
      return loop_.disengage();
    case Request::Engage:
      return loop_.engage();
    case Request::Release:
      return loop_.release();
    case Request::Rearm:
      return loop_.rearm();
    case Request::Gains:
      return loop_.setGains(request.gains);
    case Request::Call:
      if (settings_.on_call) settings_.on_call(loop_, request.code);
      return;
  }
}

bool RealTimeLoop::post(const Request& request) noexcept {
  const std::size_t posted = posted_.load(std::memory_order_relaxed);
  if (posted - handled_.load(std::memory_order_acquire) == kRequests) return false;
  requests_[posted % kRequests] = request;
  posted_.store(posted + 1, std::memory_order_release);
  return true;
}

void RealTimeLoop::handleRequests() noexcept {
  const std::size_t posted = posted_.load(std::memory_order_acquire);
  std::size_t handled = handled_.load(std::memory_order_relaxed);
  for (; handled != posted; ++handled) handle(requests_[handled % kRequests]);
  handled_.store(handled, std::memory_order_release);
}

}  // namespace vps::device

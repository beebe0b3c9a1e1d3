// SPDX-License-Identifier: BSD-3-Clause
// The replay of a real-time run in simulated time: the order in which haptic and physics threads exchanged
// state is read from its recording.
#include <deque>
#include <utility>
#include <vector>

#include "haptics/clocked_driver.h"
#include "simulation/tick_times.h"

namespace vps::scenes {
namespace {

class ReplayedDriver final : public ClockedDriver {
 public:
  ReplayedDriver(Hand& hand, std::vector<RecordedEvent> events, device::Device& device,
                 device::CouplingPort& port, const device::LoopSettings& settings, const ReportFault& report,
                 device::RunLog& log)
      : ClockedDriver(settings, report),
        hand_(hand),
        port_(port),
        loop_(device, port, settings),
        device_(device),
        events_(std::move(events)),
        log_(log),
        clock_(settings.period_s) {}

  void pause() override {
    if (!is_running_) return;
    is_running_ = false;
    if (!tickUntil(device::SyncEventKind::Paused)) return;
    device_.write({});
    logEvent(device::SyncEventKind::Paused);
    setView(loop_.state());
  }
  void resume() override {
    rearmIfFaulted();
    is_running_ = true;
  }

  bool advance() override {
    // A loop in another process may have been re-armed while physics continued. After a departure from the
    // recording, events that do not fit are skipped.
    while (next_ < events_.size() && !tickUntil(device::SyncEventKind::Step)) {
      if (isAt(device::SyncEventKind::Rearm))
        command({device::SyncEventKind::Rearm, {}, 0, 0, {}});
      else
        ++next_;
    }
    if (!isAt(device::SyncEventKind::Step)) return false;
    logEvent(device::SyncEventKind::Step);
    setView(port_.haptic.read());  // the state after the last tick, without the commands since then
    return true;
  }
  bool hasSettled(bool) override {
    if (!isAt(device::SyncEventKind::Settled)) return false;
    logEvent(device::SyncEventKind::Settled);
    return true;
  }
  bool snaps(bool) override {
    using enum device::SyncEventKind;
    if (isAt(SnapOn) || isAt(SnapOff)) {
      snaps_ = isAt(SnapOn);
      logEvent(events_[next_].event.kind);
    }
    return snaps_;
  }
  bool givesUp(bool) override {
    if (!isAt(device::SyncEventKind::GiveUp)) return false;
    logEvent(device::SyncEventKind::GiveUp);
    return true;
  }
  device::OperatorState state() override { return hand_state_; }
  std::uint64_t missed() override { return 0; }
  TickTimes times() override { return clock_.summary(); }
  std::optional<RealTimeResult> realTime() override { return {}; }

 protected:
  void command(const HandCommand& command) override {
    prepare(hand_, command);
    const bool is_recorded = tickUntil(command.what);
    carryOut(hand_, loop_, command);
    if (is_recorded) logEvent(command.what);
  }
  void store(const device::PhysicsState& state) override { states_.push_back(state); }

 private:
  [[nodiscard]] bool isAt(device::SyncEventKind kind) const {
    return next_ < events_.size() && events_[next_].event.kind == kind;
  }

  /// Runs the ticks before the next event of the physics thread. The result is true if the next event has the
  /// kind `kind`. A cut recording has no samples left for further ticks.
  bool tickUntil(device::SyncEventKind kind) {
    while (isAt(device::SyncEventKind::Tick) || isAt(device::SyncEventKind::Silent)) {
      if (isAt(device::SyncEventKind::Silent)) {
        loop_.latchFault(device::SafetyFault::PhysicsStalled);
        logEvent(device::SyncEventKind::Silent);
        continue;
      }
      if (!hand_.canGoOn(1)) {
        next_ = events_.size();
        return false;
      }
      tick(events_[next_].event);
    }
    return isAt(kind);
  }

  void tick(const device::SyncEvent& event) {
    while (states_.size() > 1 && states_.front().step < event.snapshot) states_.pop_front();
    if (!states_.empty() && states_.front().step <= event.snapshot) port_.physics.write(states_.front());
    loop_.receivePart();
    logEvent(device::SyncEventKind::Tick);
    clock_.start();
    loop_.tickWithReceivedPart(event.periods * settings_.period_s);
    clock_.stop();
  }

  /// Logs the next recorded event with the numbers of this run.
  void logEvent(device::SyncEventKind kind) {
    hand_state_ = events_[next_].hand;
    const device::SyncEvent& event = events_[next_++].event;
    const std::uint64_t ticks = loop_.ticks() + (kind == device::SyncEventKind::Tick ? 1 : 0);
    log_.add(device::SyncEvent{loop_.last().time_s, static_cast<std::int32_t>(ticks), event.periods,
                               event.snapshot, kind});
  }

  Hand& hand_;
  device::CouplingPort& port_;
  device::HapticLoop loop_;
  device::Device& device_;
  std::vector<RecordedEvent> events_;
  std::size_t next_ = 0;
  device::RunLog& log_;
  std::deque<device::PhysicsState> states_;  ///< states published and not yet used by a tick
  TickClock clock_;
  device::OperatorState hand_state_;  ///< state of the hand at the last event
  bool is_running_ = false, snaps_ = false;
};

}  // namespace

std::unique_ptr<HapticDriver> makeReplayedDriver(Hand& hand, std::vector<RecordedEvent> events,
                                                 device::Device& device, device::CouplingPort& port,
                                                 const device::LoopSettings& settings,
                                                 const ReportFault& report, device::RunLog& log) {
  return std::make_unique<ReplayedDriver>(hand, std::move(events), device, port, settings, report, log);
}

}  // namespace vps::scenes

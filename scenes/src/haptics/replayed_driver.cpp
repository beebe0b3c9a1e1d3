// SPDX-License-Identifier: BSD-3-Clause
// A run by the clock again, without a clock: who met whom when is read from its recording.
#include <deque>
#include <utility>
#include <vector>

#include "core/tick_times.h"
#include "haptics/clocked_driver.h"

namespace vps::scenes {
namespace {

class ReplayedDriver final : public ClockedDriver {
 public:
  ReplayedDriver(Hand& hand, std::vector<device::SyncEvent> sync_events, device::Device& device,
                 CouplingPort& port, const device::LoopSettings& settings, const TellFault& tell,
                 device::RunLog& log)
      : ClockedDriver(hand, settings, tell),
        port_(port),
        loop_(device, port, settings),
        device_(device),
        sync_events_(std::move(sync_events)),
        log_(log),
        clock_(settings.period_s) {}

  void pause() override {
    if (!is_running_) return;
    is_running_ = false;
    if (!goTo(device::SyncEventKind::Paused)) return;
    device_.write({});
    note(device::SyncEventKind::Paused);
    look(LoopView::of(loop_, hand_.phase()));
  }
  void resume() override {
    rearmIfFaulted();
    is_running_ = true;
  }

  bool advance(const HeldPart&) override {
    while (next_ < sync_events_.size() && !goTo(device::SyncEventKind::Step)) ++next_;  // beyond a departure
    if (!isAt(device::SyncEventKind::Step)) return false;
    note(device::SyncEventKind::Step);
    look(ticked_);
    return true;
  }
  bool hasSettled(bool) override {
    if (!isAt(device::SyncEventKind::Settled)) return false;
    note(device::SyncEventKind::Settled);
    return true;
  }
  device::OperatorPhase phase() override { return hand_.phase(); }
  std::uint64_t missed() override { return 0; }
  TickTimes times() override { return clock_.summary(); }
  std::optional<RealTimeResult> realTime() override { return {}; }

 protected:
  void order(device::SyncEventKind what) override {
    const bool is_met = goTo(what);
    obey(loop_, what);
    if (is_met) note(what);
  }
  void store(const PhysicsSnapshot& snapshot) override { snapshots_.push_back(snapshot); }

 private:
  [[nodiscard]] bool isAt(device::SyncEventKind kind) const {
    return next_ < sync_events_.size() && sync_events_[next_].kind == kind;
  }

  /// Ticks on until physics is met, and says whether it is for this. A cut recording has no more to tick
  /// with.
  bool goTo(device::SyncEventKind kind) {
    while (isAt(device::SyncEventKind::Tick)) {
      if (!hand_.canGoOn(1)) {
        next_ = sync_events_.size();
        return false;
      }
      tick(sync_events_[next_]);
    }
    return isAt(kind);
  }

  void tick(const device::SyncEvent& met) {
    while (snapshots_.size() > 1 && snapshots_.front().number < met.snapshot) snapshots_.pop_front();
    if (!snapshots_.empty() && snapshots_.front().number <= met.snapshot)
      show(loop_, port_, snapshots_.front());
    note(device::SyncEventKind::Tick);
    clock_.start();
    loop_.tick(met.periods * settings_.period_s);
    clock_.stop();
    ticked_ = LoopView::of(loop_, hand_.phase());
  }

  /// What the recording has next, as this run knows it.
  void note(device::SyncEventKind kind) {
    const device::SyncEvent& met = sync_events_[next_++];
    const std::uint64_t ticks = loop_.ticks() + (kind == device::SyncEventKind::Tick ? 1 : 0);
    log_.add(device::SyncEvent{loop_.last().time_s, static_cast<std::int32_t>(ticks), met.periods,
                               met.snapshot, kind});
  }

  CouplingPort& port_;
  device::HapticLoop loop_;
  LoopView ticked_;  ///< what a tick leaves is what physics sees, whatever is asked of the loop since
  device::Device& device_;
  std::vector<device::SyncEvent> sync_events_;
  std::size_t next_ = 0;
  device::RunLog& log_;
  std::deque<PhysicsSnapshot> snapshots_;
  TickClock clock_;
  bool is_running_ = false;
};

}  // namespace

std::unique_ptr<HapticDriver> makeReplayedDriver(Hand& hand, std::vector<device::SyncEvent> sync_events,
                                                 device::Device& device, CouplingPort& port,
                                                 const device::LoopSettings& settings, const TellFault& tell,
                                                 device::RunLog& log) {
  return std::make_unique<ReplayedDriver>(hand, std::move(sync_events), device, port, settings, tell, log);
}

}  // namespace vps::scenes

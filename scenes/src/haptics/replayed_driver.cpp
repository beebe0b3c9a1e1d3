// SPDX-License-Identifier: BSD-3-Clause
// A run by the clock again, without a clock: who met whom when is read from its recording.
#include <deque>
#include <utility>
#include <vector>

#include "haptics/clocked_driver.h"
#include "core/tick_times.h"

namespace vps {
namespace {

class ReplayedDriver final : public ClockedDriver {
 public:
  ReplayedDriver(Hand& hand, std::vector<SyncEvent> sync_events, Device& device, CouplingPort& port,
               const LoopSettings& settings, const TellFault& tell, RunLog& log)
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
    if (!goTo(SyncEventKind::Paused)) return;
    device_.write({});
    note(SyncEventKind::Paused);
    look(LoopView::of(loop_, hand_.phase()));
  }
  void resume() override {
    rearmIfFaulted();
    is_running_ = true;
  }

  bool advance(const HeldPart&) override {
    while (next_ < sync_events_.size() && !goTo(SyncEventKind::Step)) ++next_;  // beyond a departure
    if (!isAt(SyncEventKind::Step)) return false;
    note(SyncEventKind::Step);
    look(ticked_);
    return true;
  }
  bool hasSettled(bool) override {
    if (!isAt(SyncEventKind::Settled)) return false;
    note(SyncEventKind::Settled);
    return true;
  }
  OperatorPhase phase() override { return hand_.phase(); }
  std::uint64_t missed() override { return 0; }
  TickTimes times() override { return clock_.summary(); }
  std::optional<RealTimeResult> realTime() override { return {}; }

 protected:
  void order(SyncEventKind what) override {
    const bool is_met = goTo(what);
    obey(loop_, what);
    if (is_met) note(what);
  }
  void store(const PhysicsSnapshot& snapshot) override { snapshots_.push_back(snapshot); }

 private:
  [[nodiscard]] bool isAt(SyncEventKind kind) const {
    return next_ < sync_events_.size() && sync_events_[next_].kind == kind;
  }

  /// Ticks on until physics is met, and says whether it is for this. A cut recording has no more to tick
  /// with.
  bool goTo(SyncEventKind kind) {
    while (isAt(SyncEventKind::Tick)) {
      if (!hand_.canGoOn(1)) {
        next_ = sync_events_.size();
        return false;
      }
      tick(sync_events_[next_]);
    }
    return isAt(kind);
  }

  void tick(const SyncEvent& met) {
    while (snapshots_.size() > 1 && snapshots_.front().number < met.snapshot) snapshots_.pop_front();
    if (!snapshots_.empty() && snapshots_.front().number <= met.snapshot)
      show(loop_, port_, snapshots_.front());
    note(SyncEventKind::Tick);
    clock_.start();
    loop_.tick(met.periods * settings_.period_s);
    clock_.stop();
    ticked_ = LoopView::of(loop_, hand_.phase());
  }

  /// What the recording has next, as this run knows it.
  void note(SyncEventKind kind) {
    const SyncEvent& met = sync_events_[next_++];
    const std::uint64_t ticks = loop_.ticks() + (kind == SyncEventKind::Tick ? 1 : 0);
    log_.add(SyncEvent{loop_.last().time_s, static_cast<std::int32_t>(ticks), met.periods, met.snapshot, kind});
  }

  CouplingPort& port_;
  HapticLoop loop_;
  LoopView ticked_;  ///< what a tick leaves is what physics sees, whatever is asked of the loop since
  Device& device_;
  std::vector<SyncEvent> sync_events_;
  std::size_t next_ = 0;
  RunLog& log_;
  std::deque<PhysicsSnapshot> snapshots_;
  TickClock clock_;
  bool is_running_ = false;
};

}  // namespace

std::unique_ptr<HapticDriver> makeReplayedDriver(Hand& hand, std::vector<SyncEvent> sync_events, Device& device,
                                         CouplingPort& port, const LoopSettings& settings,
                                         const TellFault& tell, RunLog& log) {
  return std::make_unique<ReplayedDriver>(hand, std::move(sync_events), device, port, settings, tell, log);
}

}  // namespace vps

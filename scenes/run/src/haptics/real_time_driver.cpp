// SPDX-License-Identifier: BSD-3-Clause
// A run in real time: the haptic loop runs on a thread of its own, and physics steps when they are due.
#include <algorithm>

#include "haptics/clocked_driver.h"
#include "haptics/haptic_log.h"
#include "haptics/haptic_side.h"
#include "simulation/physics_clock.h"

namespace vps::scenes {
namespace {

class RealTimeDriver final : public ClockedDriver {
 public:
  RealTimeDriver(Hand& hand, device::CouplingPort& port, const device::LoopSettings& settings,
                 double physics_s, const ReportFault& report, device::RunLog* log)
      : ClockedDriver(settings, report),
        port_(port),
        haptic_log_(log),
        side_(hand, port, settings, {2 * physics_s, physicsLimit_s(physics_s)}, haptic_log_),
        clock_(physics_s) {}
  ~RealTimeDriver() override { pause(); }

  void pause() override {
    if (side_.stop()) {
      haptic_log_.passUntil(device::SyncEventKind::Paused);
      setView(side_.loopState());
    }
    clock_.stop();
  }
  void resume() override {
    rearmIfFaulted();
    if (side_.isRunning()) return;
    side_.start();
    has_priority_ = clock_.start(false).has_priority;
  }
  std::uint64_t missed() override { return side_.missed(); }

  bool advance() override {
    clock_.wait();
    side_.countFaults();
    const device::HapticState& view = port_.haptic.read();
    known_state_ = side_.state();
    haptic_log_.passUpTo(view.tick);
    haptic_log_.addFromPhysics({view.report.time_s, view.tick, 1, 0, device::SyncEventKind::Step});
    setView(view);
    return true;
  }
  bool hasSettled(bool is_ready) override {
    if (is_ready)
      haptic_log_.addFromPhysics({view_.report.time_s, view_.tick, 1, 0, device::SyncEventKind::Settled});
    return is_ready;
  }
  bool snaps(bool is_wanted) override {
    if (is_wanted != snaps_)
      haptic_log_.addFromPhysics(
          {view_.report.time_s, view_.tick, 1, 0,
           is_wanted ? device::SyncEventKind::SnapOn : device::SyncEventKind::SnapOff});
    return snaps_ = is_wanted;
  }
  bool givesUp(bool is_wanted) override {
    if (is_wanted)
      haptic_log_.addFromPhysics({view_.report.time_s, view_.tick, 1, 0, device::SyncEventKind::GiveUp});
    return is_wanted;
  }
  void setGains(const CouplingGains& gains) override {
    settings_.gains = gains;
    side_.setGains(gains);
  }
  device::OperatorState state() override { return known_state_; }
  [[nodiscard]] double busy_s() const override { return clock_.busy_s(); }
  void setLoadLevel(double step_s, double period_s, const CouplingGains& gains) override {
    clock_.setLoadLevel(step_s, period_s);
    side_.setGains(gains);
  }
  TickTimes times() override { return side_.times(); }
  std::optional<RealTimeResult> realTime() override {
    RealTimeResult result = side_.realTime();
    result.has_priority = result.has_priority && has_priority_;
    result.physics_missed = clock_.missed();
    result.behind_s = clock_.behind_s();
    result.physics_late = clock_.late();
    return result;
  }
  void passEvents(const std::function<void(const device::DeviceEvent&)>& to) override {
    side_.passEvents(to);
  }

 protected:
  void command(const HandCommand& command) override {
    side_.carryOut(command);
    known_state_ = side_.state();
    haptic_log_.passUntil(command.what);
  }
  void store(const device::PhysicsState& state) override { port_.physics.write(state); }

 private:
  device::CouplingPort& port_;
  HapticLog haptic_log_;
  /// State of the hand at the last advance() or command, so that it stays the same within a physics step.
  device::OperatorState known_state_;
  bool has_priority_ = false, snaps_ = false;
  HapticSide side_;
  PhysicsClock clock_;
};

}  // namespace

double physicsLimit_s(double physics_s) {
  return std::max(device::RealTimeSettings{}.physics_limit_s, 10 * physics_s);
}

std::unique_ptr<HapticDriver> makeRealTimeDriver(Hand& hand, device::CouplingPort& port,
                                                 const device::LoopSettings& settings, double physics_s,
                                                 const ReportFault& report, device::RunLog* log) {
  return std::make_unique<RealTimeDriver>(hand, port, settings, physics_s, report, log);
}

}  // namespace vps::scenes

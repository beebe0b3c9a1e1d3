// SPDX-License-Identifier: BSD-3-Clause
#include "core/tick_times.h"
#include "haptics/haptic_driver.h"

namespace vps::scenes {
namespace {

class LockstepDriver final : public HapticDriver {
 public:
  LockstepDriver(Hand& hand, device::Device& device, CouplingPort& port, const device::LoopSettings& settings,
                 int ticks_per_step, const TellFault& tell)
      : hand_(hand),
        port_(port),
        loop_(device, port, settings),
        ticks_per_step_(ticks_per_step),
        tell_(tell),
        clock_(settings.period_s) {}

  void pause() override {}
  void resume() override {}
  [[nodiscard]] const device::LoopSettings& settings() const override { return loop_.settings(); }
  [[nodiscard]] bool isByClock() const override { return false; }
  std::uint64_t missed() override { return 0; }

  void handOver(const Pose& X_WG) override { loop_.handOver(X_WG); }
  void openClutch() override { loop_.disengage(); }
  void closeClutch() override { loop_.engage(); }
  void begin(const device::OperatorTask& task, std::size_t step, double now_s) override {
    hand_.prepare(task, step, now_s);
    hand_.begin();
  }
  void letGo() override { loop_.release(); }
  void goBack(std::size_t next) override { hand_.goBack(next); }
  void recentre() override { hand_.recentre(); }
  void goOn() override { hand_.goOn(); }

  bool advance(const HeldPart& part) override {
    if (!hand_.canGoOn(ticks_per_step_)) return false;
    for (int i = 0; i < ticks_per_step_; ++i) {
      clock_.start();
      loop_.tick();
      clock_.stop();
      tellFaults();
      hand_.step(part, loop_, loop_.settings().period_s);
    }
    return true;
  }
  const CouplingState& proxy() override { return port_.proxy.read(); }
  void publish(const CouplingState& part, std::optional<double> stored_J) override {
    port_.part.write(part);
    if (stored_J) loop_.observeStoredEnergy(*stored_J, 0);
  }
  device::OperatorPhase phase() override { return hand_.phase(); }
  const device::TickReport& last() override { return loop_.last(); }
  device::PassivityObserver ledger() override { return loop_.ledger(); }
  TickTimes times() override { return clock_.summary(); }
  std::optional<RealTimeResult> realTime() override { return {}; }

 private:
  void tellFaults() {
    const device::SafetyState& safety = loop_.safety();
    if (safety.faults == told_faults_) return;
    told_faults_ = safety.faults;
    tell_(toText(safety.fault));
  }

  Hand& hand_;
  CouplingPort& port_;
  device::HapticLoop loop_;
  int ticks_per_step_;
  TellFault tell_;
  TickClock clock_;
  std::uint64_t told_faults_ = 0;
};

}  // namespace

std::unique_ptr<HapticDriver> makeLockstepDriver(Hand& hand, device::Device& device, CouplingPort& port,
                                                 const device::LoopSettings& settings, int ticks_per_step,
                                                 const TellFault& tell) {
  return std::make_unique<LockstepDriver>(hand, device, port, settings, ticks_per_step, tell);
}

}  // namespace vps::scenes

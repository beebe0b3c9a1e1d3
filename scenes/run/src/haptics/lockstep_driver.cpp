// SPDX-License-Identifier: BSD-3-Clause
// A run in simulated time on the caller's thread: the same scene gives the same bits.
#include "haptics/haptic_driver.h"
#include "simulation/tick_times.h"

namespace vps::scenes {
namespace {

class LockstepDriver final : public HapticDriver {
 public:
  LockstepDriver(Hand& hand, device::Device& device, device::CouplingPort& port,
                 const device::LoopSettings& settings, int ticks_per_step, const ReportFault& report)
      : hand_(hand),
        port_(port),
        loop_(device, port, withEvents(settings)),
        ticks_per_step_(ticks_per_step),
        report_fault_(report),
        clock_(settings.period_s) {}

  void pause() override {}
  void resume() override {
    if (loop_.safety().fault != device::SafetyFault::None) loop_.rearm();
  }
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

  bool advance() override {
    if (!hand_.canGoOn(ticks_per_step_)) return false;
    for (int i = 0; i < ticks_per_step_; ++i) {
      clock_.start();
      loop_.tick();
      clock_.stop();
      reportFaults();
      hand_.step(loop_.received().held, loop_, loop_.settings().period_s);
    }
    return true;
  }
  const CouplingState& proxy() override { return port_.haptic.read().proxy; }
  void publish(const device::PhysicsState& state) override {
    device::PhysicsState numbered = state;
    numbered.step = ++published_;
    port_.physics.write(numbered);
    loop_.receivePart();  // received now, since a run may end before the next tick
  }
  device::OperatorState state() override { return hand_.state(); }
  const device::TickReport& last() override { return loop_.last(); }
  device::PassivityObserver passivity() override { return loop_.passivity(); }
  TickTimes times() override { return clock_.summary(); }
  std::optional<RealTimeResult> realTime() override { return {}; }

  void passEvents(const std::function<void(const device::DeviceEvent&)>& to) override {
    for (device::DeviceEvent event; events_.pop(event);) to(event);
  }

 private:
  device::LoopSettings withEvents(device::LoopSettings settings) {
    settings.events = &events_;
    return settings;
  }
  void reportFaults() {
    const device::SafetyState& safety = loop_.safety();
    if (safety.faults == reported_faults_) return;
    reported_faults_ = safety.faults;
    report_fault_(toText(safety.fault));
  }

  Hand& hand_;
  device::CouplingPort& port_;
  device::DeviceEventQueue events_;
  device::HapticLoop loop_;
  int ticks_per_step_;
  ReportFault report_fault_;
  TickClock clock_;
  std::int32_t published_ = 0;
  std::uint64_t reported_faults_ = 0;
};

}  // namespace

std::unique_ptr<HapticDriver> makeLockstepDriver(Hand& hand, device::Device& device,
                                                 device::CouplingPort& port,
                                                 const device::LoopSettings& settings, int ticks_per_step,
                                                 const ReportFault& report) {
  return std::make_unique<LockstepDriver>(hand, device, port, settings, ticks_per_step, report);
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// A run by a person's device while a window watches it.
#include "run/live_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "vps_device/device.h"

namespace vps::viewer {
namespace {

using namespace std::chrono_literals;

/// A handle that does not move, and can be unplugged.
class Unpluggable final : public device::Device {
 public:
  explicit Unpluggable(const std::atomic<bool>& is_unplugged) : is_unplugged_(is_unplugged) {}
  device::DeviceSample read() noexcept override {
    device::DeviceSample sample;
    sample.time_s = 1e-3 * ++reads_;
    if (is_unplugged_) sample.status = Status::Fault;
    return sample;
  }
  void write(const Wrench& /*F_Ho_D*/) noexcept override {}
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 10}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "unpluggable"; }

 private:
  const std::atomic<bool>& is_unplugged_;
  int reads_ = 0;
};

/// Waits until the condition holds, for at most a minute.
template <class Condition>
bool soon(Condition is_true) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!is_true()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

TEST(LiveRunTest, ADeviceThatIsUnpluggedIsSaidWithWhatHelpsAndTheRunGoesOn) {
  std::atomic<bool> is_unplugged = false;
  LiveSettings settings;
  settings.has_sound = false;
  settings.device = [&] { return std::make_unique<Unpluggable>(is_unplugged); };
  LiveRun run(scenes::loadScene(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml"), settings, [] {});
  ASSERT_TRUE(soon([&] { return run.status().steps > 100; })) << run.status().error;
  is_unplugged = true;
  bool is_said = false;
  ASSERT_TRUE(soon([&] {
    for (const std::string& words : run.takeMessages())
      is_said |= words.find("does not answer; check the device's power and cable") != std::string::npos;
    return is_said;
  }));
  const std::size_t before = run.status().steps;
  EXPECT_TRUE(soon([&] { return run.status().steps > before + 100; })) << "physics goes on";
  EXPECT_FALSE(run.status().is_over) << run.status().error;
  run.ask();
  std::optional<scenes::Snapshot> shot;
  ASSERT_TRUE(soon([&] { return (shot = run.take()).has_value(); }));
  EXPECT_EQ(shot->F_hand_W.f.norm(), 0) << "a lost device gets no force";
}

TEST(LiveRunTest, SnapshotsOfARunHaveItsFiguresSoFar) {
  LiveSettings settings;
  settings.has_sound = false;
  settings.speed = 0;
  LiveRun run(scenes::loadScene(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml"), settings, [] {});
  std::optional<scenes::Snapshot> shot;
  run.ask();
  // Snapshots have figures from 50 ms of simulated time on; wait for 0.2 s.
  ASSERT_TRUE(soon([&] {
    if (std::optional<scenes::Snapshot> newer = run.take()) {
      shot = std::move(newer);
      run.ask();
    }
    return shot && shot->time_s > 0.2;
  })) << run.status().error;
  ASSERT_TRUE(shot->figures);
  EXPECT_GE(shot->figures->physics_steps, 100u);
  EXPECT_GE(shot->figures->ticks, shot->figures->physics_steps);
  EXPECT_GE(shot->figures->to_hand_J, 0);
  EXPECT_GE(shot->figures->injected_J, 0);
}

}  // namespace
}  // namespace vps::viewer

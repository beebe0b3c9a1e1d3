// SPDX-License-Identifier: BSD-3-Clause
// Runs in real time in which a person moves the handle, here a device that follows a script.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "procedure/assembly_run.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

/// A box that is set down on a plate, 0.2 mm below its start.
Scene setDown() {
  Scene scene;
  scene.file = "scene.toml";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({10e-3, 10e-3, 2e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"box", makeBox({2e-3, 2e-3, 2e-3}), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 2.2e-3});
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 2e-3});
  scene.steps[0].tolerance_m = 0.1e-3;
  scene.steps[0].timeout_s = 3;
  scene.fidelity.haptic_rate_hz = 500;
  scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  return scene;
}

/// A device without force output, like a space mouse. The handle's z follows the script, tick by tick.
class ScriptedDevice final : public device::Device {
 public:
  explicit ScriptedDevice(std::function<double(double t_s)> z_m) : z_m_(std::move(z_m)) {}
  device::DeviceSample read() noexcept override {
    const double t_s = kTick_s * static_cast<double>(++reads_);
    device::DeviceSample sample;
    sample.X_DH.p.z() = z_m_(t_s);
    sample.V_DH.v.z() = (z_m_(t_s) - z_m_(t_s - kTick_s)) / kTick_s;
    sample.time_s = t_s;
    return sample;
  }
  void write(const Wrench& F) noexcept override { EXPECT_TRUE(F.f.isZero()); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "scripted"; }

 private:
  static constexpr double kTick_s = 2e-3;
  std::function<double(double)> z_m_;
  long reads_ = 0;
};

AssembleResult runWith(std::function<double(double)> z_m) {
  Scene scene = setDown();
  AssembleOptions options;
  options.is_real_time = true;
  const std::unique_ptr<Hand> hand = personHand(std::make_unique<ScriptedDevice>(std::move(z_m)));
  return runProcedure(scene, *hand, nullptr, loopSettings(scene, hand->device()), options);
}

TEST(PersonHand, AStepIsDoneOnceThePartRestsAtItsTarget) {
  // The handle moves down by 0.3 mm at 1 mm/s from 0.6 s on, after the clutch has closed; the plate stops the
  // part at 0.2 mm.
  const AssembleResult result = runWith([](double t_s) { return -1e-3 * std::clamp(t_s - 0.6, 0.0, 0.3); });
  ASSERT_EQ(result.steps.size(), 1u);
  EXPECT_TRUE(result.completed) << result.steps[0].failure_reason;
  EXPECT_LT(result.steps[0].final_error_m, setDown().steps[0].tolerance_m);
  EXPECT_EQ(result.energy.injected_J, 0) << "without force, energy is not balanced";
}

TEST(PersonHand, AStepThatNeverReachesItsTargetFailsAtItsTimeout) {
  const AssembleResult result = runWith([](double) { return 0.0; });
  ASSERT_EQ(result.steps.size(), 1u);
  EXPECT_FALSE(result.completed);
  EXPECT_NE(result.steps[0].failure_reason.find("after its time was over"), std::string::npos)
      << result.steps[0].failure_reason;
}

std::string refusal(const std::string& kind, bool is_real_time) {
  Scene scene = setDown();
  scene.device.kind = kind;
  AssembleOptions options;
  options.is_real_time = is_real_time;
  try {
    assemble(scene, options);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(PersonHand, ADeviceThatAPersonMovesIsRefusedInSimulatedTime) {
  for (const char* kind : {"space_mouse", "game_controller", "mouse"})
    EXPECT_NE(refusal(kind, false).find("add --real-time"), std::string::npos) << refusal(kind, false);
}

TEST(PersonHand, ASpaceMouseWithoutADaemonIsRefusedWithTheRemedy) {
  setenv("SPNAV_SOCKET", "/nonexistent/spnav.sock", 1);
  const std::string words = refusal("space_mouse", true);
  unsetenv("SPNAV_SOCKET");
  EXPECT_NE(words.find("scene.toml: device 'space_mouse': "), std::string::npos) << words;
  const bool has_library =
      words.find("libspnav-dev") == std::string::npos;  // otherwise this build has no such library
  EXPECT_TRUE(!has_library || words.find("start spacenavd") != std::string::npos) << words;
}

TEST(PersonHand, TheMouseWithoutAWindowIsRefusedWithTheRemedy) {
  EXPECT_NE(refusal("mouse", true).find("vps view SCENE --hand mouse"), std::string::npos)
      << refusal("mouse", true);
}

TEST(PersonHand, AMouseThatIsDraggedPutsThePartDownByContact) {
  Scene scene = setDown();
  scene.device.kind = "mouse";
  AssembleOptions options;
  options.is_real_time = true;
  options.wish = std::make_shared<device::HandleWish>();
  // After the clutch has closed, the handle is dragged to 1 mm below its start, which is 0.8 mm inside the
  // plate.
  options.after_step = [&](double time_s) {
    if (time_s > 0.6) options.wish->write(Pose::translation({0, 0, -1e-3}));
  };
  const AssembleResult result = assemble(scene, options);
  ASSERT_EQ(result.steps.size(), 1u);
  EXPECT_TRUE(result.completed) << result.steps[0].failure_reason;
  EXPECT_GE(result.steps[0].impacts + result.steps[0].slides, 1) << "the plate stopped it";
  // Spring of the cursor (3 kN/m) and coupling in series over at most 0.8 mm, and the box's weight.
  EXPECT_LT(result.steps[0].peak_force_N, 3000 * 0.8e-3 + 0.1);
  EXPECT_GT(result.steps[0].peak_force_N, 0.5);
}

TEST(PersonHand, AnUnknownKindIsRefusedWithTheKnownOnes) {
  EXPECT_NE(refusal("spoon", false).find("dual_arm, ideal_dual_arm, space_mouse, game_controller, mouse"),
            std::string::npos)
      << refusal("spoon", false);
}

}  // namespace
}  // namespace vps::scenes

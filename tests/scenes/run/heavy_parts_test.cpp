// SPDX-License-Identifier: BSD-3-Clause
// Parts that are heavier than a hand can carry, and devices that fail under a load.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "haptics/haptic_driver.h"
#include "scenes/peg_in_cup.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

/// Steel cubes that are put down side by side on a plate, in this order.
Scene cubesOnPlate(const std::vector<double>& sizes_m) {
  Scene scene;
  scene.file = scene.name = "cubes";
  scene.parts.push_back(scenePart("plate", makeBox({1, 0.4, 0.02}), {0, 0, -0.01}, true));
  double x_m = -0.4;
  for (const double size_m : sizes_m) {
    x_m += 0.5 * size_m;
    scene.parts.push_back(scenePart("cube" + std::to_string(scene.parts.size()),
                                    makeBox({size_m, size_m, size_m}), {x_m, 0, 0.5 * size_m}, false));
    SceneStep step;
    step.part = scene.parts.size() - 1;
    step.X_WP_target = step.X_WP_start = scene.parts.back().X_WP;
    step.X_WP_start.p.z() += 0.02;
    scene.steps.push_back(step);
    x_m += 0.5 * size_m + 0.05;
  }
  scene.fidelity.voxel_m = 1e-3;
  scene.fidelity.spacing_m = 4e-3;
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 500;
  scene.release_s = 0.2;
  return scene;
}

// 7.9 kg: more than twice the force of the device. Without a hoist the part pulls the device out of its
// workspace.
TEST(HeavyParts, AreBroughtAsLightOnesAreAndTold) {
  Scene scene = cubesOnPlate({0.1, 0.03});
  std::vector<std::string> warnings;
  AssembleOptions options;
  options.warn = [&](const std::string& words) { warnings.push_back(words); };
  const AssembleResult result = assemble(scene, options);
  for (const StepResult& step : result.steps) {
    EXPECT_EQ(step.verdict, Verdict::Fits) << step.part << ": " << step.reason;
    EXPECT_LT(step.peak_force_N, 30) << step.part;
    EXPECT_GT(step.peak_force_N, 1) << step.part;  // the hand carried it
  }
  // 7850 kg/m3, (100 mm)^3; half of 30 N on the hand.
  EXPECT_NEAR(result.steps[0].hoist_N, 7.85 * 9.81 - 15, 0.05);
  EXPECT_EQ(result.steps[1].hoist_N, 0);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("'cube1' weighs 77.0 N, and the hand carries 15.0 N"), std::string::npos)
      << warnings[0];
}

// A part that falls into its place has not been moved to it by the device.
TEST(HeavyParts, APartThatFallsWhileTheDeviceFailsIsNotShown) {
  Scene scene = pegInCup({});
  scene.coupling.max_force_N = 2000;  // the loop accepts at most 1000
  const AssembleResult result = assemble(scene);
  EXPECT_EQ(result.verdict, Verdict::NotShown);
  EXPECT_FALSE(result.steps[0].completed);
  EXPECT_NE(result.steps[0].reason.find("the device failed"), std::string::npos) << result.steps[0].reason;
}

/// A peg of mass mass_kg that is moved into its cup in a given direction.
Scene pegInto(const Vec3& direction, double mass_kg) {
  Scene scene = pegInCup({});
  const Pose X_turn(Quat::FromTwoVectors(-Vec3::UnitZ(), direction.normalized()).toRotationMatrix(),
                    Vec3::Zero());
  for (ScenePart& part : scene.parts) part.X_WP = X_turn * part.X_WP;
  SceneStep& step = scene.steps[0];
  step.X_WP_start = X_turn * step.X_WP_start;
  step.X_WP_target = X_turn * step.X_WP_target;
  step.is_held = true;        // the cup may lie on its side or be upside down
  step.tolerance_m = 0.2e-3;  // above the play of 0.1 mm, since the peg is longer than the cup is deep
  Part& peg = scene.parts[1].part;
  peg.material.density_kg_m3 = mass_kg / massProperties(peg.mesh).volume_m3;
  return scene;
}

// The spring between hand and part gives way by up to 26 mm under the 15 N that the hand carries, and sight
// corrects 3 mm.
class HeavyPegs : public testing::TestWithParam<double> {};

TEST_P(HeavyPegs, FindTheirHoleInEveryDirection) {
  for (const Vec3& direction :
       {Vec3(1, 0, 0), Vec3(-1, 2, 0), Vec3(0, 1, 1), Vec3(0, 1, -1), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    Scene scene = pegInto(direction, GetParam());
    const AssembleResult result = assemble(scene);
    EXPECT_EQ(result.verdict, Verdict::Fits) << direction.transpose() << ": " << result.steps[0].reason;
    EXPECT_TRUE(result.steps[0].by_contact) << direction.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(From100GramsTo5Kilograms, HeavyPegs, testing::Values(0.1, 0.3, 0.5, 1.0, 2.0, 5.0),
                         [](const auto& tested) {
                           return "Of" + std::to_string(int(1000 * tested.param)) + "Grams";
                         });

class FailingDevice final : public device::Device {
 public:
  device::DeviceSample read() noexcept override {
    sample.time_s += 1e-3;
    return sample;
  }
  void write(const Wrench&) noexcept override {}
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 30}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "failing"; }
  device::DeviceSample sample;
};

class FailingHand final : public Hand {
 public:
  device::Device& device() override { return failing; }
  void prepare(const device::OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}
  void step(const device::HeldPart&, const device::HapticLoop&, double) override {}
  [[nodiscard]] device::OperatorPhase phase() const override { return device::OperatorPhase::Reach; }
  [[nodiscard]] bool canGoOn(int) const override { return true; }
  FailingDevice failing;
};

// As in real time, a fault in one step does not affect the next step.
TEST(HeavyParts, ADeviceThatFailedIsArmedAgainForTheNextStep) {
  FailingHand hand;
  device::CouplingPort port;
  device::LoopSettings settings;
  settings.period_s = 1e-3;
  std::vector<std::string> faults;
  const auto driver = makeLockstepDriver(hand, hand.failing, port, settings, 1,
                                         [&](const std::string& fault) { faults.push_back(fault); });
  const auto go = [&] {
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(driver->advance());
  };
  go();
  EXPECT_EQ(driver->last().status, Status::Ok);
  hand.failing.sample.status = Status::Fault;
  go();
  hand.failing.sample.status = Status::Ok;
  go();
  EXPECT_EQ(driver->last().status, Status::Fault);
  driver->resume();
  go();
  EXPECT_EQ(driver->last().status, Status::Ok);
  EXPECT_EQ(faults, std::vector<std::string>{"device lost"});
}

}  // namespace
}  // namespace vps::scenes

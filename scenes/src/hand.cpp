// SPDX-License-Identifier: BSD-3-Clause
#include "hand.h"

#include <cstdio>
#include <string>
#include <utility>

#include "vps/load_error.h"
#include "vps_device/simulated_dual_arm.h"

namespace vps {

namespace {

OperatorHabits habitsOf(const OperatorSettings& hand, std::size_t step) {
  OperatorHabits habits;
  habits.seed = hand.seed + step;  // each step aims anew, and does not depend on how long the last one took
  habits.aim_error_m = hand.aim_error_m;
  habits.aim_error_rad = hand.aim_error_rad;
  habits.speed_m_s = hand.speed_m_s;
  habits.press_N = hand.press_N;
  habits.force_limit_N = hand.force_limit_N;
  return habits;
}

DualArmParameters armsOf(const Scene& scene) {
  return scene.device.data.empty() ? DualArmParameters{} : loadDualArm(scene.device.data).parameters;
}

SimulatedDualArmSettings plantSettings(const Scene& scene) {
  if (scene.device.kind != "dual_arm")
    throw LoadError(scene.file, "",
                    "device kind '" + scene.device.kind + "' is not known; this version has dual_arm");
  SimulatedDualArmSettings settings;
  settings.arms = armsOf(scene);
  settings.X_DH_start = handleStart(scene, scene.steps.front(), settings.arms.workspace_m);
  settings.has_quantised_encoders = scene.device.has_quantised_encoders;
  settings.rate_hz = scene.fidelity.haptic_rate_hz;
  return settings;
}

class SimulatedHand final : public Hand {
 public:
  explicit SimulatedHand(const Scene& scene) : scene_(scene), plant_(plantSettings(scene)) {}

  Device& device() override { return plant_; }

  void prepare(const OperatorTask& task, std::size_t step, double now_s) override {
    next_ = VirtualOperator(habitsOf(scene_.hand, step));
    next_.begin(task, now_s);
    next_s_ = now_s;
  }

  void begin() override {
    std::swap(operator_, next_);  // moves; what was before is freed by the next prepare()
    time_s_ = next_s_;
    is_going_back_ = false;
  }

  void requireReachable(const SceneStep& step) const override { handleStart(scene_, step, workspace_m()); }

  void goBack(const SceneStep* next) override {
    X_DH_back_ = next != nullptr ? handleStart(scene_, *next, workspace_m()) : Pose{};
    X_DH_from_ = plant_.truePose();
    turn_rad_ = rotationVector(X_DH_back_.R * X_DH_from_.R.transpose());
    time_s_ = 0;
    is_going_back_ = true;
  }

  void step(const HeldPart& part, const HapticLoop& loop, double dt_s) override {
    plant_.step(dt_s, is_going_back_ ? returning(dt_s) : atWork(part, loop, dt_s));
  }

  [[nodiscard]] OperatorPhase phase() const override { return operator_.phase(); }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  [[nodiscard]] const Vec3& workspace_m() const { return plant_.plant().settings().arms.workspace_m; }

  HandForce atWork(const HeldPart& part, const HapticLoop& loop, double dt_s) {
    OperatorView view;
    view.time_s = time_s_;
    view.X_WG_hand = loop.toGrasp(plant_.truePose());
    view.V_WG_hand = loop.settings().map.toScene(plant_.trueTwist());
    view.X_WP = part.X_WP;
    view.V_WP = part.V_WP;
    view.F_hand_W = loop.last().F_hand_W;
    time_s_ += dt_s;
    return loop.toDevice(operator_.step(view, dt_s));
  }

  HandForce returning(double dt_s) {
    time_s_ += dt_s;
    const double share = minimumJerk(time_s_ / kHandReturn_s);
    HandForce hand = evenHand(habitsOf(scene_.hand, 0));
    hand.X_eq = Pose(Mat3(rotationFromVector(share * turn_rad_) * X_DH_from_.R),
                     X_DH_from_.p + share * (X_DH_back_.p - X_DH_from_.p));
    return hand;
  }

  const Scene& scene_;
  SimulatedDualArm plant_;
  VirtualOperator operator_, next_;
  double next_s_ = 0;
  double time_s_ = 0;  ///< of the run while at work, else since it let go
  bool is_going_back_ = false;
  Pose X_DH_from_, X_DH_back_;
  Vec3 turn_rad_ = Vec3::Zero();
};

/// Does what was recorded: the samples carry the motion, the events what the hand was about.
class RecordedHand final : public Hand {
 public:
  explicit RecordedHand(Recording& recording) : recording_(recording) {}
  Device& device() override { return recording_; }
  void prepare(const OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void requireReachable(const SceneStep&) const override {}
  void goBack(const SceneStep*) override {}
  void step(const HeldPart&, const HapticLoop&, double) override {}
  [[nodiscard]] OperatorPhase phase() const override {
    return static_cast<OperatorPhase>(recording_.phase().value_or(0));
  }
  [[nodiscard]] bool canGoOn(int ticks) const override {
    return recording_.left() >= static_cast<std::size_t>(ticks);
  }

 private:
  Recording& recording_;
};

}  // namespace

Pose handleStart(const Scene& scene, const SceneStep& step, const Vec3& room_m) {
  Box path;
  path.add(Vec3::Zero());
  for (const Pose& X_WP : step.way_points) path.add(X_WP.p - step.X_WP_start.p);
  path.add(step.X_WP_target.p - step.X_WP_start.p);
  const Vec3 needed_m = path.size() / scene.device.scale;
  if ((needed_m.array() > room_m.array()).any()) {
    char words[160];
    std::snprintf(
        words, sizeof words,
        "its path is longer than the device's workspace of %.0f x %.0f x %.0f mm; start nearer, or set "
        "[device] scale above %f",
        1e3 * room_m.x(), 1e3 * room_m.y(), 1e3 * room_m.z(),
        scene.device.scale * (needed_m.array() / room_m.array()).maxCoeff());
    throw LoadError(scene.file, scene.parts[step.part].part.name, words);
  }
  return Pose::translation(-path.center() / scene.device.scale);
}

std::unique_ptr<Hand> simulatedHand(const Scene& scene) {
  return std::make_unique<SimulatedHand>(scene);
}

std::unique_ptr<Hand> recordedHand(Recording& recording) {
  return std::make_unique<RecordedHand>(recording);
}

}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/hand.h"

#include <string>
#include <utility>
#include <vector>

#include "haptics/path_segments.h"
#include "vps/load_error.h"
#include "vps_device/simulated_dual_arm.h"

namespace vps::scenes {

namespace {

device::OperatorHabits habitsOf(const OperatorSettings& hand, std::size_t step) {
  device::OperatorHabits habits;
  habits.seed = hand.seed + step;  // each step aims anew, and does not depend on how long the last one took
  habits.aim_error_m = hand.aim_error_m;
  habits.aim_error_rad = hand.aim_error_rad;
  habits.speed_m_s = hand.speed_m_s;
  habits.press_N = hand.press_N;
  habits.force_limit_N = hand.force_limit_N;
  return habits;
}

device::DualArmParameters armsOf(const Scene& scene) {
  return scene.device.data.empty() ? device::DualArmParameters{}
                                   : device::loadDualArm(scene.device.data).parameters;
}

device::SimulatedDualArmSettings plantSettings(const Scene& scene) {
  if (scene.device.kind != "dual_arm")
    throw LoadError(scene.file, "",
                    "device kind '" + scene.device.kind + "' is not known; this version has dual_arm");
  device::SimulatedDualArmSettings settings;
  settings.arms = armsOf(scene);
  settings.has_quantised_encoders = scene.device.has_quantised_encoders;
  settings.rate_hz = scene.fidelity.haptic_rate_hz;
  return settings;
}

std::vector<PathSegments> allSegments(const Scene& scene, const Vec3& workspace_m) {
  std::vector<PathSegments> all;
  for (const SceneStep& step : scene.steps) all.push_back(splitPath(scene, step, workspace_m));
  return all;
}

device::SimulatedDualArmSettings startingAt(device::SimulatedDualArmSettings settings,
                                            const std::vector<PathSegments>& segments) {
  settings.X_DH_start = segments.front().X_DH_start.front();
  return settings;
}

class SimulatedHand final : public Hand {
 public:
  explicit SimulatedHand(const Scene& scene)
      : scene_(scene),
        settings_(plantSettings(scene)),
        segments_(allSegments(scene, settings_.arms.workspace_m)),
        plant_(startingAt(settings_, segments_)) {
    X_DH_from_ = X_DH_back_ = plant_.truePose();
  }

  device::Device& device() override { return plant_; }

  void prepare(const device::OperatorTask& task, std::size_t step, double now_s) override {
    next_ = device::VirtualOperator(habitsOf(scene_.hand, step));
    device::OperatorTask reachable = task;
    reachable.way_points = segments_[step].way_points;
    reachable.index_points = segments_[step].index_points;
    next_.begin(reachable, now_s);
    next_s_ = now_s;
    next_step_ = step;
  }

  void begin() override {
    std::swap(operator_, next_);  // moves; what was before is freed by the next prepare()
    time_s_ = next_s_;
    step_ = next_step_;
    segment_ = 0;
    is_at_work_ = true;
  }

  void goBack(std::size_t next) override {
    goTo(next < segments_.size() ? segments_[next].X_DH_start.front() : Pose{});
  }
  void recentre() override {
    const std::vector<Pose>& starts = segments_[step_].X_DH_start;
    if (segment_ + 1 < starts.size()) ++segment_;
    goTo(starts[segment_]);
  }
  void goOn() override {
    operator_.goOn();
    is_at_work_ = true;
  }

  void step(const HeldPart& part, const device::HapticLoop& loop, double dt_s) override {
    plant_.step(dt_s, is_at_work_ ? atWork(part, loop, dt_s) : returning(part, loop, dt_s));
  }

  [[nodiscard]] device::OperatorPhase phase() const override { return operator_.phase(); }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  void goTo(const Pose& X_DH) {
    X_DH_back_ = X_DH;
    X_DH_from_ = plant_.truePose();
    turn_rad_ = rotationVector(X_DH_back_.R * X_DH_from_.R.transpose());
    back_s_ = 0;
    is_at_work_ = false;
  }

  device::HandForce atWork(const HeldPart& part, const device::HapticLoop& loop, double dt_s) {
    device::OperatorView view;
    view.time_s = time_s_;
    view.X_WG_hand = loop.toGrasp(plant_.truePose());
    view.V_WG_hand = loop.settings().map.toScene(plant_.trueTwist());
    view.X_WP = part.X_WP;
    view.V_WP = part.V_WP;
    view.F_hand_W = loop.last().F_hand_W;
    time_s_ += dt_s;
    device::HandForce hand = operator_.step(view, dt_s);
    hand.F = hand.F * loop.clutch().ratio();  // it carries what it feels
    return loop.toDevice(hand);
  }

  /// On its way back, or there; where it has a part in hand it carries what the clutch lets it feel.
  device::HandForce returning(const HeldPart& part, const device::HapticLoop& loop, double dt_s) {
    time_s_ += dt_s;
    back_s_ += dt_s;
    const double share = device::minimumJerk(back_s_ / kHandReturn_s);
    device::HandForce hand = device::evenHand(habitsOf(scene_.hand, 0));
    hand.X_eq = Pose(Mat3(rotationFromVector(share * turn_rad_) * X_DH_from_.R),
                     X_DH_from_.p + share * (X_DH_back_.p - X_DH_from_.p));
    if (loop.isHolding())
      hand.F = loop.settings().map.toDevice(Wrench{Vec3::Zero(), -part.weight_W}) * loop.clutch().ratio();
    return hand;
  }

  const Scene& scene_;
  device::SimulatedDualArmSettings settings_;
  std::vector<PathSegments> segments_;  ///< of each step
  device::SimulatedDualArm plant_;
  device::VirtualOperator operator_, next_;
  double next_s_ = 0;
  std::size_t next_step_ = 0, step_ = 0, segment_ = 0;
  double time_s_ = 0;              ///< of the run
  double back_s_ = kHandReturn_s;  ///< since it went back
  bool is_at_work_ = false;
  Pose X_DH_from_, X_DH_back_;
  Vec3 turn_rad_ = Vec3::Zero();
};

/// Does what was recorded: the samples carry the motion, the events what the hand was about.
class RecordedHand final : public Hand {
 public:
  explicit RecordedHand(device::Recording& recording) : recording_(recording) {}
  device::Device& device() override { return recording_; }
  void prepare(const device::OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}
  void step(const HeldPart&, const device::HapticLoop&, double) override {}
  [[nodiscard]] device::OperatorPhase phase() const override {
    return static_cast<device::OperatorPhase>(recording_.phase().value_or(0));
  }
  [[nodiscard]] std::vector<device::SyncEvent> sync_events() const override {
    std::vector<device::SyncEvent> all;
    for (const device::LogEntry& entry : recording_.run().entries)
      if (const auto* sync_event = std::get_if<device::SyncEvent>(&entry)) all.push_back(*sync_event);
    return all;
  }
  [[nodiscard]] bool canGoOn(int ticks) const override {
    return recording_.left() >= static_cast<std::size_t>(ticks);
  }

 private:
  device::Recording& recording_;
};

}  // namespace

std::unique_ptr<Hand> simulatedHand(const Scene& scene) {
  return std::make_unique<SimulatedHand>(scene);
}

std::unique_ptr<Hand> recordedHand(device::Recording& recording) {
  return std::make_unique<RecordedHand>(recording);
}

}  // namespace vps::scenes

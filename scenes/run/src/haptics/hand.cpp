// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/hand.h"

#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "haptics/haptic_driver.h"
#include "haptics/path_segments.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"

namespace vps::scenes {

namespace {

device::OperatorHabits habitsOf(const OperatorSettings& hand, std::size_t step) {
  device::OperatorHabits habits;
  habits.seed = hand.seed +
                step;  // each step has an aim error of its own, independent of the duration of earlier steps
  habits.aim_error_m = hand.aim_error_m;
  habits.aim_error_rad = hand.aim_error_rad;
  habits.aim_turn_rad = hand.aim_turn_rad;
  habits.speed_m_s = hand.speed_m_s;
  habits.press_N = hand.press_N;
  habits.force_limit_N = hand.force_limit_N;
  return habits;
}

const device::DeviceKind& kindOf(const Scene& scene) {
  const device::DeviceKind* kind = device::findDeviceKind(scene.device.kind);
  if (kind == nullptr)
    throw LoadError(scene.file, "",
                    "device kind '" + scene.device.kind + "' is not known; this version has " +
                        device::deviceKindNames());
  return *kind;
}

device::DeviceOptions optionsOf(const Scene& scene) {
  device::DeviceOptions options;
  options.parameter_file = scene.device.data;
  options.has_quantised_encoders = scene.device.has_quantised_encoders;
  options.rate_hz = scene.fidelity.haptic_rate_hz;
  return options;
}

Workspace workspaceOf(const device::DeviceLimits& limits) {
  return {limits.workspace_max_D - limits.workspace_min_D, limits.workspace_rad};
}

/// Refuses forces of the operator that the device cannot exert.
void requireForces(const Scene& scene, const device::DeviceLimits& limits) {
  const auto require = [&](const char* key, double wanted_N) {
    if (limits.peak_force_N <= 0 || wanted_N <= limits.peak_force_N) return;
    char words[160];
    std::snprintf(words, sizeof words,
                  "[operator] %s is %g N, but the device gives %g N at most; choose a smaller force", key,
                  wanted_N, limits.peak_force_N);
    throw LoadError(scene.file, "", words);
  };
  require("press_N", scene.hand.press_N);
  require("force_limit_N", scene.hand.force_limit_N);
}

/// Refuses a screw that the device and the hand cannot turn.
void requireTurns(const Scene& scene, const SceneStep& step, const device::DeviceLimits& limits) {
  if (step.motion != StepMotion::Screw) return;
  const auto refuse = [&](const std::string& words) {
    throw LoadError(scene.file, scene.parts[step.part].part.name, words);
  };
  if (!scene.device.has_indexing && limits.workspace_rad > 0)
    refuse(
        "is a screw, which needs more turns than the device's handle has; let the hand re-grasp the "
        "screw ([device] indexing = true)");
  const double most_Nm =
      std::min(device::OperatorHabits{}.torque_limit_Nm,
               limits.peak_torque_Nm > 0 ? limits.peak_torque_Nm : device::OperatorHabits{}.torque_limit_Nm);
  char words[160];
  std::snprintf(
      words, sizeof words,
      "is to be screwed on with %g N m, but the hand exerts %.2g N m at most; choose a smaller torque_Nm",
      step.torque_Nm, most_Nm);
  if (step.torque_Nm > most_Nm) refuse(words);
}

std::vector<PathSegments> allSegments(const Scene& scene, const device::DeviceLimits& limits) {
  requireForces(scene, limits);
  std::vector<PathSegments> all;
  for (const SceneStep& step : scene.steps) {
    requireTurns(scene, step, limits);
    all.push_back(splitPath(scene, step, workspaceOf(limits)));
  }
  return all;
}

/// Places the handle at the start of the first segment.
device::DeviceOptions startingAt(device::DeviceOptions options, const std::vector<PathSegments>& segments) {
  options.X_DH_start = segments.front().X_DH_start.front();
  return options;
}

class SimulatedHand final : public Hand {
 public:
  explicit SimulatedHand(const Scene& scene)
      : scene_(scene),
        segments_(allSegments(scene, kindOf(scene).simulate(optionsOf(scene))->limits())),
        plant_(kindOf(scene).simulate(startingAt(optionsOf(scene), segments_))) {
    X_DH_from_ = X_DH_back_ = plant_->truePose();
  }

  device::Device& device() override { return *plant_; }

  void prepare(const device::OperatorTask& task, std::size_t step, double now_s) override {
    next_ = device::VirtualOperator(habitsOf(scene_.hand, step));
    device::OperatorTask reachable = task;
    const std::size_t all = scene_.steps[step].way_points.size();
    const PathSegments ahead = withoutPassed(segments_[step], all - std::min(all, task.way_points.size()));
    reachable.way_points = ahead.way_points;
    reachable.index_points = ahead.index_points;
    next_segment_ = segments_[step].index_points.size() - ahead.index_points.size();
    reachable.screw.handle_rad = turnRange_rad(plant_->limits().workspace_rad);
    next_.begin(reachable, now_s);
    next_s_ = now_s;
    next_step_ = step;
  }

  void begin() override {
    std::swap(operator_, next_);  // a swap allocates nothing; the next prepare() frees the old operator
    time_s_ = next_s_;
    step_ = next_step_;
    segment_ = next_segment_;
    is_at_work_ = true;
  }

  void goBack(std::size_t next) override {
    goTo(next < segments_.size() ? segments_[next].X_DH_start.front() : Pose{});
  }
  void recentre() override {
    if (const Vec3 turn_rad = operator_.regraspTurn_rad(); !turn_rad.isZero()) {
      const std::optional<Pose>& X_WD = scene_.device.placement;
      const Vec3 turn_D = X_WD ? Vec3(X_WD->R.transpose() * turn_rad) : turn_rad;
      return goTo({rotationFromVector(turn_D), plant_->truePose().p});
    }
    const std::vector<Pose>& starts = segments_[step_].X_DH_start;
    if (segment_ + 1 < starts.size()) ++segment_;
    goTo(starts[segment_]);
  }
  void goOn() override {
    operator_.goOn();
    is_at_work_ = true;
  }

  void step(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) override {
    plant_->step(dt_s, is_at_work_ ? atWork(part, loop, dt_s) : returning(part, loop, dt_s));
  }

  [[nodiscard]] device::OperatorPhase phase() const override { return operator_.phase(); }
  [[nodiscard]] device::OperatorStrategy strategy() const override { return operator_.strategy(); }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  void goTo(const Pose& X_DH) {
    X_DH_back_ = X_DH;
    X_DH_from_ = plant_->truePose();
    turn_rad_ = rotationVector(X_DH_back_.R * X_DH_from_.R.transpose());
    back_s_ = 0;
    is_at_work_ = false;
  }

  device::HandForce atWork(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) {
    device::OperatorView view;
    view.time_s = time_s_;
    view.X_WG_hand = loop.toGrasp(plant_->truePose());
    view.V_WG_hand = loop.settings().map.toScene(plant_->trueTwist());
    view.X_WP = part.X_WP;
    view.V_WP = part.V_WP;
    view.F_hand_W = loop.last().F_hand_W;
    time_s_ += dt_s;
    device::HandForce hand = operator_.step(view, dt_s);
    hand.F = hand.F * loop.clutch().ratio();  // the clutch carries the rest of the weight
    return loop.toDevice(hand);
  }

  /// Force of the hand during and after its return. With a part in hand, the hand carries the share of
  /// the weight that the clutch passes on.
  device::HandForce returning(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) {
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
  std::vector<PathSegments> segments_;  ///< segments of each step
  std::unique_ptr<device::SimulatedDevice> plant_;
  device::VirtualOperator operator_, next_;
  double next_s_ = 0;
  std::size_t next_step_ = 0, step_ = 0, next_segment_ = 0, segment_ = 0;
  double time_s_ = 0;              ///< time of the run
  double back_s_ = kHandReturn_s;  ///< time since the hand began to return
  bool is_at_work_ = false;
  Pose X_DH_from_, X_DH_back_;
  Vec3 turn_rad_ = Vec3::Zero();
};

/// Judges a step whose motion comes from a person.
class PersonHand final : public Hand {
 public:
  explicit PersonHand(std::unique_ptr<device::Device> device) : device_(std::move(device)) {}
  device::Device& device() override { return *device_; }
  void prepare(const device::OperatorTask& task, std::size_t, double) override { next_ = task; }
  void begin() override {
    std::swap(task_, next_);
    step_s_ = at_target_s_ = 0;
    phase_ = device::OperatorPhase::Reach;
  }
  // The person moves the hand, so these functions do nothing.
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}

  void step(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) override {
    if (phase_ != device::OperatorPhase::Reach) return;
    step_s_ += dt_s;
    const Twist& V_WG = loop.last().V_WG;
    const bool is_at_rest = V_WG.v.norm() < kRest_m_s && V_WG.w.norm() < kRest_rad_s;
    at_target_s_ = is_at_rest && isAtTarget(part.X_WP) ? at_target_s_ + dt_s : 0;
    if (at_target_s_ >= kDone_s)
      phase_ = device::OperatorPhase::Done;
    else if (step_s_ > task_.timeout_s)
      phase_ = device::OperatorPhase::Failed;
  }
  [[nodiscard]] device::OperatorPhase phase() const override { return phase_; }
  [[nodiscard]] bool canGoOn(int) const override { return true; }

 private:
  // Time at the target after which a step is done. assumed: longer than a pause within a motion, shorter than
  // a person likes to wait
  static constexpr double kDone_s = 0.5;
  // A handle that is slower than this counts as at rest. assumed: OperatorHabits::rest_m_s, and the rotation
  // that gives this speed at a lever of 0.1 m
  static constexpr double kRest_m_s = 1e-3, kRest_rad_s = 1e-2;

  [[nodiscard]] bool isAtTarget(const Pose& X_WP) const {
    const Pose& X_target = task_.X_WP_target;
    return (X_WP.p - X_target.p).norm() <= task_.tolerance_m &&
           rotationVector(X_WP.R * X_target.R.transpose()).norm() <= task_.tolerance_rad;
  }

  std::unique_ptr<device::Device> device_;
  device::OperatorTask task_, next_;
  device::OperatorPhase phase_ = device::OperatorPhase::Idle;
  double step_s_ = 0, at_target_s_ = 0;
};

// Longest wait for a device to answer. assumed: SDL and spacenavd answer within one second
constexpr std::chrono::seconds kConnect{3};
constexpr std::chrono::milliseconds kConnectPoll{10};

/// Options of a device that a person moves. The range of a handle under rate control can be chosen: four
/// times the length of all paths.
device::DeviceOptions personOptions(const Scene& scene) {
  double path_m = 0;
  for (const SceneStep& step : scene.steps) {
    Vec3 p_W = step.X_WP_start.p;
    for (const Pose& X_WP : step.way_points) {
      path_m += (X_WP.p - p_W).norm();
      p_W = X_WP.p;
    }
    path_m += (step.X_WP_target.p - p_W).norm();
  }
  device::DeviceOptions options = optionsOf(scene);
  options.workspace_m = options.workspace_m.cwiseMax(Vec3::Constant(4 * path_m / scene.device.scale));
  return options;
}

std::unique_ptr<Hand> connectedPerson(const Scene& scene, const device::DeviceKind& kind,
                                      const device::DeviceOptions& options) {
  const auto refuse = [&](const std::string& why) {
    throw LoadError(scene.file, "",
                    "device '" + std::string(kind.name) + "': " + why + "; " + std::string(kind.remedy));
  };
  if (const std::string missing = kind.missing(); !missing.empty()) refuse(missing);
  std::unique_ptr<device::Device> device = kind.open(options);
  const auto end = std::chrono::steady_clock::now() + kConnect;
  while (device->read().status != Status::Ok) {
    if (std::chrono::steady_clock::now() > end) refuse("does not answer");
    std::this_thread::sleep_for(kConnectPoll);
  }
  return personHand(std::move(device));
}

/// Repeats a recording: its samples contain the motion, and its events contain the hand's phases.
class RecordedHand final : public Hand {
 public:
  explicit RecordedHand(device::Recording& recording) : recording_(recording) {}
  device::Device& device() override { return recording_; }
  void prepare(const device::OperatorTask&, std::size_t, double) override {}
  void begin() override {}
  void goBack(std::size_t) override {}
  void recentre() override {}
  void goOn() override {}
  void step(const device::HeldPart&, const device::HapticLoop&, double) override {}
  [[nodiscard]] device::OperatorPhase phase() const override {
    return device::stateFromByte(recording_.phase().value_or(0)).phase;
  }
  [[nodiscard]] device::OperatorStrategy strategy() const override {
    return device::stateFromByte(recording_.phase().value_or(0)).strategy;
  }
  [[nodiscard]] std::vector<RecordedEvent> events() const override {
    return recordedEvents(recording_.run().entries);
  }
  [[nodiscard]] bool canGoOn(int ticks) const override {
    return recording_.left() >= static_cast<std::size_t>(ticks);
  }

 private:
  device::Recording& recording_;
};

}  // namespace

std::unique_ptr<HapticDriver> Hand::makeDriver(const device::LoopSettings&, double, const ReportFault&,
                                               device::RunLog*) {
  return nullptr;
}

std::unique_ptr<Hand> makeHand(const Scene& scene, bool is_real_time,
                               std::shared_ptr<device::HandleWish> wish) {
  const device::DeviceKind& kind = kindOf(scene);
  if (kind.isSimulated()) return simulatedHand(scene);
  if (!is_real_time)
    throw LoadError(scene.file, "",
                    "device '" + scene.device.kind +
                        "' is moved by a person, so it cannot be used in simulated time; add --real-time");
  device::DeviceOptions options = personOptions(scene);
  options.wish = std::move(wish);
  return connectedPerson(scene, kind, options);
}

std::unique_ptr<Hand> simulatedHand(const Scene& scene) {
  return std::make_unique<SimulatedHand>(scene);
}

std::unique_ptr<Hand> personHand(std::unique_ptr<device::Device> device) {
  return std::make_unique<PersonHand>(std::move(device));
}

std::unique_ptr<Hand> recordedHand(device::Recording& recording) {
  return std::make_unique<RecordedHand>(recording);
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Physics, haptic driver, parts in place and load shedding of one run, advanced together step by step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "haptics/haptic_driver.h"
#include "load/load_shedder.h"
#include "simulation/simulation.h"
#include "simulation/tick_times.h"
#include "vps_device/local_contact.h"
#include "vps_device/run_log.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"
#include "world/axis_snap.h"
#include "world/placed_parts.h"

namespace vps::scenes {

/// The part that the current step moves.
struct StepPart {
  std::size_t part = 0;
  Pose X_PG;  ///< grasp frame, at the centre of mass
  Pose X_WP_target;
  Box box_P;
  Vec3 weight_W = Vec3::Zero();
  double hoist_N = 0;  ///< share of the weight that a hoist carries [N]; weight_W excludes the share
  double energy_at_grasp_J = 0;  ///< mechanical energy when the part was taken
};

/// State of a run at one instant.
struct AssemblyState {
  double time_s = 0;
  int step = -1;  ///< index into Scene::steps; -1 before the first step and after the last
  std::vector<Pose> X_WP;
  std::vector<BodyRole> roles;
  StepPart moving;
  bool is_holding = false;  ///< the hand holds the moving part
  bool gives_up = false;    ///< the part was released on request
  Pose X_WP_before;         ///< pose of the moving part at the start of the last physics step
};

class AssemblyWorld {
 public:
  /// Scene, hand, log and options must outlive this object. The scene has the models of the plan; its fixed
  /// parts are put in place.
  /// @param log  may be null; receives the device's samples and wrenches
  AssemblyWorld(Scene& scene, const ModelPlan& plan, Hand& hand, device::RunLog* log,
                const device::LoopSettings& settings, const AssembleOptions& options,
                const ReportFault& on_fault);

  /// Puts the step's part at its start and couples it to the hand; if the device's placement is known and a
  /// person moves the device, the part starts at the hand. Throws LoadError for a part that starts inside
  /// another part.
  void take(std::size_t step);
  /// Uncouples the part, which stays a dynamic body.
  /// @param is_held  something else, such as a fixture, holds the part from now on
  void release(bool is_held);
  /// Fixes the part at a pose, so that it is no longer a dynamic body. The judge then measures against the
  /// part, unless the step took the part off, and no longer against a part that the next step takes off.
  void mount(const Pose& X_WP);
  /// Sets the share of the coupling gains that holds the part in hand.
  void setGrip(double share);
  /// Stops a loop with local contact between two steps, because the models that the loop uses change.
  void pauseLocalContact();
  /// Runs one physics step with its haptic ticks. If the hand cannot continue (end of a recording), returns
  /// false without any effect.
  /// @param is_settling  the step is being judged and the next field is being cooked: the part's motion no
  /// longer counts, and neither regions nor load are monitored
  [[nodiscard]] bool advance(bool is_settling = false);
  /// The moving part as the hand and the haptic loop see it.
  [[nodiscard]] device::HeldPart heldPart() const;
  /// Ends the run after the last step: state().step becomes -1 and the hand stops.
  void finish();

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const AssembleOptions& options() const { return options_; }
  [[nodiscard]] const AssemblyState& state() const { return state_; }
  [[nodiscard]] const Pose& movingPose() const { return state_.X_WP[state_.moving.part]; }
  [[nodiscard]] const Simulation& simulation() const { return simulation_; }
  [[nodiscard]] HapticDriver& driver() const { return *driver_; }
  [[nodiscard]] PlacedParts& placed() { return placed_; }
  [[nodiscard]] LoadShedder& shedder() { return *shedder_; }
  /// Duration of a physics step in simulated time.
  [[nodiscard]] double dt_s() const { return dt_s_; }
  /// Duration of a physics step in real time, the time of the hand.
  [[nodiscard]] double handStep_s() const { return shedder_->dt_s() * shedder_->timeDivisor(); }
  /// False while the next part waits for a request.
  [[nodiscard]] bool mayTakeNext() const {
    const bool is_last = static_cast<std::size_t>(state_.step) + 1 >= scene_.steps.size();
    return options_.requests == nullptr || is_last || options_.requests->mayTake();
  }
  /// Whether the part is to be released on request. Call givesUp() after advance(), while the hand works.
  [[nodiscard]] bool givesUp() {
    state_.gives_up = driver_->givesUp(options_.requests != nullptr && options_.requests->isReleaseWanted());
    return state_.gives_up;
  }
  /// Whether the hand cannot continue.
  [[nodiscard]] bool hasEnded() const { return has_ended_; }
  /// Whether the run has ended or was stopped by the caller.
  [[nodiscard]] bool isStopped() const {
    return has_ended_ || (options_.stop != nullptr && options_.stop->load());
  }
  void reportProgress(double share_of_step) const;
  /// Sets the totals of the run in the result: times, energy, memory.
  void summarise(AssembleResult& result) const;

 private:
  /// Discards all entries, for runs without a log.
  class NullLog final : public device::RunLog {
    void add(const device::LogEntry&) noexcept override {}
  };

  std::unique_ptr<HapticDriver> makeDriver(Hand& hand, device::LoopSettings settings,
                                           const ReportFault& on_fault);
  void mountFixed();
  /// Pose at which the step's part starts.
  Pose startOf(const SceneStep& step);
  [[nodiscard]] Penetration overlapAt(const SceneStep& step, const Pose& X_WP);
  void requireFreeStart(const SceneStep& step);
  void startLocalContact();
  /// Models the remaining fixed parts if the moving part comes near the border of the step's region.
  void keepCovered();
  void giveSnapshot();
  void passEvents();
  void shedLoad();
  /// Pose of the hand that takes the part at X_WP.
  [[nodiscard]] Pose handAt(const Pose& X_WP) const;
  /// Applies the gains that were requested; called while no part is held.
  void changeGains();
  /// Applies axis snap to the part in hand, for the coming step.
  void snap();
  void step();

  Scene& scene_;
  ModelPlan plan_;
  device::RunLog* log_;
  const AssembleOptions& options_;
  Simulation simulation_;
  NullLog null_log_;
  device::TappedDevice tapped_;
  device::CouplingPort port_;
  device::LocalContact local_;
  std::unique_ptr<HapticDriver> driver_;
  PlacedParts placed_;
  std::optional<LoadShedder> shedder_;  ///< load shedding, which uses driver_
  AssemblyState state_;
  double dt_s_;
  double grip_ = 1;
  std::optional<AxisSnap> snap_;  ///< spring of the current step
  double snap_share_ = 0;         ///< share of the springs' force; changes over kSnapFade_s
  double stored_before_J_ = 0;    ///< energy stored in parts that were released earlier
  bool has_ended_ = false;
  TickClock physics_clock_;
  std::optional<RunFigures> figures_;  ///< last figures that the tap received
  double figures_time_s_ = 0;
};

}  // namespace vps::scenes

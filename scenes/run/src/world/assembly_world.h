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
  double hoist_N = 0;            ///< of its whole weight, what is not in weight_W
  double energy_at_grasp_J = 0;  ///< mechanical energy when it was taken
};

/// What a run knows of one instant.
struct AssemblyState {
  double time_s = 0;
  int step = -1;  ///< index into Scene::steps; -1 before the first step and after the last
  std::vector<Pose> X_WP;
  std::vector<BodyRole> roles;
  StepPart moving;
  bool is_holding = false;  ///< the hand holds the moving part
  bool gives_up = false;    ///< the part was let go of on request
  Pose X_WP_before;         ///< of the moving part at the start of the last physics step
};

class AssemblyWorld {
 public:
  /// Scene, hand, log and options outlive it. The scene has the models that the plan says; its fixed parts
  /// are put in place.
  /// @param log  may be null; gets what the device reads and is given
  AssemblyWorld(Scene& scene, const ModelPlan& plan, Hand& hand, device::RunLog* log,
                const device::LoopSettings& settings, const AssembleOptions& options,
                const ReportFault& on_fault);

  /// Puts the step's part at its start and couples it to the hand; where the device's place is known and a
  /// person moves it, the part starts where the hand is. Throws LoadError where it starts inside another
  /// part.
  void take(std::size_t step);
  /// Uncouples the part, which stays a dynamic body.
  /// @param is_held  something else holds it from here on
  void release(bool is_held);
  /// Fixes the part at a pose: it is no dynamic body any more. The judge measures against it, unless the step
  /// took it off, and no more against a part that the next step takes off.
  void mount(const Pose& X_WP);
  /// Sets the share of the coupling gains that holds the part in hand.
  void setGrip(double share);
  /// Between two steps a loop with local contact has to be stopped: its models change.
  void pauseLocalContact();
  /// One physics step with its haptic ticks. False, and nothing done, where the hand cannot go on (end of a
  /// recording).
  /// @param is_settling  the step is judged and the next one's field cooked: the part's motion does not count
  ///                     any more, and neither regions nor load are watched
  [[nodiscard]] bool advance(bool is_settling = false);
  /// The moving part as the hand and the haptic loop see it.
  [[nodiscard]] device::HeldPart heldPart() const;
  /// After the last step: state().step becomes -1 and the hand stops.
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
  /// Duration of a physics step in the hand's time, which is the clock's.
  [[nodiscard]] double handStep_s() const { return shedder_->dt_s() * shedder_->timeDivisor(); }
  /// False while the next part waits to be asked for.
  [[nodiscard]] bool mayTakeNext() const {
    const bool is_last = static_cast<std::size_t>(state_.step) + 1 >= scene_.steps.size();
    return options_.requests == nullptr || is_last || options_.requests->mayTake();
  }
  /// After advance(), while the hand works: others ask for the part to be let go of.
  [[nodiscard]] bool givesUp() {
    state_.gives_up = driver_->givesUp(options_.requests != nullptr && options_.requests->isReleaseWanted());
    return state_.gives_up;
  }
  /// The hand cannot go on.
  [[nodiscard]] bool hasEnded() const { return has_ended_; }
  /// Ended, or stopped by the caller.
  [[nodiscard]] bool isStopped() const {
    return has_ended_ || (options_.stop != nullptr && options_.stop->load());
  }
  void reportProgress(double share_of_step) const;
  /// Fills what the result says of the whole run: times, energy, memory.
  void summarise(AssembleResult& result) const;

 private:
  /// Where no log is wanted.
  class NullLog final : public device::RunLog {
    void add(const device::LogEntry&) noexcept override {}
  };

  std::unique_ptr<HapticDriver> makeDriver(Hand& hand, device::LoopSettings settings,
                                           const ReportFault& on_fault);
  void mountFixed();
  /// Where the part starts.
  Pose startOf(const SceneStep& step);
  [[nodiscard]] Penetration overlapAt(const SceneStep& step, const Pose& X_WP);
  void requireFreeStart(const SceneStep& step);
  void startLocalContact();
  /// Models the other fixed parts if the moving part comes near the border of its region.
  void keepCovered();
  void giveSnapshot();
  void passEvents();
  void shedLoad();
  /// Gains that others wish, while nothing is held.
  [[nodiscard]] Pose handAt(const Pose& X_WP) const;
  void changeGains();
  /// Axis snap on the part in hand, for the coming step.
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
  std::optional<LoadShedder> shedder_;  ///< of driver_
  AssemblyState state_;
  double dt_s_;
  double grip_ = 1;
  std::optional<AxisSnap> snap_;  ///< of the step
  double snap_share_ = 0;         ///< of its springs; changes over kSnapFade_s
  double stored_before_J_ = 0;    ///< energy stored in parts that were released before
  bool has_ended_ = false;
  TickClock physics_clock_;
  std::optional<RunFigures> figures_;  ///< as last given to the tap, and when
  double figures_time_s_ = 0;
};

}  // namespace vps::scenes

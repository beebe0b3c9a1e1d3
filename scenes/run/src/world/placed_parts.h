// SPDX-License-Identifier: BSD-3-Clause
// The parts in place during a run, fixed or mounted, in two forms: for the overlap judge, which measures
// against them, and as the fixed field that is cooked from these parts.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "judge/overlap_judge.h"
#include "models/fixed_field.h"
#include "simulation/simulation.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/model_plan.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Not thread-safe, except that another thread may read judge() and a judgedBody() while add() or leaveOut()
/// is called.
class PlacedParts {
 public:
  /// All arguments must outlive this object. widen() enlarges or removes regions of the plan.
  PlacedParts(Scene& scene, ModelPlan& plan, Simulation& simulation, const ModelOptions& options);

  /// Adds a part to the fields of later steps.
  void add(std::size_t part, const Pose& X_WP) { placed_.push_back({part, X_WP}); }
  /// Leaves a part out of the fields of later steps.
  void leaveOut(std::size_t part);
  /// From now on the judge measures against exactly the parts that are in place after add() and leaveOut().
  void renewJudge();
  /// From now on the judge also measures against this part, if it is modelled. add() must have added the
  /// part.
  void addToJudge(std::size_t part);
  [[nodiscard]] const OverlapJudge& judge() const { return judge_; }
  /// The part in the form for the judge, made at the first call. The reference stays valid until widen().
  const JudgedBody& judgedBody(std::size_t part);

  /// Order for the field of a step's region; empty if the field in place serves the step, or after the last
  /// step.
  [[nodiscard]] std::optional<FieldOrder> orderFor(std::size_t step);
  /// @param field  the cooked field; a field without a shape means that no part is in place
  void setField(CookedField field);

  /// Whether a moving part stays inside the step's region, with everything that it may reach in the coming
  /// physics step.
  /// @param V_W   velocity of the part's origin
  /// @param dt_s  physics step
  [[nodiscard]] bool isCovered(std::size_t step, const Box& box_P, const Pose& X_WP, const Twist& V_W,
                               double dt_s) const;
  /// Enlarges the step's region around the part, by its own size and at each later call for the step by twice
  /// as much; models the fixed parts in the region, and cooks the parts in place in the region. A part that
  /// leaves four such regions is no longer on its path; in this case all fixed parts are modelled everywhere,
  /// for all steps. widen() takes as long as loading the parts that it models.
  void widen(std::size_t step, const Box& box_P, const Pose& X_WP);

  /// How often widen() was called.
  [[nodiscard]] int widened() const { return widened_; }
  /// The parts' models and the largest field so far.
  [[nodiscard]] const ModelledCost& modelled() const { return modelled_; }

 private:
  /// @return the fixed parts that have to be modelled anew, in ascending order
  std::vector<std::size_t> widenTo(std::size_t step, const Box& region_W);
  [[nodiscard]] std::optional<FieldOrder> orderFor(std::size_t step, bool rebuilds);

  Scene& scene_;
  ModelPlan& plan_;
  Simulation& simulation_;
  const ModelOptions& options_;
  std::vector<FixedPart> placed_;  ///< parts in place, in the order of add()
  OverlapJudge judge_;
  std::vector<std::optional<JudgedBody>> judged_;  ///< judged bodies, by index of the part
  ModelledCost modelled_;
  int widened_ = 0;
  std::size_t widened_step_ = 0;
  int widened_in_step_ = 0;
};

/// Poses at which parts are cooked in a plan that has not run: fixed parts at their designed poses, other
/// parts where their steps put them.
class CookedPoses {
 public:
  explicit CookedPoses(const Scene& scene) {
    for (const ScenePart& part : scene.parts) X_WP_.push_back(part.X_WP);
    for (const SceneStep& step : scene.steps) X_WP_[step.part] = placeOf(step);
  }
  /// Returns `parts`, the parts of the field in place, followed by the parts that the step adds.
  [[nodiscard]] std::vector<FixedPart> add(std::vector<FixedPart> parts, const FieldPlan& step) const {
    for (const std::size_t i : step.cooked)
      if (std::ranges::none_of(parts, [i](const FixedPart& placed) { return placed.part == i; }))
        parts.push_back({i, X_WP_[i]});
    return parts;
  }

 private:
  std::vector<Pose> X_WP_;
};

}  // namespace vps::scenes

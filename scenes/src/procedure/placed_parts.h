// SPDX-License-Identifier: BSD-3-Clause
// What is in place during a run, fixed or mounted: as the judge measures against it, and as the field that is
// cooked from it.
#pragma once

#include <optional>
#include <vector>

#include "judge/overlap_judge.h"
#include "simulation/simulation.h"
#include "vps_scenes/model_options.h"

namespace vps::scenes {

/// Not thread-safe, but for fit(), which may be read elsewhere until the next call of another.
class PlacedParts {
 public:
  /// All outlive it. The plan loses its regions by widen().
  PlacedParts(Scene& scene, Plan& plan, Simulation& simulation, const ModelOptions& options);

  /// Puts down where a part lies, for the fields of later steps.
  void add(std::size_t part, const Pose& X_WP) { placed_.push_back({part, X_WP}); }
  /// The judge measures against it from now on: one that was added, if it is modelled.
  void addToJudge(std::size_t part);
  [[nodiscard]] const OverlapJudge& fit() const { return fit_; }
  /// Made when first asked for; stays where it is.
  const JudgedBody& judgedBody(std::size_t part);

  /// What to cook for a step's region; nothing if the field in place will do, or after the last step.
  [[nodiscard]] std::optional<FieldOrder> orderFor(std::size_t step);
  void setField(CookedField field);

  /// False when a moving part, with all that it may reach within the coming physics step, is not within the
  /// step's region any more.
  /// @param V_W   of its origin
  /// @param dt_s  physics step
  [[nodiscard]] bool isCovered(std::size_t step, const Box& box_P, const Pose& X_WP, const Twist& V_W,
                               double dt_s) const;
  /// Models the rest of what is fixed, and cooks all that is in place. Takes as long as loading.
  void widen(std::size_t step);

  [[nodiscard]] int widened() const { return widened_; }
  /// Own models and the largest field so far.
  [[nodiscard]] const ModelledCost& modelled() const { return modelled_; }

 private:
  Scene& scene_;
  Plan& plan_;
  Simulation& simulation_;
  const ModelOptions& options_;
  std::vector<FixedPart> placed_;  ///< in the order they came in
  OverlapJudge fit_;
  std::vector<std::optional<JudgedBody>> fit_bodies_;  ///< by part
  ModelledCost modelled_;
  int widened_ = 0;
};

}  // namespace vps::scenes

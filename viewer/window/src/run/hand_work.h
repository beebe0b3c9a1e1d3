// SPDX-License-Identifier: BSD-3-Clause
// The parts that were put down in the window, with undo and redo, and the scene for the next run. Independent
// of window and run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/run/derived_scenes.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// The work follows the procedure step by step, or is free: any part at any time. Undo restores the state
/// before the step exactly, so that the same motion gives the same bits again.
class VPS_VIEWER_API HandWork {
 public:
  /// The scene must outlive the HandWork.
  explicit HandWork(const scenes::Scene& scene) : scene_(&scene) {}

  /// Begins anew.
  /// @param is_free  false: the work follows the procedure
  void begin(bool is_free);
  [[nodiscard]] bool isFree() const { return is_free_; }

  /// Adds a finished step of the procedure, or a part that was put down in free assembly. Undone steps cannot
  /// be redone afterwards.
  void putDown(const scenes::PutDown& put, const scenes::StepResult& result = {});
  /// Undoes the last step. Returns false if there is no step to undo.
  bool undo();
  /// Restores the step that was undone last. Returns false if no step was undone.
  bool redo();

  /// Index of the procedure's next step; the number of steps if all are done.
  [[nodiscard]] std::size_t nextStep() const { return done_.size(); }
  [[nodiscard]] bool isOver() const { return !is_free_ && nextStep() >= scene_->steps.size(); }
  /// Results of the finished steps.
  [[nodiscard]] std::vector<scenes::StepResult> results() const;
  /// The scene of the next run: the procedure from nextStep() on, or in free assembly one part in hand.
  [[nodiscard]] scenes::Scene sceneToRun(std::optional<std::size_t> part = {}) const;
  /// All parts at their present poses.
  [[nodiscard]] scenes::Snapshot snapshot() const;

 private:
  struct Done {
    scenes::PutDown put;
    scenes::StepResult result;
  };
  [[nodiscard]] std::vector<Pose> poses() const;

  const scenes::Scene* scene_;
  bool is_free_ = false;
  std::vector<Done> done_, undone_;  ///< steps in the order of time
};

/// Adds the step results of earlier runs of the same work to a run's result, and updates the verdict of the
/// whole.
/// @param planned  number of steps of the whole procedure
VPS_VIEWER_API void addEarlierSteps(std::vector<scenes::StepResult> before, std::size_t planned,
                                    scenes::AssembleResult& result);

}  // namespace vps::viewer

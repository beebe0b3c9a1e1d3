// SPDX-License-Identifier: BSD-3-Clause
// What has been put down in the window: undo it, redo it, and the scene to go on with. Knows no window and no
// run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/run/put_down.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Either along the procedure, step after step, or freely, any part at any time. An undone step leaves
/// exactly what was before it, so that the same scene goes on: the same motion then gives the same bits.
class VPS_VIEWER_API HandWork {
 public:
  /// The scene outlives it.
  explicit HandWork(const scenes::Scene& scene) : scene_(&scene) {}

  /// Begins anew; false: along the procedure.
  void begin(bool is_free);
  [[nodiscard]] bool isFree() const { return is_free_; }

  /// A step of the procedure is done, or a part was put down freely. What was undone cannot be redone any
  /// more.
  void putDown(const scenes::PutDown& put, const scenes::StepResult& result = {});
  /// False, and nothing done, where there is none.
  bool undo();
  bool redo();

  /// Of the procedure: the step that comes next; its number of steps if all are done.
  [[nodiscard]] std::size_t nextStep() const { return done_.size(); }
  [[nodiscard]] bool isOver() const { return !is_free_ && nextStep() >= scene_->steps.size(); }
  /// What was found in the steps that are done.
  [[nodiscard]] std::vector<scenes::StepResult> results() const;
  /// From nextStep() on, or with that part in hand.
  [[nodiscard]] scenes::Scene sceneToRun(std::optional<std::size_t> part = {}) const;
  /// Where everything lies.
  [[nodiscard]] scenes::Snapshot snapshot() const;

 private:
  struct Done {
    scenes::PutDown put;
    scenes::StepResult result;
  };
  [[nodiscard]] std::vector<Pose> poses() const;

  const scenes::Scene* scene_;
  bool is_free_ = false;
  std::vector<Done> done_, undone_;  ///< the last one at the end
};

/// Adds what earlier runs of the same work have found: the results of all steps, and the verdict on the
/// whole.
VPS_VIEWER_API void addEarlierSteps(std::vector<scenes::StepResult> before, std::size_t planned,
                                    scenes::AssembleResult& result);

}  // namespace vps::viewer

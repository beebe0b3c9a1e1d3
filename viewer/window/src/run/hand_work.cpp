// SPDX-License-Identifier: BSD-3-Clause
#include "run/hand_work.h"

#include <algorithm>
#include <utility>

namespace vps::viewer {

void HandWork::begin(bool is_free) {
  is_free_ = is_free;
  done_.clear();
  undone_.clear();
}

void HandWork::putDown(const scenes::PutDown& put, const scenes::StepResult& result) {
  done_.push_back({put, result});
  undone_.clear();
}

bool HandWork::undo() {
  if (done_.empty()) return false;
  undone_.push_back(std::move(done_.back()));
  done_.pop_back();
  return true;
}

bool HandWork::redo() {
  if (undone_.empty()) return false;
  done_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  return true;
}

std::vector<scenes::StepResult> HandWork::results() const {
  std::vector<scenes::StepResult> results;
  for (const Done& done : done_) results.push_back(done.result);
  return results;
}

std::vector<Pose> HandWork::poses() const {
  std::vector<Pose> X_WP;
  if (is_free_) X_WP = scenes::laidOut(*scene_);
  for (std::size_t i = X_WP.size(); i < scene_->parts.size(); ++i) X_WP.push_back(scene_->parts[i].X_WP);
  for (const Done& done : done_) X_WP[done.put.part] = done.put.X_WP;
  return X_WP;
}

scenes::Scene HandWork::sceneToRun(std::optional<std::size_t> part) const {
  if (part) return scenes::sceneOfOnePart(*scene_, poses(), *part);
  std::vector<scenes::PutDown> before;
  for (const Done& done : done_) before.push_back(done.put);
  return scenes::sceneFromStep(*scene_, nextStep(), before);
}

scenes::Snapshot HandWork::snapshot() const {
  const std::vector<Pose> X_WP = poses();
  scenes::Snapshot shot;
  for (std::size_t i = 0; i < X_WP.size(); ++i) {
    const auto is_put = [i](const Done& done) { return done.put.part == i; };
    const bool lies = is_free_ || scene_->parts[i].is_fixed || std::ranges::any_of(done_, is_put);
    shot.bodies.push_back({i, X_WP[i], lies ? scenes::BodyRole::Mounted : scenes::BodyRole::Waiting});
  }
  return shot;
}

void addEarlierSteps(std::vector<scenes::StepResult> before, std::size_t planned,
                     scenes::AssembleResult& result) {
  if (before.empty()) return;
  std::ranges::move(result.steps, std::back_inserter(before));
  result.steps = std::move(before);
  result.verdict = scenes::verdictOf(result.steps, planned);
  const auto is_completed = [](const scenes::StepResult& step) { return step.completed; };
  result.completed = result.steps.size() == planned && std::ranges::all_of(result.steps, is_completed);
}

}  // namespace vps::viewer

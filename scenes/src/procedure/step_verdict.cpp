// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/step_verdict.h"

#include <algorithm>

namespace vps::scenes::inline v0 {

namespace {

constexpr double kPenetrationLimit_m = 10e-6;

const char* failureReason(const AssemblyWorld& world, const SceneStep& step, const StepResult& result,
                          bool is_done) {
  if (world.hasEnded()) return "the recording ends here";
  if (world.isStopped()) return "stopped";
  if (is_done && !isAtRest(result)) return "moved off its target after it was let go";
  if (is_done) return "the hand took it to be in place and let go, but it is off its target";
  return world.state().time_s - result.start_s > step.timeout_s
             ? "the hand gave up: target not reached in time"
             : "the hand gave up: target not reached";
}

}  // namespace

double penetrationLimit_m(const SceneStep& step) {
  return step.clearance_m > 0 ? std::min(kPenetrationLimit_m, step.clearance_m / 4) : kPenetrationLimit_m;
}

void judgeCompletion(const AssemblyWorld& world, const SceneStep& step, const Pose& X_WP,
                     StepResult& result) {
  result.final_error_m = (X_WP.p - step.X_WP_target.p).norm();
  result.final_error_rad = rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm();
  const bool is_on_target =
      result.final_error_m <= step.tolerance_m && result.final_error_rad <= step.tolerance_rad;
  const bool is_done = world.driver().phase() == device::OperatorPhase::Done;
  result.completed = is_done && is_on_target;
  if (!result.completed) result.failure_reason = failureReason(world, step, result, is_done);
}

}  // namespace vps::scenes::inline v0

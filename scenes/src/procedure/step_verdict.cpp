// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/step_verdict.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace vps::scenes::inline v0 {

namespace {

constexpr double kPenetrationLimit_m = 10e-6;

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string micrometres(double length_m) {
  return length_m < 1e-3 ? number(1e6 * length_m, 1) + " um" : number(1e3 * length_m, 2) + " mm";
}

std::string place(const Vec3& p_W) {
  std::string text = "(";
  for (int i = 0; i < 3; ++i) text.append(i == 0 ? "" : ", ").append(number(1e3 * p_W[i], 2));
  return text.append(") mm");
}

std::string failureReason(const AssemblyWorld& world, const SceneStep& step, const StepResult& result,
                          bool is_done) {
  if (world.hasEnded()) return "the recording ends here";
  if (world.isStopped()) return "stopped";
  const std::string where = "its surface was still up to " + micrometres(result.final_error_m) +
                            " from its target (tolerance " + micrometres(step.tolerance_m) + ")";
  if (is_done && !isAtRest(result)) return "it moved off its target after it was let go: " + where;
  if (is_done) return "the hand took it to be in place and let go, but " + where;
  const bool is_late = world.state().time_s - result.start_s > step.timeout_s;
  return std::string("the hand gave up") + (is_late ? " after its time was over: " : ": ") + where;
}

}  // namespace

double penetrationLimit_m(const SceneStep& step) {
  return step.clearance_m > 0 ? std::min(kPenetrationLimit_m, step.clearance_m / 4) : kPenetrationLimit_m;
}

void judgeCompletion(const AssemblyWorld& world, const SceneStep& step, const Pose& X_WP,
                     StepResult& result) {
  const Mesh& mesh = world.scene().parts[step.part].part.mesh;
  for (const Vec3& p_P : mesh.vertices)
    result.final_error_m = std::max(result.final_error_m, (X_WP * p_P - step.X_WP_target * p_P).norm());
  result.final_error_rad = rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm();
  const bool is_on_target =
      result.final_error_m <= step.tolerance_m && result.final_error_rad <= step.tolerance_rad;
  const bool is_done = world.driver().phase() == device::OperatorPhase::Done;
  result.completed = is_done && is_on_target;
  result.by_contact = result.completed && isGuided(result);
  if (!result.completed) result.failure_reason = failureReason(world, step, result, is_done);
}

void judgeStep(StepResult& result) {
  if (!result.blocked_by.empty()) {
    result.verdict = Verdict::Blocked;
    result.reason = "as drawn, it overlaps '" + result.blocked_by + "' by " +
                    micrometres(result.blocked_depth_m) + " (error " + micrometres(result.blocked_error_m) +
                    ") at " + place(result.blocked_at_W);
    return;
  }
  result.verdict = Verdict::NotShown;
  if (!result.completed) {
    result.reason = result.failure_reason;
  } else if (!isWithinLimit(result)) {
    result.reason = "on the way it was " + micrometres(result.max_penetration_m) + " deep in '" +
                    result.deepest_against + "', more than the " + micrometres(result.penetration_limit_m) +
                    " that count as contact";
  } else if (!isAtRest(result)) {
    result.reason = "it did not stay: within " + number(result.rest_s, 1) +
                    " s after it was let go it moved by " + micrometres(result.rest_drift_m);
  } else {
    result.verdict = Verdict::Fits;
  }
}

Verdict verdictOf(const std::vector<StepResult>& steps, std::size_t planned) {
  const auto has = [&](Verdict verdict) {
    return std::any_of(steps.begin(), steps.end(), [&](const StepResult& s) { return s.verdict == verdict; });
  };
  if (has(Verdict::Blocked)) return Verdict::Blocked;
  return has(Verdict::NotShown) || steps.size() < planned ? Verdict::NotShown : Verdict::Fits;
}

}  // namespace vps::scenes::inline v0

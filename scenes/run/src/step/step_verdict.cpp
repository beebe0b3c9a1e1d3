// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "fits/fit_tolerance.h"
#include "judge/surface_error.h"
#include "scene/insertion_axis.h"
#include "step/screw_motion.h"
#include "step/way_check.h"
#include "text/length_words.h"
#include "vps_scenes/run/put_down.h"
#include "world/displaced_mates.h"
#include "world/drawn_targets.h"
#include "world/lean_in_fits.h"

namespace vps::scenes {

namespace {

constexpr double kPenetrationLimit_m = 10e-6;

constexpr const char* kHoldsRemedy =
    "nothing holds it there; if a fixture or the next part will, say holds = true in its [[step]]";

std::string pressReason(const StepResult& step, double hand_N) {
  char words[240];
  std::snprintf(words, sizeof words,
                "the way is free, but pressing it %s takes about %.0f N (by the formula for its declared "
                "interference), and the hand has %.0f N ([operator] force_limit_N): it needs a press",
                step.is_taken_off ? "out" : "in", step.press_needed_N, hand_N);
  return words;
}

std::string failureReason(const AssemblyWorld& world, const SceneStep& step, const StepResult& result,
                          bool is_done, double brought_error_m) {
  if (world.hasEnded()) return "the recording ends here";
  if (world.isStopped()) return "stopped";
  const std::string tolerance = " (tolerance " + lengthInWords(result.tolerance_m) + ")";
  const std::string where =
      "its surface was up to " + lengthInWords(result.final_error_m) + " from where it belongs" + tolerance;
  if (is_done) {
    const bool was_there = brought_error_m <= result.tolerance_m;
    std::string words = was_there ? "the hand brought it to within " + lengthInWords(brought_error_m) +
                                        " of where it belongs" + tolerance + " and let go"
                                  : "the hand took it to be in place and let go, but its surface was up to " +
                                        lengthInWords(brought_error_m) + " from where it belongs" + tolerance;
    const bool has_left =
        result.final_error_m > result.tolerance_m && (was_there || result.rest_drift_m > result.tolerance_m);
    if (!isAtRest(result) || has_left)
      words.append("; then it moved by ")
          .append(lengthInWords(result.rest_drift_m))
          .append(": ")
          .append(kHoldsRemedy);
    return words;
  }
  if (world.state().gives_up) return "it was let go of on request: " + where;
  const bool is_late = world.state().time_s - result.start_s > step.timeout_s;
  if (!step.takes_off && is_late && result.final_error_m <= result.tolerance_m)
    return "its time (timeout_s) was over before the hand had pressed it home, so it is not shown to be in "
           "place: " +
           where + "; give it more time";
  std::string reason = std::string("the hand gave up") + (step.takes_off ? " taking it off" : "") +
                       (is_late ? " after its time was over: " : ": ");
  reason.append(where);
  if (!result.stuck_against.empty())
    reason.append("; it then touched '")
        .append(result.stuck_against)
        .append("' at ")
        .append(placeInWords(result.stuck_at_W));
  return reason;
}

/// How far beyond its target sight left a part that nothing stops there; 0 where more than sight's error.
double placedAlong_m(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m) {
  const Pose& X_PG = world.state().moving.X_PG;
  const Vec3 axis_W = insertionAxis(step, X_PG);
  if (step.motion == StepMotion::Screw || step.takes_off || axis_W.isZero()) return 0;
  const double along_m = axis_W.dot(X_WP * X_PG.p - step.X_WP_target * X_PG.p);
  if (std::abs(along_m) > kSightTolerance_m) return 0;
  return isFreeBeyondTarget(world, step, axis_W, kSightTolerance_m, limit_m) ? along_m : 0;
}

/// The tolerance of a part that is where it belongs on a part that is off its own place, within the tolerance
/// of that one: more by as much. Else as it was.
template <typename ErrorWithout>
double toleranceOnMates_m(AssemblyWorld& world, const StepResult& result, const ErrorWithout& errorWithout) {
  const auto step = static_cast<std::size_t>(world.state().step);
  for (const Vec3& by_m : displacedMates_m(world.scene(), step, world.state().X_WP))
    if (by_m.norm() <= kSightTolerance_m && errorWithout(by_m) <= result.tolerance_m)
      return std::max(result.tolerance_m + by_m.norm(), result.final_error_m);
  return result.tolerance_m;
}

double leanTolerance_m(AssemblyWorld& world) {
  return leanInFits_m(world.scene(), static_cast<std::size_t>(world.state().step)) + kContactOnBothSides_m;
}

}  // namespace

double penetrationLimit_m(const SceneStep& step) {
  return step.clearance_m > 0 ? std::min(kPenetrationLimit_m, step.clearance_m / 4) : kPenetrationLimit_m;
}

void judgeCompletion(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, const Pose& X_WP_brought,
                     StepResult& result) {
  const bool is_screw = step.motion == StepMotion::Screw;
  const Pose& X_PG = world.state().moving.X_PG;
  const auto judged = [&](const Pose& X) {
    return is_screw ? turnedBack(X, step, insertionAxis(step, X_PG), X_PG) : X;
  };
  const auto errorAt = [&](const Pose& X) {
    return surfaceError_m(*world.scene().parts[step.part].model->solid,
                          step.X_WP_target.inverse() * judged(X));
  };
  const Pose X_judged = judged(X_WP);
  result.final_error_m = errorAt(X_WP);
  // Where nothing stops the part along its way, the tolerance of its fit holds across it; and where the fit
  // is short, what it lets the part lean, since no stop holds it upright either.
  if (result.final_error_m > result.tolerance_m && result.tolerance_m < kSightTolerance_m) {
    const double along_m = placedAlong_m(world, step, X_WP, result.penetration_limit_m);
    const Vec3 along_W = along_m * insertionAxis(step, X_PG);
    const double across_m = along_m != 0 ? errorAt(Pose(X_WP.R, X_WP.p - along_W)) : 0;
    const bool is_given = step.tolerance_m > 0 || step.clearance_m > 0;
    const bool is_open =
        along_m != 0 && (across_m <= result.tolerance_m || (!is_given && across_m <= leanTolerance_m(world)));
    if (is_open) result.tolerance_m = kSightTolerance_m;
    if (!is_open && !is_given && result.stands_on.empty())
      result.tolerance_m = toleranceOnMates_m(
          world, result, [&](const Vec3& by_m) { return errorAt(Pose(X_WP.R, X_WP.p - by_m)); });
  }
  result.final_error_rad = rotationVector(X_judged.R * step.X_WP_target.R.transpose()).norm();
  const bool is_turned = step.tolerance_rad > 0 && result.final_error_rad > step.tolerance_rad;
  const bool is_done = world.driver().phase() == device::OperatorPhase::Done;
  result.completed = is_done && result.final_error_m <= result.tolerance_m && !is_turned;
  const std::string fault = is_screw ? threadFault(step, result) : "";
  result.completed = result.completed && fault.empty();
  result.by_contact = result.completed && isGuided(result);
  if (result.completed) return;
  const bool is_there = is_done && result.final_error_m <= result.tolerance_m && !is_turned;
  if (is_there && !fault.empty()) {
    result.failure_reason = "it is at its height, but " + fault;
    return;
  }
  result.failure_reason = failureReason(world, step, result, is_done, errorAt(X_WP_brought));
  if (is_done && is_turned && result.final_error_m <= result.tolerance_m)
    result.failure_reason.append("; it is turned by ")
        .append(degreesInWords(result.final_error_rad))
        .append(" (tolerance ")
        .append(degreesInWords(step.tolerance_rad))
        .append(")");
  if (!fault.empty()) result.failure_reason.append("; ").append(fault);
  if (!is_done && !is_screw && !world.isStopped()) result.failure_reason.append(wallOnTheWay(world, step));
}

void judgeStep(StepResult& result, double hand_N) {
  if (!result.blocked_by.empty()) {
    result.verdict = Verdict::Blocked;
    return;
  }
  result.verdict = Verdict::NotShown;
  if (!result.completed) {
    result.reason = result.failure_reason;
  } else if (!isWithinLimit(result)) {
    result.reason = "on the way it was " + lengthInWords(result.max_penetration_m) + " deep in '" +
                    result.deepest_against + "', more than the " + lengthInWords(result.penetration_limit_m) +
                    " that count as contact";
  } else if (!isAtRest(result)) {
    result.reason =
        "it moved by " + lengthInWords(result.rest_drift_m) + " after it was let go: " + kHoldsRemedy;
  } else if (result.press_needed_N > hand_N) {
    result.reason = pressReason(result, hand_N);
  } else if (!result.mesh_doubt.empty()) {
    result.reason = "the hand brought it home, but " + result.mesh_doubt;
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

}  // namespace vps::scenes

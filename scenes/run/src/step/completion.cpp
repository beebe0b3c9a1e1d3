// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_run.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fits/fits.h"
#include "judge/body_motion.h"
#include "scene/steps.h"
#include "step/place_in_play.h"
#include "step/screw_motion.h"
#include "step/way_check.h"
#include "text/words.h"
#include "world/drawn_targets.h"
#include "world/play_in_fits.h"

namespace vps::scenes {

namespace {

constexpr double kPenetrationLimit_m = 10e-6;

std::string failureReason(const AssemblyWorld& world, const SceneStep& step, const StepResult& result,
                          bool is_done, double brought_error_m) {
  if (world.hasEnded()) return "the recording ends here";
  if (world.isStopped()) return "stopped";
  const std::string tolerance = " (tolerance " + lengthInWords(result.tolerance_m) + ")";
  const std::string where = "the part's surface was up to " + lengthInWords(result.final_error_m) +
                            " from its place at the target" + tolerance;
  if (is_done) {
    const bool was_there = brought_error_m <= result.tolerance_m;
    std::string words =
        was_there ? "the hand brought the part to within " + lengthInWords(brought_error_m) +
                        " of its target" + tolerance + " and released it"
                  : "the hand took the part to be in place and released it, but its surface was up to " +
                        lengthInWords(brought_error_m) + " from its place at the target" + tolerance;
    const bool has_left =
        result.final_error_m > result.tolerance_m && (was_there || result.rest_drift_m > result.tolerance_m);
    if (!isAtRest(result) || has_left)
      words.append("; then it moved by ")
          .append(lengthInWords(result.rest_drift_m))
          .append(": ")
          .append(kHoldsRemedy);
    return words;
  }
  if (world.state().gives_up) return "the part was released on request: " + where;
  const bool is_late = world.state().time_s - result.start_s > step.timeout_s;
  if (!step.takes_off && is_late && result.final_error_m <= result.tolerance_m)
    return "the step's time (timeout_s) was over before the hand had pressed the part to its target, so the "
           "part is not shown to be in place: " +
           where + "; increase timeout_s";
  std::string reason = std::string("the hand gave up") + (step.takes_off ? " taking the part off" : "") +
                       (is_late ? " after its time was over: " : ": ");
  reason.append(where);
  if (!result.stuck_against.empty())
    reason.append("; the part then touched '")
        .append(result.stuck_against)
        .append("' at ")
        .append(placeInWords(result.stuck_at_W));
  return reason;
}

/// Error along the insertion axis of a part that nothing stops at its target; 0 if the error exceeds
/// kSightTolerance_m.
double placedAlong_m(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m) {
  const Pose& X_PG = world.state().moving.X_PG;
  const Vec3 axis_W = insertionAxis(step, X_PG);
  if (step.motion == StepMotion::Screw || step.takes_off || axis_W.isZero()) return 0;
  const double along_m = axis_W.dot(X_WP * X_PG.p - step.X_WP_target * X_PG.p);
  if (std::abs(along_m) > kSightTolerance_m) return 0;
  return isFreeBeyondTarget(world, step, axis_W, kSightTolerance_m, limit_m) ? along_m : 0;
}

/// The tolerance of a part whose mate is displaced within the mate's own tolerance: if the part is at its
/// place relative to the mate, its tolerance is greater by the mate's displacement. Otherwise the tolerance
/// is unchanged.
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

bool hasGivenTolerance(const SceneStep& step) {
  return step.tolerance_m > 0 || step.clearance_m > 0;
}

/// Widens tolerance_m of a part that nothing stops along its path: the tolerance of its fit then applies only
/// across the path. In a short fit the part may also lean as far as the fit allows, since no stop holds it
/// upright.
/// @param errorAt  surface error of the part at a pose
template <typename ErrorAt>
void widenTolerance(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, const ErrorAt& errorAt,
                    StepResult& result) {
  const double along_m = placedAlong_m(world, step, X_WP, result.penetration_limit_m);
  const Vec3 along_W = along_m * insertionAxis(step, world.state().moving.X_PG);
  const double across_m = along_m != 0 ? errorAt(Pose(X_WP.R, X_WP.p - along_W)) : 0;
  const bool is_given = hasGivenTolerance(step);
  const bool is_open =
      along_m != 0 && (across_m <= result.tolerance_m || (!is_given && across_m <= leanTolerance_m(world)));
  if (is_open) result.tolerance_m = kSightTolerance_m;
  if (!is_open && !is_given && result.stands_on.empty())
    result.tolerance_m = toleranceOnMates_m(
        world, result, [&](const Vec3& by_m) { return errorAt(Pose(X_WP.R, X_WP.p - by_m)); });
}

/// Widens tolerance_m to the part's error if its play allows the error (see PlaceInPlay); otherwise returns,
/// in words, how far the part is off along each axis, and what its play there is. A tolerance that the step
/// states holds as it is, and a screw or a part that is taken off has no play at its target.
std::string widenByPlay(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, StepResult& result) {
  if (hasGivenTolerance(step) || step.motion == StepMotion::Screw || step.takes_off) return {};
  // Farther off, no play is the reason.
  constexpr double kMostOff_m = 10e-3;
  if (result.final_error_m > kMostOff_m) return {};
  const PlaceInPlay place =
      placeInPlay(world.placed().judge(), world.placed().judgedBody(step.part), step.X_WP_target,
                  insertionAxis(step, world.state().moving.X_PG), X_WP, result.penetration_limit_m);
  if (!place.isPlaced(result.tolerance_m)) return inWords(place);
  result.tolerance_m = result.final_error_m;
  return {};
}

}  // namespace

double penetrationLimit_m(const SceneStep& step) {
  return step.clearance_m > 0 ? std::min(kPenetrationLimit_m, step.clearance_m / 4) : kPenetrationLimit_m;
}

void judgeCompletion(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, const Brought& brought,
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
  if (result.final_error_m > result.tolerance_m && result.tolerance_m < kSightTolerance_m)
    widenTolerance(world, step, X_WP, errorAt, result);
  const std::string off =
      result.final_error_m > result.tolerance_m ? widenByPlay(world, step, X_WP, result) : std::string();
  result.final_error_rad = rotationVector(X_judged.R * step.X_WP_target.R.transpose()).norm();
  const bool is_turned = step.tolerance_rad > 0 && result.final_error_rad > step.tolerance_rad;
  const bool is_done = world.driver().phase() == device::OperatorPhase::Done;
  const bool is_within = result.final_error_m <= result.tolerance_m;
  const std::string fault = is_screw ? threadFault(step, result) : "";
  const bool is_there = is_done && is_within && !is_turned;
  result.completed = is_there && fault.empty() && !brought.is_faulted;
  result.by_contact = result.completed && isGuided(result);
  if (result.completed) return;

  std::string& reason = result.failure_reason;
  if (is_there) {
    if (!fault.empty()) reason = "the part is at its height, but " + fault;
  } else {
    reason = failureReason(world, step, result, is_done, errorAt(brought.X_WP));
    if (is_done && !off.empty()) reason.append("; at its end the part was ").append(off);
    if (is_done && is_turned && is_within)
      reason.append("; the part is turned by ")
          .append(degreesInWords(result.final_error_rad))
          .append(" (tolerance ")
          .append(degreesInWords(step.tolerance_rad))
          .append(")");
    if (!fault.empty()) reason.append("; ").append(fault);
    if (!is_done && !is_screw && !world.isStopped()) reason.append(wallOnTheWay(world, step));
  }
  // A part that falls into its place while the device exerts no force was not brought there.
  if (brought.is_faulted)
    reason = "the device failed during the step, so that no hand held the part" +
             (reason.empty() ? "" : ": " + reason);
}

}  // namespace vps::scenes

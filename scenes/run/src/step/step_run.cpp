// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "haptics/clutching.h"
#include "judge/body_motion.h"
#include "scene/steps.h"
#include "step/place_in_play.h"
#include "step/screw_motion.h"
#include "step/way_check.h"
#include "vps_scenes/run/contact_episodes.h"

namespace vps::scenes {

namespace {

/// The vertex of the leading end that is farthest from the insertion axis through G, in P. Zero if the path
/// has no last leg.
Vec3 tipOf(const Scene& scene, const SceneStep& step, const Pose& X_PG) {
  const Vec3 axis_P = step.X_WP_target.R.transpose() * insertionAxis(step, X_PG);
  if (axis_P.isZero()) return Vec3::Zero();
  constexpr double kEnd_m = 10e-6;  // vertices of one end lie within this distance
  double lead_m = -std::numeric_limits<double>::infinity(), farthest_m = -1;
  const auto& vertices = scene.parts[step.part].part.mesh.vertices;
  for (const Vec3& p : vertices) lead_m = std::max(lead_m, axis_P.dot(p));
  Vec3 tip_P = Vec3::Zero();
  for (const Vec3& p : vertices) {
    const Vec3 off = p - X_PG.p;
    const double across_m = (off - axis_P * axis_P.dot(off)).norm();
    if (axis_P.dot(p) < lead_m - kEnd_m || across_m <= farthest_m) continue;
    farthest_m = across_m;
    tip_P = p;
  }
  return tip_P;
}

/// False if the leading end is round about the insertion axis through G, with vertices of its rim in all
/// directions.
bool hasCorners(const Scene& scene, const SceneStep& step, const Pose& X_PG, const Vec3& tip_P) {
  const Vec3 axis_P = step.X_WP_target.R.transpose() * insertionAxis(step, X_PG);
  if (axis_P.isZero() || tip_P.isZero()) return false;
  constexpr double kEnd_m = 10e-6, kRim = 0.97;  // kRim: share of the radius, within the chord of 12 flats
  constexpr int kSectors = 12;
  const Vec3 x = axis_P.unitOrthogonal(), y = axis_P.cross(x), tip = tip_P - X_PG.p;
  const double radius_m = std::hypot(tip.dot(x), tip.dot(y)), lead_m = axis_P.dot(tip_P);
  std::array<bool, kSectors> has_rim{};
  for (const Vec3& p : scene.parts[step.part].part.mesh.vertices) {
    const Vec3 off = p - X_PG.p;
    const double a_m = off.dot(x), b_m = off.dot(y);
    if (axis_P.dot(p) < lead_m - kEnd_m || std::hypot(a_m, b_m) < kRim * radius_m) continue;
    const double turn = std::atan2(b_m, a_m) / (2 * std::numbers::pi) + 0.5;
    has_rim[std::min<std::size_t>(kSectors - 1, static_cast<std::size_t>(turn * kSectors))] = true;
  }
  return !std::all_of(has_rim.begin(), has_rim.end(), [](bool has) { return has; });
}

device::OperatorTask taskOf(const AssemblyWorld& world, const SceneStep& step, double tolerance_m) {
  const StepPart& moving = world.state().moving;
  device::OperatorTask task;
  task.X_WP_start = step.X_WP_start;
  task.way_points = step.way_points;
  task.X_WP_target = step.X_WP_target;
  task.X_PG = moving.X_PG;
  task.tolerance_m = tolerance_m;
  if (step.tolerance_rad > 0) task.tolerance_rad = step.tolerance_rad;
  task.timeout_s = step.timeout_s;
  task.weight_W = moving.weight_W;
  task.tip_P = tipOf(world.scene(), step, moving.X_PG);
  task.has_corners = hasCorners(world.scene(), step, moving.X_PG, task.tip_P);
  task.is_taking_off = step.takes_off;
  if (step.motion == StepMotion::Screw) {
    task.screw.pitch_m = step.pitch_m;
    task.screw.torque_Nm = step.torque_Nm;
  }
  const double k_N_per_m = world.driver().settings().gains.k_N_per_m;
  task.give_m_per_N = k_N_per_m > 0 ? 1 / k_N_per_m : 0;
  return task;
}

TracePhase tracePhase(device::OperatorPhase phase) {
  if (phase == device::OperatorPhase::Press || phase == device::OperatorPhase::Done) return TracePhase::Press;
  return phase == device::OperatorPhase::Insert ? TracePhase::Insert : TracePhase::Reach;
}

bool isBusy(device::OperatorPhase phase) {
  return phase != device::OperatorPhase::Done && phase != device::OperatorPhase::Failed;
}

/// The physics thread tells the haptic loop where the part is before the loop's first tick.
void startHaptics(AssemblyWorld& world) {
  CouplingState part = world.simulation().graspState();
  part.is_coupled = true;
  part.time_s = world.state().time_s;
  world.driver().publish({part, 0, {}, world.heldPart()});
  world.driver().resume();
}

/// Keeps only the contact that holds the part back: the one with the greatest force along the path. Other
/// contacts may only guide the part that is taken off.
void keepWhatHoldsBack(const Vec3& axis_W, std::vector<ContactMark>& marks) {
  const auto along_N = [&](const ContactMark& mark) { return mark.force_N * std::abs(mark.n_W.dot(axis_W)); };
  const auto most = std::max_element(marks.begin(), marks.end(),
                                     [&](const auto& a, const auto& b) { return along_N(a) < along_N(b); });
  if (most != marks.end() && along_N(*most) > 0) marks = {ContactMark(*most)};
}

/// Sets stuck_against and stuck_at_W: the part in place that the moving part touches, at the contact that is
/// nearest to a part's surface.
void noteContact(AssemblyWorld& world, const SceneStep& step, StepResult& result) {
  std::vector<ContactMark> marks;
  world.simulation().contactMarks(marks);
  if (step.takes_off) keepWhatHoldsBack(insertionAxis(step, world.state().moving.X_PG), marks);
  double nearest_m = std::numeric_limits<double>::infinity();
  const Scene& scene = world.scene();
  for (const ContactMark& mark : marks)
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      const ScenePart& part = scene.parts[i];
      if (world.state().roles[i] != BodyRole::Mounted || !part.model || !part.model->solid) continue;
      const double distance_m =
          std::abs(part.model->solid->signedDistance(world.state().X_WP[i].inverse() * mark.p_W));
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      result.stuck_against = part.part.name;
      result.stuck_at_W = mark.p_W;
    }
}

/// Whether the part is held after the step, by the scene's setting or by its press fit.
bool isHeldAfter(const SceneStep& step, const StepResult& result) {
  return step.is_held || result.press_needed_N > 0;
}

/// The hand takes the part, brings it to its target and puts it down. Returns nullopt if the run is stopped.
std::optional<Brought> work(AssemblyWorld& world, RunTrace& trace, const SceneStep& step,
                            StepResult& result) {
  startHaptics(world);
  HapticDriver& driver = world.driver();
  const auto advanceIn = [&](TracePhase phase) {
    if (world.isStopped() || !world.advance()) return false;
    trace.add(world, phase, result);
    return true;
  };
  const auto reach = [&] { return advanceIn(TracePhase::Reach); };
  const bool is_screw = step.motion == StepMotion::Screw;
  const auto regrasp = [&] { return advanceIn(is_screw ? TracePhase::Insert : TracePhase::Reach); };
  const auto press = [&] { return advanceIn(TracePhase::Press); };
  const ClutchWork clutch(driver, [&world] { return world.handStep_s(); });
  if (!clutch.takeHold(reach)) return std::nullopt;
  driver.begin(taskOf(world, step, result.tolerance_m), static_cast<std::size_t>(world.state().step),
               world.state().time_s);
  trace.forgetPhase();
  trace.logPhase(world);
  while (isBusy(driver.phase()) && !world.isStopped() && world.advance()) {
    const device::OperatorPhase phase = driver.phase();
    trace.logPhase(world);
    trace.add(world, tracePhase(phase), result);
    const double elapsed_s = world.state().time_s - result.start_s;
    world.reportProgress(0.8 * std::min(1.0, elapsed_s / step.timeout_s * 2));
    if (world.givesUp()) break;
    if (phase != device::OperatorPhase::Regrasp) continue;
    ++result.index_count;
    if (!clutch.index(regrasp)) return std::nullopt;
    trace.logPhase(world);
  }
  const Brought brought{world.movingPose(),
                        world.state().gives_up || driver.phase() == device::OperatorPhase::Failed,
                        driver.last().status == Status::Fault};
  if (brought.is_given_up) noteContact(world, step, result);
  if (!clutch.comeFree(press)) return brought;
  if (isHeldAfter(step, result))
    return brought;  // the part is held by something else before the hand lets go
  clutch.setDown([&](double share) {
    world.setGrip(share);
    return press();
  });
  return brought;
}

/// Poses of a released part in the second half of its rest.
struct LateMotion {
  Pose X_WP_from, X_WP_to;  ///< at the start, and farthest from there
};

/// Watches the released part for scene.release_s, and at least until the empty hand has returned to the start
/// of the next part's path.
LateMotion rest(AssemblyWorld& world, RunTrace& trace, StepResult& result) {
  const Box& box_P = world.state().moving.box_P;
  const Pose X_WP_released = world.movingPose();
  LateMotion late{X_WP_released, X_WP_released};
  world.driver().goBack(static_cast<std::size_t>(world.state().step) + 1);
  world.driver().resume();
  const double first_dt_s = world.dt_s();
  const double steps = std::round(std::max(world.scene().release_s, kHandReturn_s) / first_dt_s);
  result.rest_s = steps * first_dt_s;
  for (double left = steps; left > 0 && !world.isStopped() && world.advance();
       left -= world.dt_s() / first_dt_s) {
    trace.add(world, TracePhase::Rest, result);
    const Pose& X_WP = world.movingPose();
    result.rest_drift_m = std::max(result.rest_drift_m, greatestDisplacement(box_P, X_WP_released, X_WP));
    if (left > steps / 2) late.X_WP_from = late.X_WP_to = X_WP;
    const double drift_m = greatestDisplacement(box_P, late.X_WP_from, X_WP);
    if (drift_m <= result.late_drift_m) continue;
    result.late_drift_m = drift_m;
    late.X_WP_to = X_WP;
  }
  return late;
}

/// Whether a part that is not at rest moves only as its play lets it, as a ball does that rolls about in its
/// hole. The hand must have let go of the part.
bool movesInPlay(AssemblyWorld& world, const SceneStep& step, const LateMotion& late,
                 const StepResult& result) {
  if (isAtRest(result) || step.takes_off || step.motion == StepMotion::Screw) return false;
  return movedWithinPlay(world.placed().judge(), world.placed().judgedBody(step.part), step.X_WP_target,
                         insertionAxis(step, world.state().moving.X_PG), late.X_WP_from, late.X_WP_to,
                         result.penetration_limit_m);
}

std::vector<StrategyUse> strategiesOf(std::span<const TraceRow> rows) {
  std::vector<StrategyUse> uses;
  int last = 0;
  for (const TraceRow& row : rows) {
    if (row.strategy != 0 && row.strategy != last)
      uses.push_back({toText(static_cast<device::OperatorStrategy>(row.strategy)), row.time_s, 0});
    last = row.strategy;
    if (last != 0) uses.back().duration_s = row.time_s - uses.back().start_s;
  }
  return uses;
}

}  // namespace

StepResult runStep(AssemblyWorld& world, RunTrace& trace, std::size_t index, StepResult result) {
  world.pauseLocalContact();
  const SceneStep& step = world.scene().steps[index];
  result.part = world.scene().parts[step.part].part.name;
  result.start_s = world.state().time_s;
  result.penetration_limit_m += penetrationLimit_m(step);  // in addition to the overlap as drawn

  RunRequests* requests = world.options().requests;
  if (requests != nullptr) requests->beginStep(static_cast<int>(index));
  world.take(index);
  result.hoist_N = world.state().moving.hoist_N;
  trace.beginStep(world);
  trace.logEvent(world, device::RunEventKind::Take,
                 (step.takes_off ? "takes off '" : "takes '") + result.part + "'");
  const std::optional<Brought> brought = work(world, trace, step, result);
  if (requests != nullptr) requests->endWork();
  world.pauseLocalContact();
  for (const ContactEpisode& episode : contactEpisodes(trace.stepRows()))
    ++(episode.is_slide ? result.slides : result.impacts);
  result.strategies = strategiesOf(trace.stepRows());
  if (step.motion == StepMotion::Screw) {
    const Pose& X_PG = world.state().moving.X_PG;
    measureScrew(trace.stepRows(), step, insertionAxis(step, X_PG), X_PG, result);
  }
  result.duration_s = world.state().time_s - result.start_s;
  trace.endStep(world);

  world.release(isHeldAfter(step, result));
  trace.logEvent(world, device::RunEventKind::LetGo, "lets go of '" + result.part + "'");
  const LateMotion late = rest(world, trace, result);
  result.moves_in_play = movesInPlay(world, step, late, result);
  world.reportProgress(0.9);
  // A part with which the hand gave up may fall far when it is released, which is no evidence about the fit.
  const Pose X_WP_end = brought && brought->is_given_up ? brought->X_WP : world.movingPose();
  judgeCompletion(world, step, X_WP_end, brought.value_or(Brought{X_WP_end}), result);
  if (!result.completed || !isFreeToTarget(world, step, X_WP_end, result.penetration_limit_m))
    result.aligned_by.clear();
  settleStep(world, trace.takeSamples(), result);
  Judgement judged = judge(evidenceOf(result, world.scene().hand.force_limit_N));
  result.verdict = judged.verdict;
  result.reason = std::move(judged.reason);
  return result;
}

}  // namespace vps::scenes

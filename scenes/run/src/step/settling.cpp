// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_run.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <thread>
#include <utility>

#include "core/machine.h"
#include "text/words.h"
#include "vps_device/periodic_thread.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kPoll{20};  // poll period. assumed: no delay that a person notices

template <typename T>
bool isReady(const std::future<T>& future) {
  return !future.valid() || future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Judges the samples on another thread. Until the result is ready, the placed parts must not be changed
/// except by PlacedParts::add().
std::future<OverlapVerdict> judgeAsync(AssemblyWorld& world, std::vector<OverlapSample> samples) {
  const double time_s = world.state().time_s;
  const bool follows = !samples.empty() && time_s - samples.back().time_s < 1.5 * world.dt_s();
  samples.push_back({time_s, world.movingPose(), 0, follows});
  const JudgedBody& body = world.placed().judgedBody(world.state().moving.part);
  const OverlapJudge& judge = world.placed().judge();
  const bool is_one_sided = world.scene().fidelity.sides == Sides::One;
  return std::async(std::launch::async, [&body, &judge, &options = world.options(), is_one_sided,
                                         samples = std::move(samples)]() mutable {
    device::leaveRealTime();  // a thread inherits the priority of its parent thread
    // One-sided contacts miss the edges of the side without points, so their depths do not show when the part
    // was deepest.
    if (is_one_sided)
      for (OverlapSample& sample : samples)
        sample.depth_m = std::max(sample.depth_m, judge.fieldDepth_m(body, sample.X_WP));
    return judgeSamples(judge, body, samples, options.judge_stride, options.stop);
  });
}

/// Cooks the next field on another thread. The future is not valid if the next step needs no other field.
std::future<CookedField> cookAsync(AssemblyWorld& world) {
  auto order = world.placed().orderFor(static_cast<std::size_t>(world.state().step) + 1);
  if (!order) return {};
  order->stop = world.options().stop;
  return std::async(std::launch::async, [order = std::move(*order)] {
    device::leaveRealTime();
    return cookField(order);
  });
}

void advanceUntil(AssemblyWorld& world, const std::function<bool()>& is_done) {
  while (!is_done() && !world.isStopped() && world.advance(true)) {
  }
}

void reportVerdict(const OverlapVerdict& verdict, const OverlapJudge& judge, StepResult& result) {
  result.max_penetration_m = verdict.worst.depth_m;
  result.deepest_at_W = verdict.worst.p_W;
  result.deepest_time_s = verdict.time_s;
  if (verdict.worst.depth_m > 0) result.deepest_against = judge.name(verdict.worst.against);
  if (!isWithinLimit(result) || verdict.unsearched_m <= result.penetration_limit_m) return;
  if (!result.mesh_doubt.empty()) result.mesh_doubt += "; and ";
  result.mesh_doubt +=
      "a motion between the poses of two physics steps was not searched to its end: its penetration may be "
      "up to " +
      lengthInWords(verdict.unsearched_m) + " deep";
}

/// Changes the parts in place to those of the next step.
void changePlaced(AssemblyWorld& world, const Pose& X_WP) {
  const auto& steps = world.scene().steps;
  const auto step = static_cast<std::size_t>(world.state().step);
  if (!steps[step].takes_off) world.placed().add(world.state().moving.part, X_WP);
  if (step + 1 < steps.size() && steps[step + 1].takes_off) world.placed().leaveOut(steps[step + 1].part);
}

void swapIn(PlacedParts& placed, CookedField field, StepResult& result) {
  result.cook_wall_s = field.wall_s;
  const double begun_s = wallSeconds();
  placed.setField(std::move(field));
  result.swap_wall_s = wallSeconds() - begun_s;
}

}  // namespace

void settleStep(AssemblyWorld& world, std::vector<OverlapSample> samples, StepResult& result) {
  HapticDriver& driver = world.driver();
  LoadShedder& shedder = world.shedder();
  if (driver.isByClock()) advanceUntil(world, [&] { return shedder.isReady(); });
  shedder.finish(world.state().time_s);  // ends resampling for the part that is now fixed
  std::future<OverlapVerdict> verdict = judgeAsync(world, std::move(samples));
  const bool stays = result.completed && result.aligned_by.empty();
  const Pose X_WP = stays ? world.movingPose() : world.state().moving.X_WP_target;
  changePlaced(world, X_WP);
  std::future<CookedField> field = cookAsync(world);
  const std::uint64_t missed_before = driver.missed();
  if (driver.isByClock())
    advanceUntil(
        world, [&] { return driver.hasSettled(isReady(verdict) && isReady(field) && world.mayTakeNext()); });
  while (!isReady(verdict) || !isReady(field)) {
    std::this_thread::sleep_for(kPoll);
    world.reportProgress(0.95);  // the callback may stop the run
  }
  result.missed_while_cooking = driver.missed() - missed_before;
  reportVerdict(verdict.get(), world.placed().judge(), result);
  world.mount(X_WP);
  if (!field.valid()) return;
  CookedField cooked = field.get();
  if (cooked.shape || !world.isStopped()) swapIn(world.placed(), std::move(cooked), result);
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/assembly_run.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/machine.h"
#include "models/scene_models.h"
#include "step/step_run.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"
#include "world/assembly_world.h"
#include "world/drawn_targets.h"
#include "world/run_trace.h"

namespace vps::scenes {

namespace {

/// A part that did not reach its target aligns no other part. The part that it should have aligned was put at
/// its target for this step and stays there for later steps, so the later steps are marked as depending on
/// that part.
void refuseAlignment(std::vector<StepResult>& steps, std::string& not_in_place) {
  StepResult& last = steps.back();
  if (isGood(last)) return;
  for (StepResult& step : steps) {
    if (step.aligned_by != last.part) continue;
    step.aligned_by.clear();
    if (last.stands_on.empty()) last.stands_on = step.part;
    if (not_in_place.empty()) not_in_place = step.part;
  }
}

void runSteps(AssemblyWorld& world, RunTrace& trace, const std::vector<StepResult>& drawn,
              AssembleResult& result) {
  result.completed = true;
  const std::size_t count = world.scene().steps.size();
  std::string not_in_place;
  for (std::size_t i = 0; i < count && !world.isStopped(); ++i) {
    StepResult known = drawn[i];
    known.stands_on = not_in_place;
    result.steps.push_back(runStep(world, trace, i, std::move(known)));
    refuseAlignment(result.steps, not_in_place);
    const StepResult& step = result.steps.back();
    if (!step.completed && not_in_place.empty()) not_in_place = step.part;
    result.completed = result.completed && step.completed;
    result.verdict = verdictOf(result.steps, count);
    if (world.options().on_step) {
      result.finished = snapshotOf(world);
      world.options().on_step(result);
    }
    if (!step.completed && !world.options().keep_going) break;
  }
  if (result.steps.size() < count) result.completed = false;
}

}  // namespace

void requireSteps(const Scene& scene) {
  if (scene.steps.empty())
    throw LoadError(scene.file, "",
                    "has no [[step]], so there is nothing to assemble; add one, or use `vps simulate`");
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    const auto moves = [i](const SceneStep& step) { return step.part == i; };
    if (part.is_fixed || part.is_scenery || std::any_of(scene.steps.begin(), scene.steps.end(), moves))
      continue;
    throw LoadError(scene.file, part.part.name,
                    "is not fixed, and no [[step]] moves it, so nothing would collide with it and the answer "
                    "could be wrong; give it a [[step]], fixed = true, or scenery = true if it is only to be "
                    "left out");
  }
}

std::unique_ptr<Hand> makeHand(const Scene& scene, const AssembleOptions& options) {
  if (options.device == nullptr) return makeHand(scene, options.is_real_time, options.wish);
  VPS_ASSERT(options.is_real_time);
  return personHand(options.device());
}

AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options) {
  const double begun_s = wallSeconds();
  std::shared_ptr<const CheckResult> checked;
  const std::vector<StepResult> drawn = checkDrawnTargets(scene, options.progress, &checked);
  const double checked_s = wallSeconds() - begun_s;
  AssembleResult result = runProcedure(scene, hand, log, settings, options, drawn);
  result.build_wall_s += checked_s;
  result.checked = std::move(checked);
  return result;
}

AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options,
                            const std::vector<StepResult>& drawn) {
  AssembleResult result;
  const double begun_s = wallSeconds();
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Assemble, options.models_everything);
  buildModels(scene, plan, options);
  RunTrace trace(scene, log);
  const AssemblyWorld* faulty = nullptr;  // null until the world is made; logEvent() reads its state
  AssemblyWorld world(scene, plan, hand, log, settings, options, [&](const std::string& fault) {
    if (faulty != nullptr) trace.logEvent(*faulty, device::RunEventKind::Note, "safety: " + fault);
  });
  faulty = &world;
  const double run_begun_s = wallSeconds();
  result.build_wall_s = run_begun_s - begun_s;

  runSteps(world, trace, drawn, result);
  world.finish();
  result.finished = snapshotOf(world);
  trace.moveTo(result);
  world.summarise(result);
  result.run_wall_s = wallSeconds() - run_begun_s;
  result.scene = scene.name;
  result.haptic_rate_hz = scene.fidelity.haptic_rate_hz;
  result.physics_rate_hz = scene.fidelity.physics_rate_hz;
  return result;
}

AssembleResult assemble(Scene& scene, const AssembleOptions& options) {
  requireSteps(scene);
  const std::unique_ptr<Hand> hand = makeHand(scene, options);
  return runProcedure(scene, *hand, nullptr, loopSettings(scene, hand->device()), options);
}

}  // namespace vps::scenes

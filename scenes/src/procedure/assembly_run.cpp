// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/assembly_run.h"

#include <utility>

#include "core/wall_clock.h"
#include "models/scene_models.h"
#include "procedure/assembly_world.h"
#include "procedure/run_trace.h"
#include "procedure/step_run.h"
#include "vps/load_error.h"

namespace vps::scenes::inline v0 {

namespace {

void runSteps(AssemblyWorld& world, RunTrace& trace, AssembleResult& result) {
  result.completed = true;
  const std::size_t count = world.scene().steps.size();
  for (std::size_t i = 0; i < count && !world.isStopped(); ++i) {
    result.steps.push_back(runStep(world, trace, i));
    if (result.steps.back().completed) continue;
    result.completed = false;
    if (!world.options().keep_going) break;
  }
  if (result.steps.size() < count) result.completed = false;
}

}  // namespace

void requireSteps(const Scene& scene) {
  if (scene.steps.empty())
    throw LoadError(scene.file, "",
                    "has no [[step]], so there is nothing to assemble; add one, or use `vps simulate`");
}

AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options) {
  AssembleResult result;
  const double begun_s = wallSeconds();
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Assemble, options.models_everything);
  buildModels(scene, plan, options);
  RunTrace trace(scene, log);
  const AssemblyWorld* faulty = nullptr;  // set before the first tick
  AssemblyWorld world(scene, plan, hand, log, settings, options, [&](const std::string& fault) {
    if (faulty != nullptr) trace.logEvent(*faulty, device::RunEventKind::Note, "safety: " + fault);
  });
  faulty = &world;
  const double run_begun_s = wallSeconds();
  result.build_wall_s = run_begun_s - begun_s;

  runSteps(world, trace, result);
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

}  // namespace vps::scenes::inline v0

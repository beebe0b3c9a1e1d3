// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/simulate.h"

#include <chrono>
#include <cmath>

#include "core/tick_times.h"
#include "core/wall_clock.h"
#include "haptics/physics_clock.h"
#include "models/scene_models.h"
#include "simulation/simulation.h"
#include "vps/load_error.h"

namespace vps::scenes {

namespace {

/// All that is fixed at once; one after the other where nothing is to be spared.
void cookFixed(const Scene& scene, const Plan& plan, Simulation& simulation) {
  const PlannedStep& step = plan.steps.front();
  std::vector<FixedPart> fixed;
  for (const std::size_t i : step.cooked) {
    fixed.push_back({i, scene.parts[i].X_WP});
    if (plan.models_everything || i == step.cooked.back())
      simulation.setField(cookField(simulation.orderField(fixed, step)), fixed.front().part);
  }
}

/// Waits for each step where the run goes by the clock.
class ByTheClock {
 public:
  ByTheClock(double period_s, bool is_wanted) : clock_(period_s), begun_s_(wallSeconds()) {
    if (!is_wanted) return;
    const device::RealTimeReport report = clock_.start(true);
    kept_ = {0, report.has_priority, report.has_locked_memory, report.warnings, 0};
  }
  ~ByTheClock() {
    if (kept_) clock_.stop();
  }
  ByTheClock(const ByTheClock&) = delete;
  ByTheClock& operator=(const ByTheClock&) = delete;
  void wait() noexcept {
    if (kept_) clock_.wait();
  }
  std::optional<SimulateResult::Kept> finish() {
    if (!kept_) return {};
    clock_.stop();
    kept_->missed = clock_.missed();
    kept_->run_wall_s = wallSeconds() - begun_s_;
    return kept_;
  }

 private:
  PhysicsClock clock_;
  double begun_s_;
  std::optional<SimulateResult::Kept> kept_;
};

}  // namespace

SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options) {
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw LoadError(scene.file, "", "the time to simulate must be a positive number of seconds");
  const double begun_s = wallSeconds();
  const Plan plan = makePlan(scene, PlanFor::Simulate, options.models_everything);
  buildModels(scene, plan, options);
  Simulation simulation(scene, plan);
  std::vector<std::size_t> moving;
  cookFixed(scene, plan, simulation);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].is_fixed) continue;
    simulation.addBody(i, scene.parts[i].X_WP);
    moving.push_back(i);
  }
  SimulateResult result;
  result.build_wall_s = wallSeconds() - begun_s;

  const double dt_s = 1 / scene.fidelity.physics_rate_hz;
  TickClock all(dt_s), touching(dt_s);
  const auto states = [&] {
    std::vector<BodyState> bodies;
    for (const std::size_t i : moving)
      bodies.push_back({scene.parts[i].part.name, simulation.pose(i), simulation.twist(i)});
    return bodies;
  };
  const auto steps = static_cast<long>(std::lround(seconds / dt_s));
  ByTheClock by_the_clock(dt_s, options.is_real_time);
  for (long i = 0; i < steps && !(options.stop != nullptr && options.stop->load()); ++i) {
    by_the_clock.wait();
    const auto step_begun = std::chrono::steady_clock::now();
    simulation.step(dt_s);
    const double us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - step_begun).count();
    const TouchState touch = simulation.touch();
    all.add(us);
    if (touch.contacts > 0) touching.add(us);
    result.max_penetration_m = std::max(result.max_penetration_m, touch.depth_m);
    if (options.trace) options.trace(static_cast<double>(i + 1) * dt_s, states(), touch.depth_m);
    if (options.progress)
      options.progress("simulating", static_cast<double>(i + 1) / static_cast<double>(steps));
  }
  result.real_time = by_the_clock.finish();
  result.bodies = states();
  result.kinetic_energy_J = simulation.kineticEnergy();
  result.step = all.summary();
  result.contact_step = touching.summary();
  result.modelled = modelledCost(scene);
  simulation.addField(result.modelled);
  return result;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/machine.h"
#include "models/scene_models.h"
#include "simulation/body_overlaps.h"
#include "simulation/physics_clock.h"
#include "simulation/scaled_scene.h"
#include "simulation/simulation.h"
#include "simulation/tick_times.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

/// Cooks all fixed parts at once, or one after another if all parts are modelled completely.
void cookFixed(const Scene& scene, const ModelPlan& plan, Simulation& simulation) {
  const FieldPlan& step = plan.steps.front();
  std::vector<FixedPart> fixed;
  for (const std::size_t i : step.cooked) {
    fixed.push_back({i, scene.parts[i].X_WP});
    if (plan.models_everything || i == step.cooked.back())
      simulation.setField(cookField(simulation.orderField(fixed, step)));
  }
}

/// Centres of mass of the moving parts; zero for the other parts.
std::vector<Vec3> centersOfMass(const Scene& scene, const Simulation& simulation) {
  std::vector<Vec3> centers_P(scene.parts.size(), Vec3::Zero());
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (!scene.parts[i].is_fixed) centers_P[i] = simulation.centreOfMass(i);
  return centers_P;
}

/// Budget of the judge for a step, in units of half a microsecond: about a third of the cost of a step with
/// this number of contacts (measured), and ten times as much if the user asked for judging.
double creditOf(const TouchState& touch, const SimulateOptions& options) {
  constexpr double kStep = 10, kContact = 12, kAsked = 10;
  return (kStep + kContact * touch.contacts) * (options.judge_every > 0 ? kAsked : 1);
}

double microsecondsSince(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begun).count();
}

/// Adds the scale to a warning about a mesh, which states widths of cracks.
std::string inLengthsOf(double factor) {
  char words[100];
  std::snprintf(words, sizeof words, " (lengths here are %.0f times those drawn)", factor);
  return words;
}

/// In real time, waits until each step is due; otherwise does nothing.
class StepPacer {
 public:
  StepPacer(double period_s, bool is_real_time) : clock_(period_s), begun_s_(wallSeconds()) {
    if (!is_real_time) return;
    const device::RealTimeReport report = clock_.start(true);
    real_time_ = {0, report.has_priority, report.has_locked_memory, report.warnings, 0};
  }
  ~StepPacer() {
    if (real_time_) clock_.stop();
  }
  StepPacer(const StepPacer&) = delete;
  StepPacer& operator=(const StepPacer&) = delete;
  void wait() noexcept {
    if (real_time_) clock_.wait();
  }
  std::optional<SimulateResult::RealTime> finish() {
    if (!real_time_) return {};
    clock_.stop();
    real_time_->missed = clock_.missed();
    real_time_->run_wall_s = wallSeconds() - begun_s_;
    return real_time_;
  }

 private:
  PhysicsClock clock_;
  double begun_s_;
  std::optional<SimulateResult::RealTime> real_time_;
};

/// Data for the judge about the end of a step or substep.
struct StepEnd {
  double time_s = 0;
  double credit = 0;  ///< see BodyOverlaps::endStep()
  std::vector<Pose> X_WP;
};

/// @param scale  the scene's lengths divided by the lengths as drawn
SimulateResult simulateAsGiven(Scene& scene, double seconds, const SimulateOptions& options, double scale) {
  const double begun_s = wallSeconds();
  const ModelPlan plan = makeModelPlan(scene, ModelPurpose::Simulate, options.models_everything);
  buildModels(scene, plan, options);
  Simulation simulation(scene, plan);
  std::vector<std::size_t> moving;
  cookFixed(scene, plan, simulation);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].is_fixed) continue;
    simulation.addBody(i, scene.parts[i].X_WP);
    simulation.setTwist(i, scene.parts[i].V_WP_W);
    moving.push_back(i);
  }
  SimulateResult result;
  result.build_wall_s = wallSeconds() - begun_s;

  const double dt_s = 1 / scene.fidelity.physics_rate_hz;
  TickClock all(dt_s), in_contact(dt_s);
  const auto states = [&] {
    std::vector<BodyState> bodies;
    for (const std::size_t i : moving)
      bodies.push_back({scene.parts[i].part.name, simulation.pose(i), simulation.twist(i)});
    return bodies;
  };
  const auto steps = static_cast<long>(std::lround(seconds / dt_s));
  BodyOverlaps overlaps(scene, centersOfMass(scene, simulation), scale);
  overlaps.judgeStart();
  const auto judge = [&](const StepEnd& end) {
    for (std::size_t k = 0; k < moving.size(); ++k) overlaps.move(moving[k], end.X_WP[k]);
    overlaps.endStep(end.time_s, end.credit, options.stop);
  };
  std::vector<StepEnd> left;  // step ends to be judged after the run
  if (options.is_real_time) left.reserve(static_cast<std::size_t>(std::clamp(steps, 0L, 1000000L)));
  long i = 0;
  double judged_us = 0;  // time that judging the step took
  const Simulation::AfterPart after_part = [&](int number, int parts) {
    const auto begun = std::chrono::steady_clock::now();
    const TouchState touch = simulation.touch();
    result.contact_depth_m = std::max(result.contact_depth_m, touch.depth_m);
    StepEnd end;
    end.time_s = number == parts ? static_cast<double>(i + 1) * dt_s
                                 : (static_cast<double>(i) + static_cast<double>(number) / parts) * dt_s;
    end.credit = creditOf(touch, options) / parts;
    for (const std::size_t part : moving) end.X_WP.push_back(simulation.pose(part));
    if (options.is_real_time)
      left.push_back(std::move(end));
    else
      judge(end);
    judged_us += microsecondsSince(begun);
  };
  StepPacer pacer(dt_s, options.is_real_time);
  for (; i < steps && !(options.stop != nullptr && options.stop->load()); ++i) {
    pacer.wait();
    const auto step_begun = std::chrono::steady_clock::now();
    judged_us = 0;
    simulation.step(dt_s, after_part);
    const double us = microsecondsSince(step_begun) - judged_us;
    const TouchState touch = simulation.touch();
    all.add(us);
    if (touch.contacts > 0) in_contact.add(us);
    const bool is_instant = options.judge_every > 0 && (i + 1) % options.judge_every == 0;
    if (!options.is_real_time && (is_instant || i + 1 == steps))
      overlaps.judge(static_cast<double>(i + 1) * dt_s);
    if (options.trace) options.trace(static_cast<double>(i + 1) * dt_s, states(), touch.depth_m);
    if (options.progress)
      options.progress("simulating", static_cast<double>(i + 1) / static_cast<double>(steps));
  }
  result.real_time = pacer.finish();
  result.bodies = states();
  for (const StepEnd& end : left) judge(end);
  if (options.is_real_time && i == steps) overlaps.judge(static_cast<double>(i) * dt_s);
  result.exact = overlaps.deepest();
  result.max_penetration_m = result.exact.deepest.depth_m;
  if (options.judge_every > 0) result.overlap = overlaps.result();
  result.kinetic_energy_J = simulation.kineticEnergy();
  result.shortened_steps = simulation.shortenedSteps();
  result.fast_turns = simulation.fastTurns();
  result.most_substeps = simulation.mostSubsteps();
  result.step = all.summary();
  result.contact_step = in_contact.summary();
  result.modelled = modelledCost(scene);
  simulation.addField(result.modelled);
  return result;
}

}  // namespace

SimulateResult simulate(Scene& scene, double seconds, const SimulateOptions& options) {
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw LoadError(scene.file, "", "the time to simulate must be a positive number of seconds");
  if (options.judge_every > 0 && options.is_real_time)
    throw LoadError(scene.file, "",
                    "overlap is measured between the steps, which takes too long for real time; leave out "
                    "--real-time or the measurement");
  const double factor = simulationScale(scene);
  if (factor == 1) return simulateAsGiven(scene, seconds, options, 1);
  requireModelsFit(scene, makeModelPlan(scene, ModelPurpose::Simulate, options.models_everything), options);
  Scene larger = scaledScene(scene, factor);
  SimulateOptions larger_options = options;
  if (options.warn)
    larger_options.warn = [&](const std::string& text) { options.warn(text + inLengthsOf(factor)); };
  if (options.trace)
    larger_options.trace = [&](double time_s, const std::vector<BodyState>& bodies, double max_depth_m) {
      options.trace(time_s, scaledBack(bodies, factor), max_depth_m / factor);
    };
  return scaledBack(simulateAsGiven(larger, seconds, larger_options, factor), factor);
}

}  // namespace vps::scenes

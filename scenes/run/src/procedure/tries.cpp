// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/assemble.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "models/scene_models.h"
#include "procedure/assembly_run.h"
#include "procedure/many_runs.h"
#include "vps/errors.h"
#include "world/drawn_targets.h"

namespace vps::scenes {

namespace {

TryResult summary(std::uint64_t seed, const AssembleResult& result) {
  TryResult made{seed, result.verdict, result.simulated_s, {}};
  const auto bad = std::ranges::find_if(result.steps, [](const StepResult& step) { return !isGood(step); });
  if (bad != result.steps.end()) made.reason = std::string(bad->part).append(": ").append(bad->reason);
  return made;
}

/// The tries of one scene, which threads run and add in any order.
class Tries {
 public:
  Tries(const Scene& scene, std::vector<StepResult> drawn, std::size_t count, const AssembleOptions& options)
      : scene_(scene), drawn_(std::move(drawn)), options_(options), tries_(count), shares_(count) {}

  void run(std::size_t i, const std::atomic<bool>& stop) {
    Scene scene = scene_;
    scene.hand.seed += i * scene.steps.size();
    AssembleOptions options = options_;
    options.stop = &stop;
    options.after_step = {};
    options.on_step = {};
    options.progress = [this, i](std::string_view, double share) { shares_[i] = share; };
    options.warn = [this](const std::string& words) {
      const std::lock_guard lock(mutex_);
      if (options_.warn) options_.warn(words);
    };
    const std::unique_ptr<Hand> hand = makeHand(scene, false);
    AssembleResult result =
        runProcedure(scene, *hand, nullptr, loopSettings(scene, hand->device()), options, drawn_);
    tries_[i] = summary(scene.hand.seed, result);
    shares_[i] = 1;
    const bool fits = isGood(result.verdict);
    const std::lock_guard lock(mutex_);
    // The best try is the first seed that fits, or else the first seed, in whatever order the threads end.
    if (best_try_ != tries_.size() && (best_fits_ != fits ? best_fits_ : best_try_ < i)) return;
    best_ = std::move(result);
    best_try_ = i;
    best_fits_ = fits;
  }

  void report(std::size_t begun) const {
    double share = 0;
    for (const std::atomic<double>& of : shares_) share += of;
    options_.progress("try " + std::to_string(begun) + " of " + std::to_string(tries_.size()),
                      share / static_cast<double>(tries_.size()));
  }

  AssembleResult take() {
    const auto good = std::ranges::count_if(tries_, [](const TryResult& one) { return isGood(one.verdict); });
    best_.ease_share = static_cast<double>(good) / static_cast<double>(tries_.size());
    best_.tries = std::move(tries_);
    return std::move(best_);
  }

 private:
  const Scene& scene_;
  std::vector<StepResult> drawn_;
  const AssembleOptions& options_;
  std::vector<TryResult> tries_;
  std::vector<std::atomic<double>> shares_;  ///< completed share of each try, 0 to 1
  std::mutex mutex_;                         ///< protects the members below and options_.warn
  AssembleResult best_;
  std::size_t best_try_ = tries_.size();  ///< index of the best try; tries_.size(): no try yet
  bool best_fits_ = false;
};

void requireTries(const Scene& scene, const TrySettings& settings, const AssembleOptions& options) {
  requireSteps(scene);
  if (settings.tries < 1) throw LoadError(scene.file, "", "cannot be tried less than once; choose 1 or more");
  if (options.is_real_time)
    throw LoadError(scene.file, "", "several tries run in simulated time only; leave out --real-time");
  makeHand(scene, false);  // refuses a device moved by a person, and paths out of reach
}

}  // namespace

AssembleResult assembleTries(const Scene& scene, const TrySettings& settings,
                             const AssembleOptions& options) {
  requireTries(scene, settings, options);
  std::shared_ptr<const CheckResult> checked;
  Scene modelled = scene;
  std::vector<StepResult> drawn = checkDrawnTargets(modelled, options.progress, &checked);
  const bool is_blocked =
      std::ranges::any_of(drawn, [](const StepResult& step) { return step.verdict == Verdict::Blocked; });
  buildModels(modelled, makeModelPlan(modelled, ModelPurpose::Assemble, options.models_everything), options);
  const std::size_t count = is_blocked ? 1 : static_cast<std::size_t>(settings.tries);
  Tries tries(modelled, std::move(drawn), count, options);
  ManyRunsOptions runs{.threads = settings.threads, .stop = options.stop};
  if (options.progress) runs.report = [&tries](std::size_t begun) { tries.report(begun); };
  forEachRun(count, runs, [&](std::size_t i, const std::atomic<bool>& stop) { tries.run(i, stop); });
  AssembleResult result = tries.take();
  result.checked = std::move(checked);
  return result;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/tries.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "models/scene_models.h"
#include "procedure/assembly_run.h"
#include "vps/errors.h"
#include "world/drawn_targets.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kTriesPoll{50};  // assumed: no delay that a person notices

TryResult summary(std::uint64_t seed, const AssembleResult& result) {
  TryResult made{seed, result.verdict, result.simulated_s, {}};
  const auto bad = std::find_if(result.steps.begin(), result.steps.end(),
                                [](const StepResult& step) { return !isGood(step); });
  if (bad != result.steps.end()) made.reason = std::string(bad->part).append(": ").append(bad->reason);
  return made;
}

/// What the threads share. Each takes the next seed until there are none.
class Tries {
 public:
  Tries(const Scene& scene, std::vector<StepResult> drawn, std::size_t count, const AssembleOptions& options)
      : scene_(scene), drawn_(std::move(drawn)), options_(options), tries_(count), shares_(count) {}

  void work() noexcept {
    for (std::size_t i = next_++; i < tries_.size() && !stop_; i = next_++) try {
        run(i);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
        stop_ = true;
      }
    ++finished_;
  }

  /// Tells the progress on the caller's thread, which may throw.
  void wait(unsigned threads) {
    while (finished_ < threads) {
      std::this_thread::sleep_for(kTriesPoll);
      if (options_.stop != nullptr && *options_.stop) stop_ = true;
      if (!options_.progress) continue;
      double share = 0;
      for (const std::atomic<double>& of : shares_) share += of;
      options_.progress("try " + std::to_string(std::min(tries_.size(), next_.load())) + " of " +
                            std::to_string(tries_.size()),
                        share / static_cast<double>(tries_.size()));
    }
  }
  void stop() { stop_ = true; }

  AssembleResult take() {
    if (error_) std::rethrow_exception(error_);
    const auto good = std::count_if(tries_.begin(), tries_.end(),
                                    [](const TryResult& one) { return one.verdict == Verdict::Fits; });
    best_.ease_share = static_cast<double>(good) / static_cast<double>(tries_.size());
    best_.tries = std::move(tries_);
    return std::move(best_);
  }

 private:
  void run(std::size_t i) {
    Scene scene = scene_;
    scene.hand.seed += i * scene.steps.size();
    AssembleOptions options = options_;
    options.stop = &stop_;
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
    const bool fits = result.verdict == Verdict::Fits;
    const std::lock_guard lock(mutex_);
    // The first seed that fits, or else the first seed: whichever thread comes first.
    if (best_try_ != tries_.size() && (best_fits_ != fits ? best_fits_ : best_try_ < i)) return;
    best_ = std::move(result);
    best_try_ = i;
    best_fits_ = fits;
  }

  const Scene& scene_;
  std::vector<StepResult> drawn_;
  const AssembleOptions& options_;
  std::vector<TryResult> tries_;
  std::vector<std::atomic<double>> shares_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<unsigned> finished_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::exception_ptr error_;
  AssembleResult best_;
  std::size_t best_try_ = tries_.size();  ///< none yet
  bool best_fits_ = false;
};

void requireTries(const Scene& scene, const TrySettings& settings, const AssembleOptions& options) {
  requireSteps(scene);
  if (settings.tries < 1) throw LoadError(scene.file, "", "cannot be tried less than once; choose 1 or more");
  if (options.is_real_time)
    throw LoadError(scene.file, "", "several tries run in simulated time only; leave out --real-time");
  makeHand(scene, false);  // refuses a person, and paths that are out of reach
}

}  // namespace

AssembleResult assembleTries(const Scene& scene, const TrySettings& settings,
                             const AssembleOptions& options) {
  requireTries(scene, settings, options);
  std::shared_ptr<const CheckResult> checked;
  std::vector<StepResult> drawn = checkDrawnTargets(scene, options.progress, &checked);
  const bool is_blocked = std::any_of(drawn.begin(), drawn.end(),
                                      [](const StepResult& step) { return !step.blocked_by.empty(); });
  Scene modelled = scene;
  buildModels(modelled, makeModelPlan(modelled, ModelPurpose::Assemble, options.models_everything), options);
  const std::size_t count = is_blocked ? 1 : static_cast<std::size_t>(settings.tries);
  const unsigned cores =
      settings.threads != 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(cores, count));
  Tries tries(modelled, std::move(drawn), count, options);
  std::vector<std::jthread> pool;
  for (unsigned i = 0; i < threads; ++i) pool.emplace_back([&tries] { tries.work(); });
  try {
    tries.wait(threads);
  } catch (...) {
    tries.stop();
    throw;  // the threads end first
  }
  pool.clear();
  AssembleResult result = tries.take();
  result.checked = std::move(checked);
  return result;
}

}  // namespace vps::scenes

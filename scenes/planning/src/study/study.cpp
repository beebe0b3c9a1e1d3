// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/study.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <utility>

#include "procedure/assembly_run.h"
#include "procedure/many_runs.h"
#include "record/scene_archive.h"
#include "study/variants.h"
#include "vps/stoppable.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {

namespace {

/// The runs of one study, which several threads make and add in any order.
class Study {
 public:
  Study(const Scene& scene, const std::vector<StudyVariable>& variables, const StudySettings& settings,
        const std::vector<std::size_t>& numbers, const StudyOptions& options)
      : scene_(scene), variables_(variables), settings_(settings), numbers_(numbers), options_(options) {}

  /// Makes one run and adds it; a run that was stopped has no valid verdict and is dropped.
  void makeRun(std::size_t index, const std::atomic<bool>& stop) {
    const Progress until_stopped = [&stop](std::string_view, double) {
      if (stop) throw RunStopped();
    };
    const StoppableWork work(until_stopped);
    StudyRun made = run(numbers_[index], stop);
    const std::lock_guard lock(mutex_);
    if (stop) return;
    if (options_.on_run) options_.on_run(made);
    runs_.push_back(std::move(made));
    ++ended_;
  }

  void report() const {
    options_.progress("run " + std::to_string(ended_) + " of " + std::to_string(numbers_.size()),
                      static_cast<double>(ended_) / static_cast<double>(numbers_.size()));
  }

  std::vector<StudyRun> take() {
    std::ranges::sort(runs_, {}, &StudyRun::run);
    return std::move(runs_);
  }

 private:
  StudyRun run(std::size_t number, const std::atomic<bool>& stop) {
    StudyRun out;
    out.run = number;
    out.values = sampleStudy(variables_, settings_.seed, number);
    Scene scene = sampledScene(scene_, variables_, settings_.seed, number);
    DrawnMisfit misfit = fit_.findMisfit(scene);
    out.verdict = misfit.verdict;
    out.reason = std::move(misfit.reason);
    out.part = std::move(misfit.part);
    if (settings_.has_contact && isGood(out.verdict)) byContact(scene, stop, out);
    return out;
  }

  void byContact(Scene& scene, const std::atomic<bool>& stop, StudyRun& out) {
    AssembleOptions options;
    static_cast<ModelOptions&>(options) = options_;
    options.progress = {};
    options.warn = {};  // warnings would be the same for each run
    options.stop = &stop;
    const AssembleResult result = assemble(scene, options);
    out.verdict = result.verdict;
    out.simulated_s = result.simulated_s;
    const auto bad = std::ranges::find_if(result.steps, [](const StepResult& step) { return !isGood(step); });
    if (bad == result.steps.end()) return;
    out.part = bad->part;
    out.reason = bad->reason;
  }

  const Scene& scene_;
  const DrawnFit fit_{scene_};
  const std::vector<StudyVariable>& variables_;
  const StudySettings& settings_;
  const std::vector<std::size_t>& numbers_;
  const StudyOptions& options_;
  std::atomic<std::size_t> ended_ = 0;
  std::mutex mutex_;  ///< guards runs_ and the calls of options_.on_run
  std::vector<StudyRun> runs_;
};

}  // namespace

std::vector<StudyRun> runStudy(const Scene& scene, const std::vector<StudyVariable>& variables,
                               const StudySettings& settings, const std::vector<std::size_t>& numbers,
                               const StudyOptions& options) {
  requireSteps(scene);
  if (numbers.empty()) return {};
  Study study(scene, variables, settings, numbers, options);
  ManyRunsOptions runs{.threads = settings.threads, .has_one_core_each = true, .stop = options.stop};
  if (options.progress) runs.report = [&study](std::size_t) { study.report(); };
  forEachRun(numbers.size(), runs,
             [&](std::size_t i, const std::atomic<bool>& stop) { study.makeRun(i, stop); });
  return study.take();
}

std::string studyFingerprint(const Scene& scene, const std::vector<StudyVariable>& variables,
                             const StudySettings& settings) {
  std::string bytes = sceneToBytes(scene);
  const auto put = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  for (const StudyVariable& variable : variables) {
    bytes.append(variable.name).push_back('\0');
    put(static_cast<int>(variable.quantity));
    put(static_cast<int>(variable.is_hole));
    put(static_cast<int>(variable.distribution));
    put(variable.lower);
    put(variable.upper);
  }
  put(settings.seed);
  put(static_cast<int>(settings.has_contact));
  return contentHash(bytes);
}

}  // namespace vps::scenes

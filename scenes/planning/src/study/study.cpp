// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/study.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "procedure/assembly_run.h"
#include "record/scene_archive.h"
#include "study/drawn_fit.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kStudyPoll{50};  // assumed: no delay that a person notices

/// Makes one run after the other on each of its threads.
class Study {
 public:
  Study(const Scene& scene, const std::vector<StudyVariable>& variables, const StudySettings& settings,
        const std::vector<std::size_t>& numbers, const StudyOptions& options)
      : scene_(scene), variables_(variables), settings_(settings), numbers_(numbers), options_(options) {}

  /// Each thread has an arena of one core, so that runs do not share cores.
  void work() noexcept {
    tbb::task_arena arena(1);
    for (std::size_t i = next_++; i < numbers_.size() && !stop_; i = next_++) try {
        StudyRun made;
        arena.execute([&] { made = run(numbers_[i]); });
        keep(std::move(made));
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
      std::this_thread::sleep_for(kStudyPoll);
      if (options_.stop != nullptr && *options_.stop) stop_ = true;
      if (options_.progress)
        options_.progress("run " + std::to_string(ended_) + " of " + std::to_string(numbers_.size()),
                          static_cast<double>(ended_) / static_cast<double>(numbers_.size()));
    }
  }
  void stop() { stop_ = true; }

  std::vector<StudyRun> take() {
    if (error_) std::rethrow_exception(error_);
    std::ranges::sort(runs_, {}, &StudyRun::run);
    return std::move(runs_);
  }

 private:
  StudyRun run(std::size_t number) {
    StudyRun out;
    out.run = number;
    out.values = sampleStudy(variables_, settings_.seed, number);
    Scene scene = sampledScene(scene_, variables_, settings_.seed, number);
    if (DrawnMisfit misfit = fit_.findMisfit(scene); misfit.isFound()) {
      out.verdict = Verdict::Blocked;
      out.part = std::move(misfit.part);
      out.reason = std::move(misfit.reason);
    } else if (settings_.has_contact) {
      byContact(scene, out);
    } else {
      out.verdict = Verdict::Fits;
    }
    return out;
  }

  void byContact(Scene& scene, StudyRun& out) {
    AssembleOptions options;
    static_cast<ModelOptions&>(options) = options_;
    options.progress = {};
    options.warn = {};  // the same for each run
    options.stop = &stop_;
    const AssembleResult result = assemble(scene, options);
    out.verdict = result.verdict;
    out.simulated_s = result.simulated_s;
    const auto bad = std::ranges::find_if_not(result.steps, isGood);
    if (bad == result.steps.end()) return;
    out.part = bad->part;
    out.reason = bad->reason;
  }

  /// A run that was stopped has no verdict that counts.
  void keep(StudyRun made) {
    const std::lock_guard lock(mutex_);
    if (stop_) return;
    if (options_.on_run) options_.on_run(made);
    runs_.push_back(std::move(made));
    ++ended_;
  }

  const Scene& scene_;
  const DrawnFit fit_{scene_};
  const std::vector<StudyVariable>& variables_;
  const StudySettings& settings_;
  const std::vector<std::size_t>& numbers_;
  const StudyOptions& options_;
  std::atomic<std::size_t> next_ = 0, ended_ = 0;
  std::atomic<unsigned> finished_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::exception_ptr error_;
  std::vector<StudyRun> runs_;
};

}  // namespace

std::vector<StudyRun> runStudy(const Scene& scene, const std::vector<StudyVariable>& variables,
                               const StudySettings& settings, const std::vector<std::size_t>& numbers,
                               const StudyOptions& options) {
  requireSteps(scene);
  if (numbers.empty()) return {};
  const unsigned cores =
      settings.threads != 0 ? settings.threads : std::max(1u, std::thread::hardware_concurrency());
  const auto threads = static_cast<unsigned>(std::min<std::size_t>(cores, numbers.size()));
  Study study(scene, variables, settings, numbers, options);
  std::vector<std::jthread> pool;
  for (unsigned i = 0; i < threads; ++i) pool.emplace_back([&study] { study.work(); });
  try {
    study.wait(threads);
  } catch (...) {
    study.stop();
    throw;  // the threads end first
  }
  pool.clear();
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

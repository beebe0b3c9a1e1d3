// SPDX-License-Identifier: BSD-3-Clause
// Many runs of one procedure with parts that deviate within their tolerances: the yield, and the tolerances
// that reduce it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

enum class StudyQuantity { Size, X, Y, Z, AboutX, AboutY, AboutZ, Friction };

/// One quantity that varies from run to run.
struct StudyVariable {
  std::string name;  ///< "peg size"
  std::size_t part = 0;
  StudyQuantity quantity = StudyQuantity::Size;
  bool is_hole = false;  ///< for a size: a larger value means less material
  Distribution distribution = Distribution::Normal;
  /// Limits of the deviation from the drawn value [m, rad, or 1]; a normal deviation passes each limit once
  /// in 740 runs.
  double lower = 0, upper = 0;

  [[nodiscard]] double middle() const { return 0.5 * (lower + upper); }
};

struct StudySettings {
  std::uint64_t seed = 1;
  /// False: exact distances alone judge a run, without the virtual hand; the run fits if no overlap and no
  /// fit rules out that the parts fit.
  bool has_contact = true;
  unsigned threads = 0;  ///< number of runs at the same time, each on one core; 0: as many as there are cores
};

/// Result of one run, which depends only on the scene, the seed and the run number.
struct StudyRun {
  std::size_t run = 0;
  Verdict verdict = Verdict::NotShown;
  std::string part, reason;  ///< part and reason of the first step that does not fit; empty: all steps fit
  double simulated_s = 0;
  std::vector<double> values;  ///< deviation of each variable
};

/// Effect of one variable on the yield.
struct StudyEffect {
  StudyVariable variable;
  std::size_t index = 0;  ///< index into StudyRun::values
  /// Yield if this tolerance is halved, estimated from the same runs, each weighted by the ratio of the two
  /// densities.
  double yield_if_halved = 0;
  double gain = 0;        ///< yield_if_halved minus yield
  double gain_error = 0;  ///< half width of the 95 % interval of the gain
};

struct StudyResult {
  std::string scene;
  StudySettings settings;
  std::size_t good = 0, blocked = 0;
  double yield = 0, yield_low = 0, yield_high = 0;  ///< yield with Wilson's 95 % interval
  std::vector<StudyEffect> effects;                 ///< sorted by gain, the greatest gain first
  std::vector<StudyRun> runs;                       ///< in order of run numbers
  /// Fits if at least one run fits, Blocked if all runs are blocked, else NotShown.
  [[nodiscard]] VPS_SCENES_API Verdict verdict() const;
};

struct StudyOptions : ModelOptions {
  const std::atomic<bool>* stop = nullptr;  ///< set by the caller to end early; unfinished runs are dropped
  /// Called with each run when the run ends, by one thread at a time.
  std::function<void(const StudyRun&)> on_run;
};

/// Variables for all tolerances of the scene's parts, with sizes relative to drawn sizes. Throws LoadError
/// for a scene without a tolerance, for an unknown class of ISO 286, and for a class on a part without a fit.
VPS_SCENES_API std::vector<StudyVariable> studyVariables(const Scene& scene);

/// The deviations of one run. A counter-based generator computes each deviation from the seed, the run number
/// and the variable's name, so that no deviation depends on other runs and variables.
VPS_SCENES_API std::vector<double> sampleStudy(const std::vector<StudyVariable>& variables,
                                               std::uint64_t seed, std::size_t run);

/// The scene of the given run: with offset faces for deviations of size, displaced placements, changed
/// friction, and a seed for the virtual hand.
VPS_SCENES_API Scene sampledScene(const Scene& scene, const std::vector<StudyVariable>& variables,
                                  std::uint64_t seed, std::size_t run);

/// Makes the runs with the given numbers, and returns the finished ones in order of their numbers. Throws as
/// assemble().
VPS_SCENES_API std::vector<StudyRun> runStudy(const Scene& scene, const std::vector<StudyVariable>& variables,
                                              const StudySettings& settings,
                                              const std::vector<std::size_t>& numbers,
                                              const StudyOptions& options = {});

/// Computes yield and effects of the runs, which may come in any order. If two runs have the same number,
/// only the first of them counts.
VPS_SCENES_API StudyResult sumUpStudy(const std::string& scene, const std::vector<StudyVariable>& variables,
                                      const StudySettings& settings, std::vector<StudyRun> runs);

/// Identifies a study: equal fingerprints mean that runs of the same number are equal. The fingerprint is
/// made of scene, tolerances, seed and `has_contact`.
VPS_SCENES_API std::string studyFingerprint(const Scene& scene, const std::vector<StudyVariable>& variables,
                                            const StudySettings& settings);

}  // namespace vps::scenes

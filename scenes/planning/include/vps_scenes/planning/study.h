// SPDX-License-Identifier: BSD-3-Clause
// Many runs of one procedure with parts that are off within their tolerances: yield and what costs it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/verdict.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

enum class StudyQuantity { Size, X, Y, Z, AboutX, AboutY, AboutZ, Friction };

/// One number that differs from run to run.
struct StudyVariable {
  std::string name;  ///< "peg size"
  std::size_t part = 0;
  StudyQuantity quantity = StudyQuantity::Size;
  bool is_hole = false;  ///< of a size: a greater one has less material
  Distribution distribution = Distribution::Normal;
  /// Limits of the deviation from what is drawn [m, rad, or 1]; a normal one passes each once in 740 runs.
  double lower = 0, upper = 0;

  [[nodiscard]] double middle() const { return 0.5 * (lower + upper); }
};

struct StudySettings {
  std::uint64_t seed = 1;
  /// False: a run is judged by exact distances alone, without the hand: it fits if no overlap and no fit
  /// rules it out.
  bool has_contact = true;
  unsigned threads = 0;  ///< runs at the same time, each on one core; 0: one for each core
};

/// One run. It depends on scene, seed and its number alone.
struct StudyRun {
  std::size_t run = 0;
  Verdict verdict = Verdict::NotShown;
  std::string part, reason;  ///< of the first step that does not fit; empty: all fit
  double simulated_s = 0;
  std::vector<double> values;  ///< of each variable
};

/// What one variable does to the yield.
struct StudyEffect {
  StudyVariable variable;
  std::size_t index = 0;  ///< of StudyRun::values
  /// The yield with half of this tolerance, estimated from the same runs by weighting each with the ratio of
  /// the two densities.
  double yield_if_halved = 0;
  double gain = 0;        ///< yield_if_halved less yield
  double gain_error = 0;  ///< half of its interval of 95 %
};

struct StudyResult {
  std::string scene;
  StudySettings settings;
  std::size_t good = 0, blocked = 0;
  double yield = 0, yield_low = 0, yield_high = 0;  ///< with Wilson's interval of 95 %
  std::vector<StudyEffect> effects;                 ///< the greatest gain first
  std::vector<StudyRun> runs;                       ///< in order of their numbers
};

struct StudyOptions : ModelOptions {
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early; runs that were begun are dropped
  /// Called with each run as it ends, by one thread at a time.
  std::function<void(const StudyRun&)> on_run;
};

/// What the tolerances of the scene's parts ask for, with sizes relative to the drawn ones. Throws LoadError
/// for a scene without a tolerance, and for a class of ISO 286 that is not known or of a part without a fit.
VPS_SCENES_API std::vector<StudyVariable> studyVariables(const Scene& scene);

/// The deviations of one run. A counter-based generator makes each from the seed, the run's number and the
/// variable's name, so that no other run and no other variable changes it.
VPS_SCENES_API std::vector<double> sampleStudy(const std::vector<StudyVariable>& variables,
                                               std::uint64_t seed, std::size_t run);

/// The scene of that run: sizes by offset faces, places displaced, friction, and a seed for the hand.
VPS_SCENES_API Scene sampledScene(const Scene& scene, const std::vector<StudyVariable>& variables,
                                  std::uint64_t seed, std::size_t run);

/// Makes the runs of the given numbers, and returns those that ended, in order of their numbers. Throws as
/// assemble().
VPS_SCENES_API std::vector<StudyRun> runStudy(const Scene& scene, const std::vector<StudyVariable>& variables,
                                              const StudySettings& settings,
                                              const std::vector<std::size_t>& numbers,
                                              const StudyOptions& options = {});

/// Sums up. Runs may come in any order; of two with one number the first counts.
VPS_SCENES_API StudyResult sumUpStudy(const std::string& scene, const std::vector<StudyVariable>& variables,
                                      const StudySettings& settings, std::vector<StudyRun> runs);

/// Equal only for studies whose runs of one number are the same: of scene, tolerances, seed and judgement.
VPS_SCENES_API std::string studyFingerprint(const Scene& scene, const std::vector<StudyVariable>& variables,
                                            const StudySettings& settings);

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The yield of a study, its interval, and the effect of each tolerance on the yield.
#include <algorithm>
#include <cmath>

#include "vps_scenes/planning/study.h"

namespace vps::scenes {

namespace {

constexpr double kZ =
    1.959963984540054;  // 95 % of a normal distribution lie within this many standard deviations

/// Sets the interval of the yield. Source: [Wilson 1927].
void addInterval(StudyResult& result, double count) {
  if (count == 0) {
    result.yield_high = 1;
    return;
  }
  const double p = result.yield, z2 = kZ * kZ, scale = 1 / (1 + z2 / count);
  const double middle = scale * (p + z2 / (2 * count));
  const double half = scale * kZ * std::sqrt(p * (1 - p) / count + z2 / (4 * count * count));
  result.yield_low = std::max(0.0, middle - half);
  result.yield_high = std::min(1.0, middle + half);
}

/// Ratio of the probability density with half of the tolerance to the density with the whole tolerance.
double weightIfHalved(const StudyVariable& variable, double value) {
  const double of_half = (value - variable.middle()) / (0.5 * (variable.upper - variable.lower));
  if (variable.distribution == Distribution::Uniform) return std::abs(of_half) <= 0.5 ? 2 : 0;
  const double z = 3 * of_half;  // the limits are three standard deviations from the middle
  return 2 * std::exp(-1.5 * z * z);
}

StudyEffect effectOf(const StudyVariable& variable, std::size_t index, const StudyResult& result) {
  StudyEffect effect{variable, index, result.yield, 0, 0};
  double weights = 0, good = 0;
  for (const StudyRun& run : result.runs) {
    const double weight = weightIfHalved(variable, run.values[index]);
    weights += weight;
    good += isGood(run.verdict) ? weight : 0;
  }
  if (weights == 0) return effect;
  const auto count = static_cast<double>(result.runs.size());
  effect.yield_if_halved = good / weights;
  effect.gain = effect.yield_if_halved - result.yield;
  // The variance is that of the delta method, since both yields are computed from the same runs.
  double squares = 0;
  for (const StudyRun& run : result.runs) {
    const double passed = isGood(run.verdict) ? 1 : 0;
    const double weight = weightIfHalved(variable, run.values[index]) * count / weights;
    const double off = weight * (passed - effect.yield_if_halved) - (passed - result.yield);
    squares += off * off;
  }
  effect.gain_error = kZ * std::sqrt(squares) / count;
  return effect;
}

}  // namespace

Verdict StudyResult::verdict() const {
  if (good > 0) return Verdict::Fits;
  return !runs.empty() && blocked == runs.size() ? Verdict::Blocked : Verdict::NotShown;
}

StudyResult sumUpStudy(const std::string& scene, const std::vector<StudyVariable>& variables,
                       const StudySettings& settings, std::vector<StudyRun> runs) {
  StudyResult result;
  result.scene = scene;
  result.settings = settings;
  std::ranges::stable_sort(runs, {}, &StudyRun::run);
  const auto again = std::ranges::unique(runs, {}, &StudyRun::run);
  runs.erase(again.begin(), again.end());
  result.runs = std::move(runs);
  for (const StudyRun& run : result.runs) {
    result.good += isGood(run.verdict);
    result.blocked += run.verdict == Verdict::Blocked;
  }
  const auto count = static_cast<double>(result.runs.size());
  if (count > 0) result.yield = static_cast<double>(result.good) / count;
  addInterval(result, count);
  for (std::size_t i = 0; i < variables.size(); ++i)
    result.effects.push_back(effectOf(variables[i], i, result));
  std::ranges::stable_sort(result.effects, std::ranges::greater{}, &StudyEffect::gain);
  return result;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/planning/margin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "procedure/assembly_run.h"
#include "scene/steps.h"
#include "study/variants.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/run/assemble.h"
#include "world/drawn_targets.h"

namespace vps::scenes {

namespace {

constexpr double kMostGrowth =
    0.05;  // greatest offset relative to the least extent: offsets must stay far below the size of facets
constexpr double kLift = 0.01;   // height relative to the part's diagonal that lifts the part off its seat,
                                 // which would stop every tilt
constexpr double kAcross = 0.5;  // |cos| below which an axis counts as across the path

/// The greatest offset that passes and the least offset that fails, by one criterion.
struct Bracket {
  double passes_m = 0;
  std::optional<double> fails_m;
  Judgement failure;
};

/// Halves the bracket until it is as narrow as the resolution.
template <class Try>
void narrow(Bracket& bracket, double resolution_m, Try attempt) {
  while (bracket.fails_m && *bracket.fails_m - bracket.passes_m > resolution_m) {
    const double middle_m = 0.5 * (bracket.passes_m + *bracket.fails_m);
    Judgement probe = attempt(middle_m);
    if (isGood(probe.verdict)) {
      bracket.passes_m = middle_m;
    } else {
      bracket.fails_m = middle_m;
      bracket.failure = std::move(probe);
    }
  }
}

/// Measures the margins of the only step of a scene.
class StepProbe {
 public:
  StepProbe(Scene scene, const MarginOptions& options)
      : scene_(std::move(scene)), fit_(scene_), options_(options) {}

  StepMargin measure() {
    StepMargin out;
    out.part = scene_.parts[scene_.steps[0].part].part.name;
    // The part has the tolerance of its drawn size at all sizes.
    if (scene_.steps[0].tolerance_m <= 0) scene_.steps[0].tolerance_m = drawnTolerances_m(scene_)[0];
    measureGrowth(out);
    measurePlay(out);
    out.checks = checks_;
    out.runs = runs_;
    return out;
  }

 private:
  [[nodiscard]] bool isStopped() const { return options_.stop != nullptr && *options_.stop; }

  Judgement byGeometry(double by_m) {
    ++checks_;
    DrawnMisfit misfit = fit_.findMisfit(withGrownStep(scene_, 0, by_m));
    return {misfit.verdict, std::move(misfit.reason)};
  }

  Judgement byContact(double by_m) {
    ++runs_;
    Scene grown = withGrownStep(scene_, 0, by_m);
    AssembleOptions run;
    static_cast<ModelOptions&>(run) = options_;
    run.progress = {};
    run.stop = options_.stop;
    const AssembleResult result = assemble(grown, run);
    return {result.verdict, result.steps.empty() ? std::string() : result.steps[0].reason};
  }

  void tell(double share) const {
    if (options_.progress)
      options_.progress("margin of " + scene_.parts[scene_.steps[0].part].part.name, share);
  }

  /// Doubles the offset until geometry rules it out.
  Bracket boundByGeometry() {
    const double most_m =
        kMostGrowth * bounds(scene_.parts[scene_.steps[0].part].part.mesh).size().minCoeff();
    Bracket bracket;
    for (double by_m = 8 * options_.resolution_m;; by_m *= 2) {
      by_m = std::min(by_m, most_m);
      Judgement probe = byGeometry(by_m);
      if (!isGood(probe.verdict)) {
        bracket.fails_m = by_m;
        bracket.failure = std::move(probe);
        break;
      }
      bracket.passes_m = by_m;
      if (by_m >= most_m) break;
    }
    narrow(bracket, options_.resolution_m, [&](double by_m) { return byGeometry(by_m); });
    return bracket;
  }

  /// The greatest offset, within the geometric bound, with which the virtual hand completes the step.
  Bracket shownByContact(const Bracket& bound) {
    Bracket shown = bound;
    Judgement at_bound = byContact(bound.passes_m);
    if (isGood(at_bound.verdict)) return shown;
    shown.passes_m = 0;
    shown.fails_m = bound.passes_m;
    shown.failure = std::move(at_bound);
    const double width_m = bound.passes_m;
    narrow(shown, options_.resolution_m, [&](double by_m) {
      tell(0.5 + 0.5 * (1 - (*shown.fails_m - shown.passes_m) / width_m));
      return isStopped() ? judge({.is_in_place = false, .failure = "stopped"}) : byContact(by_m);
    });
    return shown;
  }

  void measureGrowth(StepMargin& out) {
    tell(0);
    Judgement drawn = byGeometry(0);
    if (isGood(drawn.verdict) && options_.has_contact) drawn = byContact(0);
    out.goes = isGood(drawn.verdict);
    if (!out.goes) {
      out.fails_as = drawn.verdict;
      out.fails_why = drawn.reason;
      out.growth_fails_m = 0;
      return;
    }
    tell(0.25);
    Bracket bracket = boundByGeometry();
    out.growth_bound_m = bracket.passes_m;
    tell(0.5);
    if (options_.has_contact && bracket.passes_m > 0) bracket = shownByContact(bracket);
    out.growth_m = bracket.passes_m;
    out.growth_fails_m = bracket.fails_m;
    out.fails_as = bracket.fails_m ? bracket.failure.verdict : Verdict::Fits;
    out.fails_why = bracket.failure.reason;
  }

  /// Measures the play with the part lifted off its seat by a hundredth of its size, since a part that stands
  /// on a face cannot be tilted.
  void measurePlay(StepMargin& out) {
    Scene lifted = scene_;
    SceneStep& step = lifted.steps[0];
    const Vec3 axis_W = insertionAxis(step, Pose());
    step.X_WP_target.p -= kLift * bounds(lifted.parts[step.part].part.mesh).size().norm() * axis_W;
    CheckSettings settings;
    settings.has_fits = false;
    settings.only_parts = {out.part};
    const CheckResult checked = fit_.check(lifted, settings);
    ++checks_;
    const auto part =
        std::ranges::find_if(checked.parts, [&](const CheckedPart& p) { return p.name == out.part; });
    if (part == checked.parts.end() || !part->play) return;
    out.position_error_m = part->play_error_m;
    out.angle_error_rad = part->play_error_rad;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vec3 along_W = part->play_axes_W.col(static_cast<Eigen::Index>(i / 2));
      if (std::abs(along_W.dot(axis_W)) >= kAcross) continue;
      const double m = part->play->m[i], rad = part->play->rad[i];
      if (std::isfinite(m) && m < out.position_m.value_or(std::numeric_limits<double>::infinity())) {
        out.position_m = m;
        out.position_W = i % 2 == 0 ? along_W : Vec3(-along_W);
      }
      if (std::isfinite(rad) && rad < out.angle_rad.value_or(std::numeric_limits<double>::infinity()))
        out.angle_rad = rad;
    }
  }

  Scene scene_;
  DrawnFit fit_;
  const MarginOptions& options_;
  std::size_t checks_ = 0, runs_ = 0;
};

}  // namespace

Verdict MarginResult::verdict() const {
  Verdict worst = steps.empty() ? Verdict::NotShown : Verdict::Fits;
  for (const StepMargin& step : steps)
    if (!step.goes) worst = worse(worst, step.fails_as);
  return worst;
}

MarginResult measureMargins(const Scene& scene, const MarginOptions& options) {
  requireSteps(scene);
  if (!(options.resolution_m > 0) || !std::isfinite(options.resolution_m))
    throw LoadError(scene.file, "", "margins need a resolution of more than 0");
  MarginResult result{scene.name, options.resolution_m, options.has_contact, {}};
  StoppableWork work(options.progress, "margins");
  for (std::size_t i = 0; i < scene.steps.size(); ++i) {
    if (options.stop != nullptr && *options.stop) break;
    MarginOptions one = options;
    if (options.progress)
      one.progress = [&, i](std::string_view doing, double share) {
        work.report(doing, (static_cast<double>(i) + share) / static_cast<double>(scene.steps.size()));
      };
    StepMargin margin = StepProbe(excerptOf(scene, i), one).measure();
    margin.step = i;
    result.steps.push_back(std::move(margin));
  }
  std::ranges::stable_sort(result.steps, [](const StepMargin& a, const StepMargin& b) {
    return std::pair(a.goes, a.growth_m) < std::pair(b.goes, b.growth_m);
  });
  return result;
}

}  // namespace vps::scenes

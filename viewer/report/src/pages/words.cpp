// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "files/html.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::viewer {
namespace {

/// "'a', 'b'": the parts whose steps have a verdict.
std::string partsWith(const scenes::AssembleResult& result, scenes::Verdict verdict) {
  std::string names;
  for (const scenes::StepResult& step : result.steps)
    if (step.verdict == verdict) names.append(names.empty() ? "'" : ", '").append(step.part).append("'");
  return names;
}

}  // namespace

std::string directionWords(const Vec3& d) {
  constexpr double kAlong = 0.9995;  // within two degrees
  constexpr std::array kAxes = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    if (std::abs(d[i]) > kAlong) return std::string(d[i] > 0 ? "+" : "-") + kAxes[std::size_t(i)];
  const auto rounded = [](double x) {
    constexpr double kZero = 0.005;
    return html::format(std::abs(x) < kZero ? 0 : x, "%.2f");
  };
  return "(" + rounded(d.x()) + ", " + rounded(d.y()) + ", " + rounded(d.z()) + ")";
}

std::string withoutPathWords(const scenes::BlockedPart& part, const std::string& not_found) {
  if (!part.enclosed_by.empty())
    return " cannot be taken off '" + part.enclosed_by + "' on any path, which is proven for rigid parts";
  std::string out = not_found;
  if (!part.by.empty()) out += "; in straight directions it is stopped by " + listedNames(part.by);
  if (!part.is_searched) out += "; the search for paths of several legs ended at its limit";
  return out;
}

std::string listedNames(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 8;
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    out += (i > 0 ? ", '" : "'") + names[i] + "'";
  if (names.size() > kShown) out += " and " + std::to_string(names.size() - kShown) + " more";
  return out;
}

std::array<std::string, 2> toldApart(double a_m, double b_m) {
  std::array<std::string, 2> out;
  for (const char* form : {"%.3f", "%.4f", "%.5f", "%.6f"}) {
    out = {html::format(1e3 * a_m, form), html::format(1e3 * b_m, form)};
    if (out[0] != out[1]) break;
  }
  return out;
}

const char* words(scenes::Verdict verdict) {
  return scenes::rowOf(verdict).words;
}

std::string movedWords(const scenes::StepResult& step) {
  return "parts overlap here as drawn, so the part was brought to a place without overlap, " +
         html::format(1e3 * step.moved_m, "%.4f mm") + " from the drawn one";
}

std::string contactWords(const scenes::StepResult& step) {
  if (!step.completed)
    return step.is_taken_off ? "no: the part did not come off" : "no: the part did not reach its target";
  if (step.by_contact) return "yes";
  if (step.is_taken_off) return "no: no other part guided this part on its path";
  return "no: no other part guided this part; the hand placed it by sight alone, so only the tolerance tells "
         "where it is";
}

std::string putAtTargetWords(const scenes::AssembleResult& result) {
  const auto depends = [](const scenes::StepResult& step) { return !step.stands_on.empty(); };
  const auto steps = static_cast<std::size_t>(std::ranges::count_if(result.steps, depends));
  if (steps == 0) return {};
  std::vector<std::string> put;
  const auto add = [&](const std::string& part) {
    if (!part.empty() && std::ranges::find(put, part) == put.end()) put.push_back(part);
  };
  for (std::size_t i = 0; i < result.steps.size(); ++i) {
    add(result.steps[i].stands_on);
    if (!result.steps[i].completed && i + 1 < result.steps.size()) add(result.steps[i].part);
  }
  return scenes::counted(steps, "step was", "steps were") + " tried with " + listedNames(put) +
         (put.size() == 1 ? " put at its target, which this part had not reached"
                          : ", each put at its target, which it had not reached");
}

std::string easeWords(const scenes::AssembleResult& result) {
  if (result.tries.empty()) return {};
  const auto good = std::count_if(result.tries.begin(), result.tries.end(), [](const scenes::TryResult& one) {
    return one.verdict == scenes::Verdict::Fits;
  });
  return std::string("Ease of assembly: ")
      .append(std::to_string(good))
      .append(" of ")
      .append(scenes::counted(result.tries.size(), "try", "tries"))
      .append(isDisassembly(result) ? " took every part off." : " brought every part home.");
}

bool isDisassembly(const scenes::AssembleResult& result) {
  return std::any_of(result.steps.begin(), result.steps.end(),
                     [](const scenes::StepResult& step) { return step.is_taken_off; });
}

std::string verdictLine(const scenes::AssembleResult& result) {
  const bool is_apart = isDisassembly(result);
  const auto fit = std::count_if(result.steps.begin(), result.steps.end(),
                                 [](const scenes::StepResult& s) { return scenes::isGood(s); });
  const std::string count = std::to_string(fit)
                                .append(" of ")
                                .append(scenes::counted(result.steps.size(), is_apart ? "part" : "step"))
                                .append(is_apart ? " come" : " fit")
                                .append(result.steps.size() != 1 ? "" : "s")
                                .append(is_apart ? " off." : ".");
  switch (result.verdict) {
    case scenes::Verdict::Fits:
      return (is_apart ? "Yes, the parts come apart: " : "Yes, the parts go together: ") + count;
    case scenes::Verdict::Blocked:
      return (is_apart ? "No, the parts do not come apart: blocked at "
                       : "No, the parts do not go together: blocked at ") +
             partsWith(result, scenes::Verdict::Blocked) + "; " + count;
    case scenes::Verdict::NotShown:
      break;
  }
  const std::string parts = partsWith(result, scenes::Verdict::NotShown);
  const bool is_home = std::all_of(result.steps.begin(), result.steps.end(),
                                   [](const scenes::StepResult& s) { return s.completed; });
  if (is_home && !parts.empty() && !is_apart)
    return "Not shown: " + parts + " was brought home, but that does not show that it fits; " + count;
  return "Not shown: " + (parts.empty() ? std::string("the run ended before its last step") : parts) +
         (is_apart ? " was not taken off" : " was not brought home") +
         ", and nothing proves that this is impossible; " + count;
}

namespace {

/// "'bolt' moves by 0.050 mm along +x and turns by 0.010 degrees about (1.00, 0.00, 0.00)"
std::string motionWords(const scenes::MovedPart& part) {
  constexpr double kNone =
      0.01;  // a translation or rotation below this share of the whole motion is not mentioned
  const double by_m = part.by_W.norm(), turn_rad = part.turn_W.norm();
  std::string out = "'" + part.name + "'";
  const bool is_moved = by_m > kNone * part.most_m;
  if (is_moved)
    out += " moves by " + html::format(1e3 * by_m, "%.4f") + " mm along " + directionWords(part.by_W / by_m);
  // The farthest corner moves farther than by_m only if the part rotates.
  if (part.most_m - by_m <= kNone * part.most_m) return out;
  return out + (is_moved ? " and" : "") + " turns by " +
         html::format(turn_rad * 180 / std::numbers::pi, "%.4f") + " degrees about " +
         directionWords(part.turn_W / turn_rad);
}

std::string aloneWords(const std::vector<std::string>& alone) {
  const bool is_one = alone.size() == 1;
  return "'" + alone.front() + "'" +
         (is_one ? " is"
                 : " and " + std::to_string(alone.size() - 1) +
                       (alone.size() == 2 ? " other are" : " others are")) +
         " nowhere near another part, so that nothing shows whether " + (is_one ? "it fits" : "they fit");
}

std::string uncertainWords(const scenes::CheckResult& result) {
  const scenes::CheckedPair& first =
      *std::ranges::find(result.pairs, true, &scenes::CheckedPair::is_uncertain);
  std::string why;
  for (const scenes::CheckedPart& part : result.parts)
    if (why.empty() && (part.name == first.a || part.name == first.b) && !part.no_inside.empty())
      why = "because of " + part.name + ": " + part.no_inside;
  const std::size_t others = result.uncertain() - 1;
  return "it cannot be told whether " + first.a + " and " + first.b + " overlap, " + why +
         (others == 0
              ? ""
              : "; " + scenes::counted(others, "other pair is", "other pairs are") + " uncertain, too");
}

/// "free if 'bolt' moves by 0.050 mm along +x", the part that moves farthest first; empty: nothing is moved.
std::string freeWords(std::vector<scenes::MovedPart> moved) {
  constexpr std::size_t kMost = 4;
  if (moved.empty()) return {};
  std::ranges::stable_sort(moved, std::greater(), &scenes::MovedPart::most_m);
  std::string out = "free if ";
  for (std::size_t i = 0; i < std::min(moved.size(), kMost); ++i)
    out += (i == 0 ? "" : i + 1 == moved.size() ? " and " : ", ") + motionWords(moved[i]);
  return moved.size() > kMost
             ? out + " and " + scenes::counted(moved.size() - kMost, "more part moves", "more parts move")
             : out;
}

}  // namespace

std::string assemblyWords(const scenes::CheckResult& result) {
  switch (result.places.verdict) {
    case scenes::Verdict::Blocked:
      return "cannot be assembled with its parts where they are drawn, or within 0.5 mm of there (other "
             "places were not examined): " +
             result.places.reason;
    case scenes::Verdict::NotShown:
      return "whether the parts can be assembled is not shown: " + result.places.reason;
    case scenes::Verdict::Fits:
      break;
  }
  const std::string freed = freeWords(result.places.moved);
  std::string doubt;
  if (result.isAllIgnored())
    doubt = "all pairs of parts near each other were left out";
  else if (result.uncertain() > 0)
    doubt = uncertainWords(result);
  else if (!result.alone.empty())
    doubt = aloneWords(result.alone);
  if (!doubt.empty())
    return "not shown: " + doubt + (freed.empty() ? "" : "; the overlapping parts are " + freed);
  if (freed.empty()) return freed;
  return std::string("can be assembled") +
         (result.isAboutChosenPairs() ? ", as far as the chosen pairs show: " : ": ") + freed;
}

std::string playWords(double way, double error, double usual, double scale, const char* form) {
  if (std::isinf(way)) return "free";
  const std::string words = html::format(scale * way, form);
  if (std::isinf(error)) return ">= " + words;
  return error > 2 * usual ? words + " (+- " + html::format(scale * error, form) + ")" : words;
}

std::string playDoubt(const scenes::CheckedPart& part, const scenes::CheckResult& result) {
  if (!part.play || part.is_play_certain) return {};
  constexpr double kEqual_m = 0.1e-6;  // sizes within this difference count as equal, as in the check
  const bool has_equal = std::ranges::any_of(result.fits, [&](const scenes::CheckedFit& fit) {
    return fit.kind == scenes::FitKind::Shaft && (fit.shaft == part.name || fit.bore == part.name) &&
           std::abs(fit.diametral_clearance_m) <= fit.error_m + kEqual_m;
  });
  return std::string(has_equal ? "round faces of equal size touch" : "facets cross others as drawn")
      .append("; the part's play is uncertain by ")
      .append(html::format(1e6 * part.play_error_m, "%.1f"))
      .append(" um and ")
      .append(html::format(1e3 * part.play_error_rad, "%.2g"))
      .append(" mrad, and larger where facets of the meshes block motions that the true faces allow");
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/verdict_words.h"

#include <algorithm>

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

const char* words(scenes::Verdict verdict) {
  switch (verdict) {
    case scenes::Verdict::Fits:
      return "fits";
    case scenes::Verdict::Blocked:
      return "blocked";
    case scenes::Verdict::NotShown:
      break;
  }
  return "not shown";
}

std::string contactWords(const scenes::StepResult& step) {
  if (!step.completed)
    return step.is_taken_off ? "no: it did not come off" : "no: it did not reach its target";
  if (step.by_contact) return "yes";
  if (step.is_taken_off) return "no: nothing beside its path guided it";
  return "no: nothing beside its path guided it; the hand placed it by sight alone, so that nothing but the "
         "tolerance says where it is";
}

std::string easeWords(const scenes::AssembleResult& result) {
  if (result.tries.empty()) return {};
  const auto good = std::count_if(result.tries.begin(), result.tries.end(), [](const scenes::TryResult& one) {
    return one.verdict == scenes::Verdict::Fits;
  });
  return std::string("Ease of assembly: ")
      .append(std::to_string(good))
      .append(" of ")
      .append(std::to_string(result.tries.size()))
      .append(result.tries.size() == 1 ? " try" : " tries")
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
                                .append(std::to_string(result.steps.size()))
                                .append(is_apart ? " parts come off." : " steps fit.");
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
         ", and nothing proves that it cannot be; " + count;
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "families/family.h"

#include <cmath>
#include <ctime>

namespace vps::families {

std::vector<Family> allFamilies() {
  std::vector<Family> all;
  for (const auto make : {materialFamilies, restitutionFamilies, narrowGapFamilies, nutGapFamilies,
                          rotationFamilies, shellFamilies, resolutionFamilies, roundBodyFamilies,
                          rollingFamilies, flushStartFamilies, openSurfaceFamilies, spinningFaceFamilies,
                          penaltyFallFamilies, loadedThreadFamilies, mechanismFamilies, judgeFamilies})
    for (Family& family : make()) all.push_back(std::move(family));
  return all;
}

const char* nameOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::Holds:
      return "holds";
    case Verdict::ExpectedFailure:
      return "expected failure";
    case Verdict::Fails:
      return "FAILS";
    case Verdict::Worse:
      return "WORSE than the expected failure";
    case Verdict::HoldsUnexpectedly:
      return "HOLDS: remove its expected failure";
  }
  return "";
}

Outcome measure(const Family& family, bool is_short, int member) {
  Outcome outcome;
  const std::clock_t begun = std::clock();
  const int first = member >= 0 ? member : 0;
  const int last = member >= 0 ? member : family.members - 1;
  for (int i = first; i <= last; i += is_short ? family.every : 1) {
    double value = family.measured(i);
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
    ++outcome.run;
    if (value > family.bar) ++outcome.above, outcome.members_above.push_back(i);
    if (value > outcome.worst) {
      outcome.worst = value;
      outcome.worst_member = i;
    }
  }
  outcome.cpu_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  return outcome;
}

Verdict judge(const Family& family, const Outcome& outcome, bool is_short) {
  // A program gives the same bits in each run on one machine. Another processor may round differently, and
  // long runs amplify the difference, so a value counts as worse only if it is more than a twentieth above
  // today's value.
  constexpr double kSame = 1.05;
  const std::optional<double>& today =
      is_short && family.expected_failure_short ? family.expected_failure_short : family.expected_failure;
  if (!today || *today == 0) return outcome.worst <= family.bar ? Verdict::Holds : Verdict::Fails;
  if (outcome.worst <= family.bar) return Verdict::HoldsUnexpectedly;
  return outcome.worst <= kSame * *today ? Verdict::ExpectedFailure : Verdict::Worse;
}

}  // namespace vps::families

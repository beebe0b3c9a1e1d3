// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/verdict.h"

#include <algorithm>
#include <cstdio>

#include "text/words.h"

namespace vps::scenes {

namespace {

std::string depthReason(const Evidence& e) {
  return "on its path the part was " + lengthInWords(e.depth_m) + " deep inside '" + e.deepest_against +
         "', more than the " + lengthInWords(e.depth_limit_m) + " that count as contact";
}

std::string driftReason(const Evidence& e) {
  return "the part moved by " + lengthInWords(e.rest_drift_m) + " after its release: " + kHoldsRemedy;
}

std::string pressReason(const Evidence& e) {
  char words[240];
  std::snprintf(
      words, sizeof words,
      "the path is free, but pressing the part %s takes about %.0f N (by the formula for its declared "
      "interference), and the hand has %.0f N ([operator] force_limit_N); use a press",
      e.is_taken_off ? "out" : "in", e.press_needed_N, e.hand_N);
  return words;
}

struct Rule {
  bool (*isMet)(const Evidence&);
  Verdict verdict;
  std::string (*reason)(const Evidence&);
};

/// The rules in order of precedence; only a proof by geometry gives the verdict Blocked, and such a proof
/// needs no run.
constexpr std::array kRules{
    Rule{[](const Evidence& e) { return !e.blocked.empty(); }, Verdict::Blocked,
         [](const Evidence& e) { return e.blocked; }},
    Rule{[](const Evidence& e) { return !e.is_in_place; }, Verdict::NotShown,
         [](const Evidence& e) { return e.failure; }},
    Rule{[](const Evidence& e) { return !e.isWithinLimit(); }, Verdict::NotShown, depthReason},
    Rule{[](const Evidence& e) { return !e.isAtRest(); }, Verdict::NotShown, driftReason},
    Rule{[](const Evidence& e) { return e.press_needed_N > e.hand_N; }, Verdict::NotShown, pressReason},
    Rule{[](const Evidence& e) { return !e.doubt.empty(); }, Verdict::NotShown,
         [](const Evidence& e) { return "the hand brought the part to its target, but " + e.doubt; }},
};

}  // namespace

Judgement judge(const Evidence& evidence) {
  const auto* const rule = std::ranges::find_if(kRules, [&](const Rule& one) { return one.isMet(evidence); });
  if (rule == kRules.end()) return {};
  return {rule->verdict, rule->reason(evidence)};
}

Judgement judgeOverlap(const CheckedPlaces& places, const std::string& part) {
  if (places.verdict == Verdict::Fits) return {};
  const auto proven = std::ranges::find_if(places.groups, [&](const CheckedGroup& group) {
    return group.verdict == Verdict::Blocked && std::ranges::find(group.parts, part) != group.parts.end();
  });
  if (proven != places.groups.end()) return {Verdict::Blocked, proven->reason};
  return {Verdict::NotShown, places.reason};
}

std::string overlapReason(const std::string& other, double depth_m, double error_m, const Vec3& at_W) {
  return "as drawn, the part overlaps '" + other + "' by " + lengthInWords(depth_m) + " (error " +
         lengthInWords(error_m) + ") at " + placeInWords(at_W);
}

std::string closedRoomReason(const std::string& other, bool starts_inside) {
  return std::string(starts_inside ? "the part starts" : "the part's target is") + " in a cavity of '" +
         other + "' that has no opening";
}

}  // namespace vps::scenes

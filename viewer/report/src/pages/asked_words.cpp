// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/asked_words.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "files/html.h"
#include "vps_scenes/fits/rules.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {
namespace {

/// "1 pair", "3 pairs".
std::string pairCount(std::size_t count, const char* before = "") {
  return std::to_string(count) + before + (count == 1 ? " pair" : " pairs");
}

std::string oneMove(const scenes::PartMove& move) {
  std::string out = "'" + move.part + "' was ";
  if (move.by_m != 0 || move.turn_rad == 0)
    return out + "moved by " + html::format(1e3 * move.by_m, "%.4f") + " mm along " +
           directionWords(move.axis_W) + " before the check";
  return out + "turned by " + html::format(move.turn_rad * 180 / std::numbers::pi, "%.4f") +
         " degrees about " + directionWords(move.axis_W) + " through its origin before the check";
}

}  // namespace

std::string chosenWords(const scenes::CheckResult& result) {
  if (!result.isAboutChosenPairs()) return {};
  std::map<std::string, std::size_t> count_of;
  for (const scenes::LeftOutPair& pair : result.left_out) ++count_of[pair.reason];
  std::string out;
  for (const auto& [reason, count] : count_of)
    out += (out.empty() ? ": " : ", ") + pairCount(count) + " near each other " +
           (count == 1 ? "was" : "were") + " left out (" + reason + ")";
  return "this is about the chosen pairs only" +
         (out.empty() ? ", which are all pairs near each other" : out);
}

std::string moveWords(const scenes::CheckResult& result) {
  std::string out;
  for (const scenes::PartMove& move : result.moves) out += (out.empty() ? "" : "; ") + oneMove(move);
  return out;
}

std::string ruleWords(const scenes::CheckResult& result) {
  if (result.rule_counts.empty()) return {};
  scenes::RuleCount all;
  for (const scenes::RuleCount& count : result.rule_counts) {
    all.broken += count.broken;
    all.not_decided += count.not_decided;
    all.kept += count.kept + count.apart;
  }
  std::string out = "rules: " + std::to_string(all.broken) + " broken, " + std::to_string(all.not_decided) +
                    " not decided, " + std::to_string(all.kept) + " kept";
  if (result.rules.empty() || result.rules.front().state == scenes::RuleState::Kept) return out;
  const scenes::RuleOutcome& worst = result.rules.front();  // sorted: the broken ones first
  out += "; '" + worst.rule + "' is " + toText(worst.state);
  if (!worst.a.empty())
    out += (worst.state == scenes::RuleState::Broken ? " by " : " for ") + worst.a + " and " + worst.b;
  return out + ": " + scenes::inWords(worst);
}

std::vector<std::string> ruleNotes(const scenes::CheckResult& result) {
  std::vector<std::string> out;
  for (const scenes::RuleCount& count : result.rule_counts) {
    std::string note;
    if (count.apart > 0)
      note = pairCount(count.apart, count.kept + count.not_decided + count.broken > 0 ? " more" : "") +
             (count.apart == 1 ? " keeps it, since its parts are" : " keep it, since their parts are") +
             " farther apart than was measured";
    if (count.left_out > 0)
      note += (note.empty() ? "" : "; ") + pairCount(count.left_out) +
              (count.left_out == 1 ? " was" : " were") + " left out and not judged";
    if (note.empty() && count.kept + count.not_decided + count.broken == 0)
      note = "not judged, since its pairs were left out";
    if (!note.empty()) out.push_back("'" + count.rule + "': " + note);
  }
  return out;
}

std::string knownWords(const scenes::CheckResult& result) {
  constexpr std::array kStates{scenes::PairState::Thread, scenes::PairState::Seal, scenes::PairState::Insert};
  std::string out;
  std::size_t all = 0;
  for (const scenes::PairState state : kStates) {
    const auto count =
        static_cast<std::size_t>(std::ranges::count(result.pairs, state, &scenes::CheckedPair::state));
    if (count == 0) continue;
    all += count;
    out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + toText(state) + (count == 1 ? "" : "s");
  }
  if (all == 0) return {};
  return std::to_string(all) + (all == 1 ? " overlap is no clash: " : " overlaps are no clashes: ") + out +
         "; --strict-overlaps counts those that are not declared as clashes";
}

std::vector<std::string> knownNotes(const scenes::CheckResult& result) {
  std::vector<std::string> out;
  for (const scenes::CheckedPair& pair : result.pairs)
    if (!pair.explanation.empty()) out.push_back(pair.a + " and " + pair.b + ": " + pair.explanation);
  return out;
}

std::string noPlayWords(const scenes::CheckedPart& part, const scenes::CheckResult& result) {
  const bool is_left_out = std::ranges::any_of(result.left_out, [&](const scenes::LeftOutPair& pair) {
    return pair.a == part.name || pair.b == part.name;
  });
  return is_left_out ? "not measured" : "overlaps";
}

}  // namespace vps::viewer

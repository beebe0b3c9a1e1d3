// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "rules/pair_choice.h"
#include "vps/errors.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::scenes {

namespace {

/// Numbers that differ by less than the last digit of the reports are equal: a gap that is drawn as 0.3 mm
/// keeps the bound of 0.3 mm, although its coordinates are rounded.
constexpr double kEqual_m = 10e-9;

RuleState stateOf(double margin_m, double error_m) {
  if (margin_m - error_m >= -kEqual_m) return RuleState::Kept;
  return margin_m + error_m < -kEqual_m ? RuleState::Broken : RuleState::NotDecided;
}

RuleOutcome clearanceOutcome(const CheckRule& rule, const CheckedPair& pair) {
  RuleOutcome out{rule.name, pair.a, pair.b, RuleMeasure::Clearance};
  out.value_m = pair.interference_depth_m > 0 ? -pair.interference_depth_m : pair.clearance_m;
  out.error_m = pair.error_m;
  out.bound_m = *rule.min_clearance_m;
  out.state = stateOf(out.margin_m(), out.error_m);
  return out;
}

RuleOutcome overlapOutcome(const CheckRule& rule, const CheckedPair& pair) {
  RuleOutcome out{rule.name, pair.a, pair.b, RuleMeasure::Overlap};
  out.value_m = pair.interference_depth_m;
  out.error_m = pair.state == PairState::Apart ? 0 : pair.error_m;
  out.bound_m = *rule.max_overlap_m;
  out.state = stateOf(std::max(out.bound_m, kContactDepth_m) - out.value_m, out.error_m);
  return out;
}

RuleOutcome offsetOutcome(const CheckRule& rule, const CheckedFit& fit) {
  RuleOutcome out{rule.name, fit.shaft, fit.bore, RuleMeasure::AxisOffset};
  out.value_m = fit.offset_m;
  out.error_m = fit.error_m;
  out.bound_m = *rule.max_axis_offset_m;
  out.state = stateOf(out.margin_m(), out.error_m);
  return out;
}

/// The surfaces of an uncertain pair bound its clearance from above only: a part may be inside the other one.
void addDoubt(const CheckedPair& pair, RuleOutcome& out) {
  if (!pair.is_uncertain || out.state != RuleState::Kept) return;
  out.state = RuleState::NotDecided;
  out.reason = "one of the parts has a surface that encloses no volume";
}

/// Judges one rule after the other by the numbers of one check.
class Judge {
 public:
  explicit Judge(const CheckResult& result)
      : result_(result), names_(namesOf(result)), choice_(result.between, result.ignored, names_) {
    for (std::size_t i = 0; i < names_.size(); ++i) index_of_.emplace(names_[i].name, i);
  }

  void judge(const CheckRule& rule) {
    const MatchedPairs of = rule.between ? MatchedPairs(*rule.between, names_) : MatchedPairs::all(names_);
    const auto isOf = [&](const std::string& a, const std::string& b) {
      return of.has(index_of_.at(a), index_of_.at(b));
    };
    RuleCount count{.rule = rule.name};
    for (std::size_t i = 0; i < names_.size(); ++i)
      for (std::size_t k = i + 1; k < names_.size(); ++k) count.apart += of.has(i, k) && choice_.has(i, k);
    std::vector<RuleOutcome> found;
    for (const CheckedPair& pair : result_.pairs) {
      if (!isOf(pair.a, pair.b)) continue;
      --count.apart;
      if (rule.min_clearance_m) addDoubt(pair, found.emplace_back(clearanceOutcome(rule, pair)));
      if (rule.max_overlap_m) addDoubt(pair, found.emplace_back(overlapOutcome(rule, pair)));
    }
    for (const LeftOutPair& pair : result_.left_out) count.left_out += isOf(pair.a, pair.b);
    if (rule.max_axis_offset_m) addOffsets(rule, count, isOf, found);
    for (RuleOutcome& outcome : found) {
      ++(outcome.state == RuleState::Kept     ? count.kept
         : outcome.state == RuleState::Broken ? count.broken
                                              : count.not_decided);
      outcomes_.push_back(std::move(outcome));
    }
    counts_.push_back(std::move(count));
  }

  void giveTo(CheckResult& result) {
    result.rules.insert(result.rules.end(), outcomes_.begin(), outcomes_.end());
    std::ranges::stable_sort(result.rules, std::greater<>(), &RuleOutcome::state);
    result.rule_counts.insert(result.rule_counts.end(), counts_.begin(), counts_.end());
  }

 private:
  static std::vector<PartNames> namesOf(const CheckResult& result) {
    std::vector<PartNames> out;
    for (const CheckedPart& part : result.parts) out.push_back({part.name, part.within});
    return out;
  }

  template <class IsOf>
  void addOffsets(const CheckRule& rule, const RuleCount& count, const IsOf& isOf,
                  std::vector<RuleOutcome>& found) const {
    const std::size_t before = found.size();
    for (const CheckedFit& fit : result_.fits)
      if (fit.kind != FitKind::Key && isOf(fit.shaft, fit.bore)) found.push_back(offsetOutcome(rule, fit));
    if (found.size() > before) return;
    RuleOutcome& none = found.emplace_back();
    none.rule = rule.name;
    if (rule.between) {
      none.a = rule.between->a;
      none.b = rule.between->b;
    }
    none.measure = RuleMeasure::AxisOffset;
    none.value_m = none.error_m = std::numeric_limits<double>::quiet_NaN();
    none.bound_m = *rule.max_axis_offset_m;
    none.state = RuleState::NotDecided;
    none.reason = count.left_out > 0 ? "no round fit and no thread was found; pairs were left out"
                                     : "no round fit and no thread was found";
  }

  const CheckResult& result_;
  std::vector<PartNames> names_;
  PairChoice choice_;
  std::unordered_map<std::string_view, std::size_t> index_of_;
  std::vector<RuleOutcome> outcomes_;
  std::vector<RuleCount> counts_;
};

}  // namespace

const char* toText(RuleMeasure measure) {
  constexpr std::array kWords{"clearance", "overlap", "axis offset"};
  return kWords[static_cast<std::size_t>(measure)];
}

const char* toText(RuleState state) {
  constexpr std::array kWords{"kept", "not decided", "broken"};
  return kWords[static_cast<std::size_t>(state)];
}

PairPattern pairFromText(const std::string& text, const std::string& option) {
  const std::size_t comma = text.find(',');
  const bool is_one = comma != std::string::npos && text.find(',', comma + 1) == std::string::npos;
  if (!is_one || comma == 0 || comma + 1 == text.size())
    throw LoadError(option, "",
                    "'" + text +
                        "' is not a pair; write two names with a comma between them, like pin,bush; * stands "
                        "for any text, also for a comma in a name");
  return {text.substr(0, comma), text.substr(comma + 1), option + " " + text};
}

void judgeRules(const std::vector<CheckRule>& rules, CheckResult& result) {
  if (rules.empty()) return;
  Judge judge(result);
  for (const CheckRule& rule : rules) judge.judge(rule);
  judge.giveTo(result);
}

RuleState worstState(const std::vector<RuleOutcome>& outcomes) {
  const auto worst = std::ranges::max_element(outcomes, {}, &RuleOutcome::state);
  return worst == outcomes.end() ? RuleState::Kept : worst->state;
}

Verdict answerOf(const CheckResult& result) {
  const RuleState rules = worstState(result.rules);
  if (rules == RuleState::Broken) return Verdict::Blocked;
  const Verdict verdict = result.verdict();
  return verdict == Verdict::Fits && rules == RuleState::NotDecided ? Verdict::NotShown : verdict;
}

std::string inWords(const RuleOutcome& outcome) {
  std::string out = toText(outcome.measure);
  if (std::isfinite(outcome.value_m))
    out += " " + lengthInWords(outcome.value_m, 2) + " (+- " + lengthInWords(outcome.error_m, 2) + ")";
  out += outcome.measure == RuleMeasure::Clearance ? ", at least " : ", at most ";
  out += lengthInWords(outcome.bound_m, 2) + " wanted";
  return outcome.reason.empty() ? out : out + "; " + outcome.reason;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Rules for pairs of parts: reads them from text and files, and judges them by the numbers of a check.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::scenes {

/// Parses "pin,bush", a pair of patterns. Throws LoadError that names the option.
/// @param option  for messages: "--between"
VPS_SCENES_API PairPattern pairFromText(const std::string& text, const std::string& option);

/// Reads a file of rules (TOML, scenes/fits/RULES.md). Throws LoadError with file, line, key and remedy.
VPS_SCENES_API std::vector<CheckRule> loadRules(const std::string& file);

/// Reads what a file of rules says about overlaps: its tables [[overlap]]. Throws LoadError, as loadRules()
/// does.
VPS_SCENES_API std::vector<OverlapRule> loadOverlapRules(const std::string& file);

/// Judges the rules by the numbers of a check, which must have measured all pairs within the bounds of the
/// rules, as checkAssembly() does with CheckSettings::rules. Appends outcomes to result.rules, the broken
/// ones first, and a count for each rule to result.rule_counts. Throws LoadError if a pattern of a rule
/// matches no part. O(rules x parts^2).
VPS_SCENES_API void judgeRules(const std::vector<CheckRule>& rules, CheckResult& result);

/// The worst state of the outcomes; Kept if there are none.
VPS_SCENES_API RuleState worstState(const std::vector<RuleOutcome>& outcomes);

/// The check's verdict together with its rules: Blocked if a rule is broken, NotShown instead of Fits if one
/// is not decided.
VPS_SCENES_API Verdict answerOf(const CheckResult& result);

/// An outcome in words: "clearance 0.120 mm (+- 2.00 um), at least 0.300 mm wanted".
VPS_SCENES_API std::string inWords(const RuleOutcome& outcome);

}  // namespace vps::scenes

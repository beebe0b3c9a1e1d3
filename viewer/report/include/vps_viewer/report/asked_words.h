// SPDX-License-Identifier: BSD-3-Clause
// What a designer asked of a check, in words, the same on the terminal and on the page: chosen pairs, moved
// parts, rules. Each function returns empty text where nothing was asked.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// The pairs that were left out: "this is about the chosen pairs only: 2 pairs near each other were left out
/// by --ignore bolt,nut".
VPS_VIEWER_API std::string chosenWords(const scenes::CheckResult& result);

/// The moves before the check: "'pin' was moved by 0.1000 mm along +x before the check".
VPS_VIEWER_API std::string moveWords(const scenes::CheckResult& result);

/// The rules in one sentence: "rules: 1 broken, 2 not decided, 5 kept; 'gap' is broken by pin and bush:
/// clearance 120.00 um (+- 2.00 um), at least 300.00 um wanted".
VPS_VIEWER_API std::string ruleWords(const scenes::CheckResult& result);

/// What the table of outcomes does not show of a rule, a sentence for each rule that it applies to: "'gap': 3
/// more pairs keep it, since they are farther apart; 1 pair was left out".
VPS_VIEWER_API std::vector<std::string> ruleNotes(const scenes::CheckResult& result);

/// The overlaps that are taken for threads, seals or inserts: "3 overlaps are no clashes: 2 threads, 1 seal;
/// --strict-overlaps counts those that are not declared as clashes". Empty if there are none.
VPS_VIEWER_API std::string knownWords(const scenes::CheckResult& result);

/// What was assumed about each thread, seal or insert, and about clashes that are nearly one, a sentence for
/// each: "plate and screw: taken for a thread M8, drawn as cylinders: ...".
VPS_VIEWER_API std::vector<std::string> knownNotes(const scenes::CheckResult& result);

/// Why the check has no play of a part: "overlaps", or "not measured" for a part of a pair that was left out.
VPS_VIEWER_API std::string noPlayWords(const scenes::CheckedPart& part, const scenes::CheckResult& result);

}  // namespace vps::viewer

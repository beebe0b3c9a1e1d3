// SPDX-License-Identifier: BSD-3-Clause
// The keys of `[[rule]]` and `[[overlap]]` in a file of rules, from which scenes/fits/RULES.md is made.
#pragma once

#include "vps_scenes/fits/check_wishes.h"
#include "vps_scenes/scene/fields.h"

namespace vps::scenes {

inline constexpr auto kRuleKeys = std::make_tuple(
    Key{"name", "text", "`\"rule 1\"` and so on", "name of the rule in reports"},
    Key{"between", "2 texts", "all pairs",
        "the rule is about pairs of which one part matches the first text and the other part the second: "
        "names of parts, assemblies or products; `*` stands for any text"},
    field("min_clearance", &CheckRule::min_clearance_m, "least distance of the surfaces",
          {.quantity = Quantity::Length, .range = kPositive, .default_text = "none"}),
    field("max_overlap", &CheckRule::max_overlap_m,
          "greatest depth of an overlap; a bound below 0.5 um means 0.5 um, up to which an overlap counts as "
          "contact",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "none"}),
    field("max_axis_offset", &CheckRule::max_axis_offset_m,
          "greatest distance of the axes of shaft and bore, or of screw and nut, along the fit",
          {.quantity = Quantity::Length, .range = kNotNegative, .default_text = "none"}));

inline constexpr auto kOverlapRuleKeys = std::make_tuple(
    Key{"between", "2 texts", "required", "the pairs, as for `[[rule]]`"},
    Key{"kind", "text", "required",
        "`thread`, `seal`, `insert`, `self-tapping`, or `clash`: it is none of these, whatever the shapes "
        "suggest"},
    field("max_squash", &OverlapRule::max_squash,
          "greatest squash of a seal, divided by the width of its section",
          {.range = {.min = 0, .max = 1}, .default_text = "0.3"}));

}  // namespace vps::scenes

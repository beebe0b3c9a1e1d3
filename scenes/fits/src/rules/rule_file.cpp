// SPDX-License-Identifier: BSD-3-Clause
// Reads files of rules.
#include <algorithm>

#include "scene/read_fields.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/fits/rule_keys.h"
#include "vps_scenes/fits/rules.h"

namespace vps::scenes {

namespace {

CheckRule readRule(const SceneKeys& keys, std::size_t number) {
  CheckRule rule;
  rule.name = "rule " + std::to_string(number);
  keys.text("name", rule.name);
  if (std::vector<std::string> names; keys.texts("between", names)) {
    if (names.size() != 2)
      keys.fail("between", "has " + std::to_string(names.size()) +
                               R"( texts; expected two names or patterns, like ["shaft*", "bush"])");
    rule.between = {names[0], names[1], keys.placeOf("between")};
  }
  readFields(keys, rule, kRuleKeys);
  if (!rule.min_clearance_m && !rule.max_overlap_m && !rule.max_axis_offset_m)
    keys.failWhole("has no bound; give 'min_clearance', 'max_overlap' or 'max_axis_offset'");
  return rule;
}

}  // namespace

std::vector<CheckRule> loadRules(const std::string& file) {
  const toml::table root = parseToml(readTomlText(file, "file of rules", "rules.toml"), file);
  SceneFileContext context{file, std::nullopt};
  const SceneKeys top(root, context, "", {"unit", "rule"});
  if (std::string unit; top.text("unit", unit)) {
    context.unit_m = unitFromText(unit);
    if (!context.unit_m) top.fail("unit", "is '" + unit + "'; expected one of: mm, cm, m, um, inch");
  }
  std::vector<CheckRule> rules;
  for (const toml::table* table : top.tables("rule")) {
    const SceneKeys keys(*table, context, "[[rule]]", keysOf(kRuleKeys));
    CheckRule rule = readRule(keys, rules.size() + 1);
    if (std::ranges::find(rules, rule.name, &CheckRule::name) != rules.end())
      keys.failWhole("is the second rule named '" + rule.name + "'; give it another 'name'");
    rules.push_back(std::move(rule));
  }
  if (rules.empty())
    throw LoadError(file, "", R"(has no rule; write one in [[rule]], with min_clearance = "0.3mm")");
  return rules;
}

}  // namespace vps::scenes

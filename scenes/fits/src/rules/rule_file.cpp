// SPDX-License-Identifier: BSD-3-Clause
// Reads files of rules.
#include <algorithm>
#include <array>

#include "scene/read_fields.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/fits/rule_keys.h"
#include "vps_scenes/fits/rules.h"

namespace vps::scenes {

namespace {

/// The pairs that "between" names; empty without the key.
std::optional<PairPattern> readBetween(const SceneKeys& keys) {
  std::vector<std::string> names;
  if (!keys.texts("between", names)) return std::nullopt;
  if (names.size() != 2)
    keys.fail("between", "has " + std::to_string(names.size()) +
                             R"( texts; expected two names or patterns, like ["shaft*", "bush"])");
  return PairPattern{names[0], names[1], keys.placeOf("between")};
}

CheckRule readRule(const SceneKeys& keys, std::size_t number) {
  CheckRule rule;
  rule.name = "rule " + std::to_string(number);
  keys.text("name", rule.name);
  rule.between = readBetween(keys);
  readFields(keys, rule, kRuleKeys);
  if (!rule.min_clearance_m && !rule.max_overlap_m && !rule.max_axis_offset_m)
    keys.failWhole("has no bound; give 'min_clearance', 'max_overlap' or 'max_axis_offset'");
  return rule;
}

OverlapRule readOverlapRule(const SceneKeys& keys) {
  constexpr std::array kKinds{OverlapWish::Thread, OverlapWish::Seal, OverlapWish::Insert,
                              OverlapWish::SelfTapping, OverlapWish::Clash};
  OverlapRule rule;
  const std::optional<PairPattern> between = readBetween(keys);
  if (!between) keys.failWhole(R"(names no pairs; give between = ["oring*", "housing"])");
  rule.between = *between;
  std::vector<std::string> words;
  for (const OverlapWish kind : kKinds) words.emplace_back(toText(kind));
  std::size_t kind = 0;
  if (!keys.word("kind", words, kind))
    keys.failWhole("has no 'kind'; give one of: thread, seal, insert, self-tapping, clash");
  rule.kind = kKinds[kind];
  readFields(keys, rule, kOverlapRuleKeys);
  if (rule.max_squash && rule.kind != OverlapWish::Seal)
    keys.fail("max_squash", R"(is for a seal only; write kind = "seal", or leave it out)");
  return rule;
}

/// Calls read(top of the file, context) for a file of rules, whose unit is known then.
template <class Read>
void readRuleFile(const std::string& file, Read read) {
  const toml::table root = parseToml(readTomlText(file, "file of rules", "rules.toml"), file);
  SceneFileContext context{file, std::nullopt};
  const SceneKeys top(root, context, "", {"unit", "rule", "overlap"});
  if (std::string unit; top.text("unit", unit)) {
    context.unit_m = unitFromText(unit);
    if (!context.unit_m) top.fail("unit", "is '" + unit + "'; expected one of: mm, cm, m, um, inch");
  }
  read(top, context);
}

}  // namespace

std::vector<CheckRule> loadRules(const std::string& file) {
  std::vector<CheckRule> rules;
  readRuleFile(file, [&](const SceneKeys& top, const SceneFileContext& context) {
    for (const toml::table* table : top.tables("rule")) {
      const SceneKeys keys(*table, context, "[[rule]]", keysOf(kRuleKeys));
      CheckRule rule = readRule(keys, rules.size() + 1);
      if (std::ranges::find(rules, rule.name, &CheckRule::name) != rules.end())
        keys.failWhole("is the second rule named '" + rule.name + "'; give it another 'name'");
      rules.push_back(std::move(rule));
    }
    if (rules.empty() && top.tables("overlap").empty())
      throw LoadError(file, "", R"(has no rule; write one in [[rule]], with min_clearance = "0.3mm")");
  });
  return rules;
}

std::vector<OverlapRule> loadOverlapRules(const std::string& file) {
  std::vector<OverlapRule> rules;
  readRuleFile(file, [&](const SceneKeys& top, const SceneFileContext& context) {
    for (const toml::table* table : top.tables("overlap"))
      rules.push_back(readOverlapRule(SceneKeys(*table, context, "[[overlap]]", keysOf(kOverlapRuleKeys))));
  });
  return rules;
}

}  // namespace vps::scenes

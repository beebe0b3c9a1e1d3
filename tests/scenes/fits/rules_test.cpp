// SPDX-License-Identifier: BSD-3-Clause
// Rules for pairs, on both sides of their bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/drawn_part.h"
#include "vps/errors.h"
#include "vps_scenes/fits/check.h"
#include "vps_scenes/fits/rules.h"

namespace vps::scenes {
namespace {

/// The result of a check of two parts with one pair.
CheckResult resultOf(const CheckedPair& pair) {
  CheckResult result;
  result.pairs = {pair};
  for (const std::string& name : {pair.a, pair.b}) result.parts.emplace_back().name = name;
  return result;
}

CheckedPair apart(double clearance_m, double error_m) {
  CheckedPair pair{.a = "pin", .b = "bush"};
  pair.clearance_m = clearance_m;
  pair.error_m = error_m;
  return pair;
}

CheckedPair overlapping(PairState state, double depth_m, double error_m) {
  CheckedPair pair = apart(0, error_m);
  pair.state = state;
  pair.interference_depth_m = depth_m;
  return pair;
}

CheckRule gapRule(double least_m) {
  CheckRule rule;
  rule.name = "gap";
  rule.min_clearance_m = least_m;
  return rule;
}

CheckRule overlapRule(double most_m) {
  CheckRule rule;
  rule.name = "depth";
  rule.max_overlap_m = most_m;
  return rule;
}

CheckRule offsetRule(double most_m) {
  CheckRule rule;
  rule.name = "coaxial";
  rule.max_axis_offset_m = most_m;
  return rule;
}

/// The only outcome of a rule.
RuleOutcome outcomeOf(const CheckRule& rule, CheckResult result) {
  judgeRules({rule}, result);
  EXPECT_EQ(result.rules.size(), 1U);
  return result.rules.empty() ? RuleOutcome() : result.rules.front();
}

TEST(Rules, AClearanceIsDecidedUpToItsError) {
  // 300 um +- 2 um: at least 298 um and at most 302 um.
  for (const auto& [bound_m, state] : {std::pair{297e-6, RuleState::Kept},
                                       {298e-6, RuleState::Kept},
                                       {298.1e-6, RuleState::NotDecided},
                                       {300e-6, RuleState::NotDecided},
                                       {301.9e-6, RuleState::NotDecided},
                                       {302.1e-6, RuleState::Broken}}) {
    const RuleOutcome found = outcomeOf(gapRule(bound_m), resultOf(apart(300e-6, 2e-6)));
    EXPECT_EQ(found.state, state) << bound_m;
    EXPECT_EQ(found.value_m, 300e-6);
    EXPECT_EQ(found.error_m, 2e-6);
    EXPECT_EQ(found.bound_m, bound_m);
    EXPECT_EQ(found.a, "pin");
    EXPECT_EQ(found.b, "bush");
  }
}

TEST(Rules, NumbersThatDifferInNoPrintedDigitAreEqual) {
  EXPECT_EQ(outcomeOf(gapRule(0.3e-3), resultOf(apart(0.3e-3 - 4e-9, 1e-15))).state, RuleState::Kept);
  EXPECT_EQ(outcomeOf(gapRule(0.3e-3), resultOf(apart(0.3e-3 - 20e-9, 1e-15))).state, RuleState::Broken);
}

TEST(Rules, TheClearanceOfAnOverlapIsMinusItsDepth) {
  const RuleOutcome found =
      outcomeOf(gapRule(0.1e-3), resultOf(overlapping(PairState::Clash, 20e-6, 0.1e-6)));
  EXPECT_EQ(found.state, RuleState::Broken);
  EXPECT_EQ(found.value_m, -20e-6);
  EXPECT_NEAR(found.margin_m(), -120e-6, 1e-12);
  EXPECT_EQ(inWords(found), "clearance -20.00 um (+- 0.10 um), at least 100.00 um wanted");
}

TEST(Rules, AnOverlapIsDecidedUpToItsError) {
  for (const auto& [depth_m, state] : {std::pair{9e-6, RuleState::Kept},
                                       {9.5e-6, RuleState::Kept},
                                       {9.6e-6, RuleState::NotDecided},
                                       {10.4e-6, RuleState::NotDecided},
                                       {10.6e-6, RuleState::Broken}})
    EXPECT_EQ(outcomeOf(overlapRule(10e-6), resultOf(overlapping(PairState::Clash, depth_m, 0.5e-6))).state,
              state)
        << depth_m;
  EXPECT_EQ(outcomeOf(overlapRule(0), resultOf(apart(1e-6, 0.9e-6))).state, RuleState::Kept);
}

// Half a micrometre of overlap is contact for every verdict, and so for a rule without overlap.
TEST(Rules, NoOverlapMeansNoMoreThanContact) {
  EXPECT_EQ(outcomeOf(overlapRule(0), resultOf(overlapping(PairState::Contact, 0.39e-6, 0.1e-6))).state,
            RuleState::Kept);
  EXPECT_EQ(outcomeOf(overlapRule(0), resultOf(overlapping(PairState::Contact, 0.39e-6, 0.2e-6))).state,
            RuleState::NotDecided);
  EXPECT_EQ(outcomeOf(overlapRule(0), resultOf(overlapping(PairState::Clash, 0.7e-6, 0.1e-6))).state,
            RuleState::Broken);
}

TEST(Rules, AnAxisOffsetIsThatOfTheRoundFits) {
  CheckResult result = resultOf(apart(10e-6, 1e-6));
  CheckedFit& fit = result.fits.emplace_back();
  fit.shaft = "pin";
  fit.bore = "bush";
  fit.offset_m = 40e-6;
  fit.error_m = 2e-6;
  EXPECT_EQ(outcomeOf(offsetRule(42e-6), result).state, RuleState::Kept);
  EXPECT_EQ(outcomeOf(offsetRule(41e-6), result).state, RuleState::NotDecided);
  EXPECT_EQ(outcomeOf(offsetRule(37e-6), result).state, RuleState::Broken);
  fit.kind = FitKind::Key;  // has no axes
  const RuleOutcome none = outcomeOf(offsetRule(42e-6), result);
  EXPECT_EQ(none.state, RuleState::NotDecided);
  EXPECT_TRUE(std::isnan(none.value_m));
  EXPECT_EQ(inWords(none), "axis offset, at most 42.00 um wanted; no round fit and no thread was found");
}

TEST(Rules, APartWithoutAnInsideKeepsNoClearance) {
  CheckedPair pair = apart(300e-6, 0);
  pair.is_uncertain = true;
  EXPECT_EQ(outcomeOf(gapRule(100e-6), resultOf(pair)).state, RuleState::NotDecided);
  EXPECT_EQ(outcomeOf(overlapRule(0), resultOf(pair)).state, RuleState::NotDecided);
  EXPECT_EQ(outcomeOf(gapRule(400e-6), resultOf(pair)).state, RuleState::Broken);
}

TEST(Rules, TheBrokenOnesAreFirstAndEachRuleIsCounted) {
  CheckResult result = resultOf(apart(300e-6, 1e-6));
  result.parts.emplace_back().name = "lid";
  CheckRule of_lid = gapRule(200e-6);
  of_lid.name = "lid";
  of_lid.between = {"l*", "*", "rules.toml:7"};
  judgeRules({gapRule(200e-6), of_lid, gapRule(400e-6)}, result);
  ASSERT_EQ(result.rules.size(), 2U);
  EXPECT_EQ(result.rules[0].state, RuleState::Broken);
  EXPECT_EQ(result.rules[1].state, RuleState::Kept);
  EXPECT_EQ(worstState(result.rules), RuleState::Broken);
  ASSERT_EQ(result.rule_counts.size(), 3U);
  EXPECT_EQ(result.rule_counts[0].kept, 1U);
  EXPECT_EQ(result.rule_counts[0].apart, 2U);  // the lid's pairs were too far apart to be measured
  EXPECT_EQ(result.rule_counts[1].kept, 0U);
  EXPECT_EQ(result.rule_counts[1].apart, 2U);
  EXPECT_EQ(result.rule_counts[2].broken, 1U);
  EXPECT_EQ(worstState({}), RuleState::Kept);
}

TEST(Rules, APatternWithoutAPartOffersTheNearestName) {
  CheckResult result = resultOf(apart(300e-6, 1e-6));
  CheckRule rule = gapRule(200e-6);
  rule.between = {"pin", "bosh", "rules.toml:7"};
  try {
    judgeRules({rule}, result);
    FAIL() << "accepted";
  } catch (const LoadError& error) {
    EXPECT_STREQ(error.what(), "rules.toml:7: 'bosh' matches no part; did you mean 'bush'?");
  }
  rule.between = {"pin", "p*", "rules.toml:7"};
  EXPECT_THROW(judgeRules({rule}, result), LoadError);  // one part is no pair
}

DrawnPart ruledBlock(const std::string& name, double z_m) {
  return part(name, makeBox({10e-3, 10e-3, 10e-3}), Pose::translation({0, 0, z_m}));
}

TEST(Rules, PairsAreMeasuredUpToTheBoundOfTheirRule) {
  const std::vector<DrawnPart> parts{ruledBlock("low", 0), ruledBlock("middle", 15e-3),
                                     ruledBlock("high", 32e-3)};  // gaps of 5 mm and 7 mm
  CheckSettings settings{.has_fits = false, .has_play = false};
  EXPECT_TRUE(checkAssembly("far", parts, settings).pairs.empty());
  CheckRule rule = gapRule(6e-3);
  settings.rules = {rule};
  CheckResult found = checkAssembly("far", parts, settings);
  ASSERT_EQ(found.rules.size(), 1U);
  EXPECT_EQ(found.rules[0].state, RuleState::Broken);
  EXPECT_NEAR(found.rules[0].value_m, 5e-3, 1e-12);
  EXPECT_EQ(found.rule_counts[0].apart, 2U);
  rule.between = {"middle", "high", "test"};
  settings.rules = {rule};
  found = checkAssembly("far", parts, settings);
  EXPECT_TRUE(found.rules.empty());
  EXPECT_EQ(found.rule_counts[0].apart, 1U);
}

}  // namespace
}  // namespace vps::scenes

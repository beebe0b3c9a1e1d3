// SPDX-License-Identifier: BSD-3-Clause
// Several seeds of the hand: one success shows that the parts fit, and the share of successes is the ease of
// assembly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "hand_scenes.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"

namespace vps::hand {
namespace {

/// A timeout with which seeds that need no search succeed, and other seeds do not.
constexpr double kHurried_s = 8;

scenes::Scene hurried() {
  scenes::Scene scene = pegScenes()[1].make(1);
  scene.steps[0].timeout_s = kHurried_s;
  return scene;
}

scenes::AssembleOptions fewJudged() {
  scenes::AssembleOptions options;
  options.judge_stride = 1000;
  return options;
}

TEST(Tries, AreTheSameRunsOnOneThreadAndOnThree) {
  const scenes::Scene scene = hurried();
  const scenes::AssembleResult one = scenes::assembleTries(scene, {4, 1}, fewJudged()),
                               three = scenes::assembleTries(scene, {4, 3}, fewJudged());
  ASSERT_EQ(one.tries.size(), 4u);
  ASSERT_EQ(three.tries.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(one.tries[i].seed, 1 + i);
    EXPECT_EQ(three.tries[i].seed, 1 + i);
    EXPECT_EQ(one.tries[i].verdict, three.tries[i].verdict);
    EXPECT_EQ(one.tries[i].simulated_s, three.tries[i].simulated_s);
    EXPECT_EQ(one.tries[i].reason, three.tries[i].reason);
  }
  EXPECT_EQ(one.ease_share, three.ease_share);
  ASSERT_EQ(one.trace.size(), three.trace.size());
  for (std::size_t i = 0; i < one.trace.size(); ++i)
    ASSERT_EQ(std::memcmp(&one.trace[i].X_WP, &three.trace[i].X_WP, sizeof(Pose)), 0) << i;
}

TEST(Tries, OneSuccessShowsThatThePartsGoTogetherAndTheShareIsTheEase) {
  const scenes::AssembleResult result = scenes::assembleTries(hurried(), {6}, fewJudged());
  const auto good = std::count_if(result.tries.begin(), result.tries.end(), [](const scenes::TryResult& one) {
    return one.verdict == scenes::Verdict::Fits;
  });
  ASSERT_GT(good, 0);
  ASSERT_LT(good, 6);  // otherwise the test shows nothing, and kHurried_s has to change
  EXPECT_EQ(result.verdict, scenes::Verdict::Fits);
  EXPECT_TRUE(result.steps.at(0).completed);
  ASSERT_TRUE(result.ease_share.has_value());
  EXPECT_DOUBLE_EQ(*result.ease_share, static_cast<double>(good) / 6);
  for (const scenes::TryResult& one : result.tries)
    EXPECT_EQ(one.reason.empty(), one.verdict == scenes::Verdict::Fits) << one.reason;
}

TEST(Tries, WhatGeometryProvesToBeBlockedIsTriedOnce) {
  PegFit fit;
  fit.clearance_m = -100e-6;
  scenes::Scene scene = pegScene("too large", holeMesh(fit), pegMesh(fit), fit.depth_m, 1);
  scene.steps[0].timeout_s = 3;
  const scenes::AssembleResult result = scenes::assembleTries(scene, {5}, fewJudged());
  EXPECT_EQ(result.verdict, scenes::Verdict::Blocked);
  EXPECT_EQ(result.tries.size(), 1u);
}

TEST(Tries, RefuseFewerThanOneAndRealTime) {
  const scenes::Scene scene = hurried();
  EXPECT_THROW(scenes::assembleTries(scene, {0}), LoadError);
  scenes::AssembleOptions by_clock;
  by_clock.is_real_time = true;
  EXPECT_THROW(scenes::assembleTries(scene, {2}, by_clock), LoadError);
}

}  // namespace
}  // namespace vps::hand

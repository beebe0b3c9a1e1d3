// SPDX-License-Identifier: BSD-3-Clause
// The rows that are kept of a step, however long it takes.
#include "world/step_rows.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vps::scenes {
namespace {

const Box kBox{Vec3::Constant(-1e-3), Vec3::Constant(1e-3)};

TraceRow rowAt(double time_s) {
  TraceRow row;
  row.time_s = time_s;
  return row;
}

TEST(StepRows, AllRowsOfAShortStepAreKept) {
  StepRows rows(10);
  rows.beginStep(kBox);
  for (int i = 0; i < 10; ++i) rows.add(rowAt(i), {0.5 + i, {}, 0});
  ASSERT_EQ(rows.rows().size(), 10u);
  EXPECT_EQ(rows.rows()[9].time_s, 9);
  EXPECT_EQ(rows.takeSamples().size(), 10u);
  rows.beginStep(kBox);
  rows.add(rowAt(10), {});
  EXPECT_EQ(rows.rows().size(), 1u);
  EXPECT_EQ(rows.takeRows().size(), 11u);
}

// Of 11 to 20 steps every second one is kept, of 21 to 40 every fourth one, and so on, at equal distances
// from the first. The number of kept rows is between half of `most` and `most`.
TEST(StepRows, OfALongStepRowsAtEqualDistancesAndTheDeepestSampleAreKept) {
  for (int count = 11; count < 500; ++count)
    for (const int deepest : {0, 1, count / 2, count - 1}) {
      StepRows rows(10);
      rows.beginStep(kBox);
      for (int i = 0; i < count; ++i)
        rows.add(rowAt(i), {static_cast<double>(i), {}, i == deepest ? 1e-6 : 0});
      const auto kept = rows.rows();
      ASSERT_GE(kept.size(), 5u) << count;
      ASSERT_LE(kept.size(), 10u) << count;
      const double stride = kept[1].time_s;
      for (std::size_t i = 0; i < kept.size(); ++i)
        ASSERT_EQ(kept[i].time_s, stride * static_cast<double>(i)) << count;
      ASSERT_GE(kept.back().time_s, count - stride) << count;
      const auto samples = rows.takeSamples();
      ASSERT_EQ(samples.size(), kept.size());
      const auto found = std::max_element(samples.begin(), samples.end(),
                                          [](const auto& a, const auto& b) { return a.depth_m < b.depth_m; });
      ASSERT_EQ(found->time_s, deepest) << count;
    }
}

// In a thinned step, samples do not follow each other directly, but both samples of a fast physics step are
// kept.
TEST(StepRows, OfALongStepTheTwoSamplesOfEachFastPhysicsStepAreKept) {
  for (int count = 11; count < 200; ++count)
    for (const int fast : {1, count / 2, count - 1}) {
      StepRows rows(10);
      rows.beginStep(kBox);
      for (int i = 0; i < count; ++i)
        rows.add(rowAt(i), {static_cast<double>(i), Pose::translation({i < fast ? 0 : 0.2e-3, 0, 0}), 0});
      const std::size_t kept = rows.rows().size();
      const auto samples = rows.takeSamples();
      ASSERT_EQ(samples.size(), kept + 2) << count;
      for (std::size_t i = 0; i <= kept; ++i) ASSERT_FALSE(samples[i].follows) << count;
      EXPECT_TRUE(samples[kept + 1].follows);
      EXPECT_EQ(samples[kept].time_s, fast - 1) << count;
      EXPECT_EQ(samples[kept + 1].time_s, fast) << count;
    }
}

}  // namespace
}  // namespace vps::scenes

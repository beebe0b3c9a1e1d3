// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/tick_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "support/no_alloc.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

// Reference: nearest rank in the sorted list of all values.
std::int64_t exact(const std::vector<std::int64_t>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

TEST(TickHistogram, PercentilesMatchTheSortedListToOnePartIn64) {
  Random random(7);
  for (const double spread : {0.0, 0.3, 1.5, 4.0}) {
    TickHistogram histogram;
    std::vector<std::int64_t> all;
    for (int i = 0; i < 20000; ++i) {
      const auto ns = static_cast<std::int64_t>(50e3 * std::exp(spread * random.normal()));
      histogram.add(ns);
      all.push_back(ns);
    }
    std::sort(all.begin(), all.end());
    for (const double share : {0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 0.9999, 1.0}) {
      const std::int64_t truth = exact(all, share), told = histogram.percentile(share);
      EXPECT_GE(told, truth) << spread << " " << share;
      EXPECT_LE(told, truth + truth / TickHistogram::kSplit) << spread << " " << share;
    }
    EXPECT_EQ(histogram.summary().max_ns, all.back());
    EXPECT_EQ(histogram.summary().count, all.size());
  }
}

TEST(TickHistogram, EveryValueIsRoundedUpToItsBucketsEnd) {
  // Values at and next to each power of two, where an index may be one off. A second, greater value is
  // needed, since the exact maximum would hide the end of the bucket.
  for (int bit = 0; bit < 40; ++bit)
    for (const std::int64_t off : {-1, 0, 1}) {
      const std::int64_t ns = (std::int64_t{1} << bit) + off;
      TickHistogram histogram;
      histogram.add(ns);
      histogram.add(std::int64_t{1} << 41);
      const std::int64_t told = histogram.percentile(0.5);
      EXPECT_GE(told, ns);
      EXPECT_LE(told, ns + ns / TickHistogram::kSplit);
    }
}

TEST(TickHistogram, CountsNegativeAndVeryLongTimes) {
  TickHistogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), 0);
  histogram.add(-5);
  histogram.add(std::int64_t{1} << 62);
  EXPECT_EQ(histogram.summary().count, 2u);
  EXPECT_EQ(histogram.summary().p50_ns, 0);
  EXPECT_EQ(histogram.summary().max_ns, std::int64_t{1} << 62);
}

TEST(TickTiming, NamesTheGreatestPartAsTheCause) {
  EXPECT_EQ((TickTiming{0, 9, 3, 2, 50, 0}).cause(), TickCause::WokenLate);
  EXPECT_EQ((TickTiming{0, 1, 3, 2, 50, 0}).cause(), TickCause::Device);
  EXPECT_EQ((TickTiming{0, 1, 3, 7, 50, 0}).cause(), TickCause::OwnWork);
  EXPECT_EQ((TickTiming{0, 1, 3, 7, 50, 0}).cause(true), TickCause::AfterTick);
}

TEST(TickStatistics, KeepsAllFieldsOfTheWorstTickAndCountsMissesByCause) {
  TickStatistics statistics(1000);
  {
    vps_test::NoAllocScope guard;
    for (std::uint64_t i = 0; i < 100; ++i) statistics.add({i, 10, 20, 30, 5, 500});
    statistics.add({100, 1, 2, 400, 0, 1500});
    for (std::uint64_t i = 101; i < 200; ++i) statistics.add({i, 10, 20, 30, 5, 1001});
    statistics.miss(3, TickCause::AfterTick);
    statistics.miss(2, TickCause::WokenLate);
  }
  const TickStatistics::Summary all = statistics.summary();
  EXPECT_EQ(all.tick.count, 200u);
  EXPECT_EQ(all.tick.p50_ns, 50);
  EXPECT_EQ(all.tick.max_ns, 402);
  EXPECT_EQ(all.response.max_ns, 403);
  EXPECT_EQ(all.late.max_ns, 10);
  EXPECT_EQ(all.missed, 5u);
  EXPECT_EQ(all.missed_by[static_cast<int>(TickCause::AfterTick)], 3u);
  EXPECT_EQ(all.missed_by[static_cast<int>(TickCause::WokenLate)], 2u);
  EXPECT_EQ(all.stale, 100u);
  EXPECT_EQ(all.worst.tick, 100u);
  EXPECT_EQ(all.worst.cause(), TickCause::OwnWork);
}

TEST(TickStatistics, IsReadConsistentlyWhileItIsWritten) {
  // Every field identifies its tick, so that a mixture of two ticks would be detected.
  TickStatistics statistics;
  constexpr std::int64_t kTicks = 200000;
  std::thread writer([&] {
    for (std::int64_t i = 1; i <= kTicks; ++i)
      statistics.add({static_cast<std::uint64_t>(i), i, 2 * i, 3 * i, 4 * i, 5 * i});
  });
  std::int64_t last = 0;
  do {
    const TickStatistics::Summary all = statistics.summary();
    const auto i = static_cast<std::int64_t>(all.worst.tick);
    ASSERT_EQ(all.worst.late_ns, i);
    ASSERT_EQ(all.worst.device_ns, 2 * i);
    ASSERT_EQ(all.worst.own_ns, 3 * i);
    ASSERT_EQ(all.worst.after_tick_ns, 4 * i);
    ASSERT_EQ(all.worst.snapshot_ns, 5 * i);
    ASSERT_GE(i, last);
    last = i;
  } while (last < kTicks);
  writer.join();
  EXPECT_EQ(statistics.summary().tick.count, static_cast<std::uint64_t>(kTicks));
}

}  // namespace
}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/tick_times.h"
#include "vps_scenes/run/contact_episodes.h"

namespace vps::scenes {
namespace {

/// Builds a trace at 1 kHz.
struct TraceMaker {
  std::vector<TraceRow> rows;
  void add(int steps, bool is_touching, double speed_m_s, int phase = 1) {
    for (int i = 0; i < steps; ++i) {
      TraceRow row = rows.empty() ? TraceRow{} : rows.back();
      row.time_s += 1e-3;
      row.X_WP.p.x() += speed_m_s * 1e-3;
      row.contacts = is_touching ? 1 : 0;
      row.phase = phase;
      rows.push_back(row);
    }
  }
  [[nodiscard]] std::ptrdiff_t count(bool is_slide) const {
    const auto episodes = contactEpisodes(rows);
    return std::count_if(episodes.begin(), episodes.end(),
                         [&](const ContactEpisode& e) { return e.is_slide == is_slide; });
  }
};

TEST(ContactEpisodes, FiveImpactsAndTwoSlidesAsInFigure9) {
  TraceMaker trace;
  for (int i = 0; i < 5; ++i) {
    trace.add(5, true, 0.01);  // 5 ms, 50 um: an impact
    trace.add(100, false, 0.05);
  }
  for (int i = 0; i < 2; ++i) {
    trace.add(300, true, 0.01);  // 300 ms, 3 mm: a slide
    trace.add(100, false, 0.05);
  }
  EXPECT_EQ(trace.count(false), 5);
  EXPECT_EQ(trace.count(true), 2);
}

TEST(ContactEpisodes, ChatterShorterThanTheBridgeIsOneImpact) {
  TraceMaker trace;
  for (int i = 0; i < 4; ++i) {
    trace.add(2, true, 0.001);
    trace.add(10, false, 0.001);
  }
  EXPECT_EQ(trace.count(false), 1);
  EXPECT_EQ(trace.count(true), 0);
}

TEST(ContactEpisodes, AReleasedPartOnItsSeatIsNoEpisode) {
  TraceMaker trace;
  trace.add(100, true, 0, 3);
  EXPECT_TRUE(contactEpisodes(trace.rows).empty());
}

TEST(TickClock, PercentilesAreNearestRankAndMissesAreThoseAboveThePeriod) {
  TickClock clock(1e-3);
  for (int i = 1; i <= 1000; ++i) clock.add(i);  // 1 to 1000 us: none above 1000
  clock.add(1001);
  const TickTimes times = clock.summary();
  EXPECT_EQ(times.count, 1001u);
  EXPECT_EQ(times.missed, 1u);
  // A histogram's percentiles are up to 1/64 too large, and never too small.
  const auto expectRank = [](double measured_us, double rank_us) {
    EXPECT_GE(measured_us, rank_us);
    EXPECT_LE(measured_us, rank_us * (1 + 1.0 / 64));
  };
  expectRank(times.p50_us, 501);  // ceil(0.5 * 1001) = 501st value
  expectRank(times.p99_us, 991);  // ceil(990.99)
  EXPECT_EQ(times.max_us, 1001);
  EXPECT_EQ(times.mean_us, 501);
}

TEST(TickClock, AnEmptyClockGivesZeros) {
  EXPECT_EQ(TickClock(1e-3).summary().count, 0u);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "contact_events.h"
#include "tick_times.h"

namespace vps {
namespace {

constexpr double kDt_s = 1e-3;

void feed(ContactEvents& events, double& time_s, int steps, bool is_touching, double speed_m_s) {
  for (int i = 0; i < steps; ++i) {
    time_s += kDt_s;
    events.add(time_s, kDt_s, is_touching, speed_m_s);
  }
}

TEST(ContactEvents, CountsFiveImpactsAndTwoSlidesAsFigure9Does) {
  ContactEvents events;
  double time_s = 0;
  for (int i = 0; i < 5; ++i) {
    feed(events, time_s, 5, true, 0.01);  // 5 ms, 50 um of slip: an impact
    feed(events, time_s, 100, false, 0.05);
  }
  for (int i = 0; i < 2; ++i) {
    feed(events, time_s, 300, true, 0.01);  // 300 ms, 3 mm: a slide
    feed(events, time_s, 100, false, 0.05);
  }
  events.close();
  EXPECT_EQ(events.impacts(), 5);
  EXPECT_EQ(events.slides(), 2);
}

TEST(ContactEvents, ChatterShorterThanTheBridgeIsOneImpact) {
  ContactEvents events;
  double time_s = 0;
  for (int i = 0; i < 4; ++i) {
    feed(events, time_s, 2, true, 0.001);
    feed(events, time_s, 10, false, 0.001);
  }
  events.close();
  EXPECT_EQ(events.impacts(), 1);
  EXPECT_EQ(events.slides(), 0);
}

TEST(TickClock, PercentilesAreNearestRankAndMissesAreThoseAboveThePeriod) {
  TickClock clock(1e-3);
  for (int i = 1; i <= 1000; ++i) clock.add(i);  // 1 to 1000 us: none above 1000
  clock.add(1001);
  const TickTimes times = clock.summary();
  EXPECT_EQ(times.count, 1001u);
  EXPECT_EQ(times.missed, 1u);
  EXPECT_EQ(times.p50_us, 501);  // ceil(0.5 * 1001) = 501st value
  EXPECT_EQ(times.p99_us, 991);  // ceil(990.99)
  EXPECT_EQ(times.max_us, 1001);
}

TEST(TickClock, EmptyClockSumsUpToZeros) {
  EXPECT_EQ(TickClock(1e-3).summary().count, 0u);
}

}  // namespace
}  // namespace vps

// SPDX-License-Identifier: BSD-3-Clause
// Offset and drift of another clock, tested with clocks of known offset and drift.
#include "link/clock_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vps::scenes {
namespace {

/// Another clock, and a network to it: each direction takes 20 us plus a random time.
class OtherClock {
 public:
  OtherClock(double offset_s, double drift, double greatest_wait_s)
      : offset_s_(offset_s), drift_(drift), wait_s_(0, greatest_wait_s) {}

  [[nodiscard]] double offsetAt_s(double here_s) const { return offset_s_ + drift_ * here_s; }
  ClockExchange exchange(double here_s) {
    constexpr double kLeast_s = 20e-6, kAnswer_s = 1e-3;
    const double t1_s = here_s + kLeast_s + wait_s_(random_), t2_s = t1_s + kAnswer_s,
                 t3_s = t2_s + kLeast_s + wait_s_(random_);
    return {ns(here_s), ns(t1_s + offsetAt_s(t1_s)), ns(t2_s + offsetAt_s(t2_s)), ns(t3_s)};
  }

 private:
  static std::int64_t ns(double s) { return std::llround(1e9 * s); }
  std::mt19937 random_{1};
  double offset_s_, drift_;
  std::uniform_real_distribution<double> wait_s_;
};

TEST(ClockEstimate, AnExchangeWithEqualWaysGivesTheOffsetItself) {
  const ClockExchange exchange{1'000'000, 3'000'500'000, 3'000'700'000, 2'200'000};
  // Each direction takes 500 us, so the other clock is 2.999 s ahead.
  EXPECT_DOUBLE_EQ(exchange.roundTrip_s(), 1e-3);
  EXPECT_DOUBLE_EQ(exchange.offset_s(), 2.999);
  ClockEstimate estimate;
  EXPECT_FALSE(estimate.isKnown());
  estimate.add(exchange);
  EXPECT_TRUE(estimate.isKnown());
  EXPECT_DOUBLE_EQ(estimate.offset_s(2'200'000), 2.999);
  EXPECT_DOUBLE_EQ(estimate.error_s(), 0.5e-3);
}

// Half of the round trip bounds the error of one exchange. The shortest of 50 exchanges in each quarter of a
// second is used; its random delays are about 20 us of at most 100. The error must be at most 50 us.
TEST(ClockEstimate, ThreeSecondsAndAHundredPartsInAMillionAreFoundWithinFiftyMicroseconds) {
  OtherClock other(3, 100e-6, 100e-6);
  ClockEstimate estimate;
  for (int i = 0; i < 4000; ++i) {
    const double here_s = 100 + 5e-3 * i;
    estimate.add(other.exchange(here_s));
    if (i < 800) continue;  // the first 4 s fill the history
    const double error_s = estimate.offset_s(std::llround(1e9 * here_s)) - other.offsetAt_s(here_s);
    ASSERT_LE(std::abs(error_s), 50e-6) << i;
    ASSERT_LE(std::abs(error_s), estimate.error_s()) << i;
  }
  // Offsets that are off by at most 50 us over 16 s give a drift error well below twice 50 us / 16 s (least
  // squares).
  EXPECT_NEAR(estimate.drift(), 100e-6, 25e-6);
  EXPECT_EQ(estimate.contradictions(), 0u);
}

// Two of three periods of 2 s are busy: each direction is delayed by up to 2 ms, so that the shortest of 50
// round trips is about 0.3 ms too long, in either direction.
TEST(ClockEstimate, StretchesOfABusyMachineDoNotSpoilIt) {
  OtherClock quiet(3, 100e-6, 60e-6), busy(3, 100e-6, 2e-3);
  ClockEstimate estimate;
  for (int i = 0; i < 12'000; ++i) {
    const double here_s = 100 + 5e-3 * i;
    const bool is_busy = i / 400 % 3 != 0;
    estimate.add((is_busy ? busy : quiet).exchange(here_s));
    if (i < 1200) continue;  // one quiet period and two busy ones
    const double error_s = estimate.offset_s(std::llround(1e9 * here_s)) - quiet.offsetAt_s(here_s);
    ASSERT_LE(std::abs(error_s), 50e-6) << here_s;
    ASSERT_LE(std::abs(error_s), estimate.error_s()) << here_s;
  }
}

TEST(ClockEstimate, APeerThatLiesAboutTimeIsNoticedAndNotBelieved) {
  OtherClock other(3, 0, 50e-6);
  ClockEstimate estimate;
  for (int i = 0; i < 200; ++i) estimate.add(other.exchange(5e-3 * i));
  ClockExchange lie = other.exchange(1.01);
  lie.t1_ns += 20'000'000;
  lie.t2_ns += 20'000'000;
  estimate.add(lie);
  ClockExchange impossible = other.exchange(1.02);  // received before it was sent
  impossible.t2_ns += 10'000'000;
  estimate.add(impossible);
  EXPECT_EQ(estimate.contradictions(), 2u);
  EXPECT_NEAR(estimate.offset_s(1'020'000'000), 3, 50e-6);
}

TEST(ClockEstimate, AClockThatWasSetIsFollowedAfterAWhile) {
  OtherClock before(3, 0, 50e-6), after(-1, 0, 50e-6);
  ClockEstimate estimate;
  for (int i = 0; i < 200; ++i) estimate.add(before.exchange(5e-3 * i));
  for (int i = 200; i < 260; ++i) estimate.add(after.exchange(5e-3 * i));
  EXPECT_GT(estimate.contradictions(), 10u);
  EXPECT_NEAR(estimate.offset_s(1'300'000'000), -1, 50e-6);
}

TEST(ClockEstimate, ATimeOfSendingIsGivenByTheClockHereHoweverFarTheClocksAreApart) {
  constexpr std::int64_t kNow_ns = 90'000'000'000'000,
                         kAgo_ns = 40'000'000;  // a day after boot; sent 40 ms ago
  for (const double ahead_s : {0.0, 3.0, -3.0, 40'000.0, -80'000.0, 1e9}) {
    const auto there_ns = static_cast<std::int64_t>(kNow_ns - kAgo_ns + 1e9 * ahead_s);
    // A double represents 1e18 ns with a precision of 128 ns.
    EXPECT_NEAR(static_cast<double>(kNow_ns - sentByClockHere_ns(there_ns, ahead_s, kNow_ns)), kAgo_ns, 300);
    // A compact message has only the lower bits of the microseconds, so any number of wraps may be missing.
    const std::int64_t wraps_ns = 5 * (std::int64_t{1} << 32U) * 1000;
    EXPECT_NEAR(static_cast<double>(kNow_ns - sentByClockHere_ns(there_ns + wraps_ns, ahead_s, kNow_ns)),
                kAgo_ns, 300);
  }
  EXPECT_EQ(sentByClockHere_ns(kNow_ns + 1000, 0, kNow_ns), kNow_ns)
      << "a message cannot arrive before it is sent";
}

}  // namespace
}  // namespace vps::scenes

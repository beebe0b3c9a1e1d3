// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/metronome.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/device/fake_device.h"

namespace vps::device {
namespace {

using test::FakeClock;

constexpr std::int64_t kPeriod_ns = 1000;

TEST(Metronome, BeatsAtMultiplesOfThePeriodHoweverLongTheWorkTakes) {
  FakeClock clock(5'000'000);
  Metronome metronome(kPeriod_ns, clock);
  metronome.start();
  for (int i = 1; i <= 1000; ++i) {
    const Beat beat = metronome.wait();
    EXPECT_EQ(beat.due_ns, 5'000'000 + i * kPeriod_ns) << "no drift";
    EXPECT_EQ(beat.woke_ns, beat.due_ns);
    EXPECT_EQ(beat.periods, 1);
    clock.now += i % 7 * 150;  // the work takes at most 900 ns of the period of 1000 ns
  }
}

TEST(Metronome, AfterAMissedPeriodContinuesAtTheNextBoundaryWithoutBursts) {
  FakeClock clock;
  Metronome metronome(kPeriod_ns, clock);
  metronome.start();
  metronome.wait();  // 1000
  clock.now += 3500;
  Beat beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 5000);
  EXPECT_EQ(beat.woke_ns, 5000);
  EXPECT_EQ(beat.periods, 4);
  EXPECT_EQ(beat.missed_before, 3);
  EXPECT_EQ(beat.missed_asleep, 0);
  beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 6000);
  EXPECT_EQ(beat.periods, 1);
  clock.now += 1000;  // work that ends exactly at the boundary is in time
  EXPECT_EQ(metronome.wait().due_ns, 7000);
}

// The beats are up to 3500 ns late, and each further beat, with 200 ns of work, makes up for 800 ns.
TEST(Metronome, LateBeatsFollowAtOnceUntilTheClockIsReached) {
  FakeClock clock;
  Metronome metronome(kPeriod_ns, clock, 20 * kPeriod_ns);
  metronome.start();
  metronome.wait();  // 1000
  clock.now += 4500;
  for (int i = 0; i < 5; ++i) {
    const Beat beat = metronome.wait();
    EXPECT_EQ(beat.due_ns, 2000 + i * kPeriod_ns);
    EXPECT_EQ(beat.woke_ns, std::max(beat.due_ns, std::int64_t{5500} + i * 200)) << "not before it is due";
    EXPECT_EQ(beat.periods, 1);
    clock.now += 200;
  }
}

TEST(Metronome, BeatsBeyondTheLimitAreMissedAndTheRestIsMadeUpFor) {
  FakeClock clock;
  Metronome metronome(kPeriod_ns, clock, 2 * kPeriod_ns);
  metronome.start();
  metronome.wait();  // 1000
  clock.now += 7500;
  Beat beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 7000) << "1500 ns late; the previous beat would be 2500 ns late";
  EXPECT_EQ(beat.missed_before, 5);
  EXPECT_EQ(beat.periods, 6);
  beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 8000);
  EXPECT_EQ(beat.woke_ns, 8500);
  EXPECT_EQ(beat.periods, 1);
  EXPECT_EQ(metronome.wait().woke_ns, 9000) << "the clock is reached";
}

TEST(Metronome, ALateWakeUpIsReportedAndBoundariesAreKept) {
  FakeClock clock;
  Metronome metronome(kPeriod_ns, clock);
  metronome.start();
  clock.oversleep = 400;
  Beat beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 1000);
  EXPECT_EQ(beat.woke_ns, 1400);
  EXPECT_EQ(beat.periods, 1);
  clock.oversleep = 2300;
  beat = metronome.wait();
  EXPECT_EQ(beat.due_ns, 4000);
  EXPECT_EQ(beat.woke_ns, 4300);
  EXPECT_EQ(beat.missed_asleep, 2);
  EXPECT_EQ(beat.missed_before, 0);
  EXPECT_EQ(beat.periods, 3);
  clock.oversleep = 0;
  EXPECT_EQ(metronome.wait().due_ns, 5000);
}

TEST(Metronome, AClockThatGoesBackwardsIsReportedAndBeatsContinue) {
  FakeClock clock(1'000'000'000);
  Metronome metronome(kPeriod_ns, clock);
  metronome.start();
  EXPECT_FALSE(metronome.wait().has_clock_gone_back);
  clock.now = 500;
  Beat beat = metronome.wait();
  EXPECT_TRUE(beat.has_clock_gone_back);
  EXPECT_EQ(beat.due_ns, 1500) << "a period from the new time, not a second from it";
  EXPECT_EQ(beat.periods, 1);
  clock.oversleep = -1200;  // the clock goes back during the sleep
  beat = metronome.wait();
  EXPECT_TRUE(beat.has_clock_gone_back);
  EXPECT_EQ(beat.periods, 1);
  clock.oversleep = 0;
  EXPECT_FALSE(metronome.wait().has_clock_gone_back);
}

TEST(Metronome, TheSystemsClockNeverWakesEarly) {
  Metronome metronome(200'000, monotonicClock());
  metronome.start();
  std::int64_t due_ns = 0;
  for (int i = 0; i < 50; ++i) {
    const Beat beat = metronome.wait();
    EXPECT_GE(beat.woke_ns, beat.due_ns);
    EXPECT_LT(beat.woke_ns, beat.due_ns + metronome.period_ns());
    if (i > 0) {
      EXPECT_EQ(beat.due_ns - due_ns, beat.periods * metronome.period_ns());
    }
    due_ns = beat.due_ns;
  }
}

}  // namespace
}  // namespace vps::device

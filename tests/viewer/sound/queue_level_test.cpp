// SPDX-License-Identifier: BSD-3-Clause
// The length of the sound queue, with a simulated card and a writing thread in simulated time.
#include "sound/queue_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vps::viewer {
namespace {

constexpr int kQueueRate_hz = 48000;
constexpr std::size_t kPeriod = 64, kBlock = 48;  // samples of the card's period, and of a step of 1 ms
constexpr double kPeriod_s = double{kPeriod} / kQueueRate_hz, kSpare_s = 1.25e-3;

/// A card that takes a period at a time, and a thread that writes samples.
class Simulated {
 public:
  explicit Simulated(double phase_s = 0) : next_pull_s_(phase_s) {}

  /// Writes samples at a time. The last sample is heard after wait_s().
  void write(double time_s, std::size_t count, float peak = 0) {
    pullUntil(time_s);
    const QueuePlan plan = level_.plan(is_playing_, waiting_, count, peak, time_s);
    EXPECT_LE(plan.dropped, count);
    EXPECT_TRUE(!is_playing_ || plan.silence == 0);
    waiting_ += plan.silence + count - plan.dropped;
    dropped_ += plan.dropped;
    is_playing_ = true;
    time_s_ = time_s;
  }
  /// The card takes nothing for a while.
  void stall(double time_s) { next_pull_s_ += time_s; }
  /// Time until the last written sample is mixed, if no more samples are written.
  [[nodiscard]] double wait_s() const {
    return next_pull_s_ - time_s_ + kPeriod_s * std::ceil(double(waiting_) / kPeriod - 1);
  }
  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  [[nodiscard]] std::size_t gaps() const { return level_.gaps(); }

 private:
  void pullUntil(double time_s) {
    for (; next_pull_s_ <= time_s; next_pull_s_ += kPeriod_s) {
      if (!is_playing_) continue;
      if (waiting_ <= kPeriod) is_playing_ = false;  // OpenAL's source stops at its end
      waiting_ -= std::min(waiting_, kPeriod);
    }
  }
  QueueLevel level_{kQueueRate_hz, kPeriod_s};
  double next_pull_s_, time_s_ = 0;
  bool is_playing_ = false;
  std::size_t waiting_ = 0, dropped_ = 0;
};

TEST(QueueLevel, APunctualThreadKeepsLittleWaitingAndHasNoGap) {
  for (const double phase_s : {0.1e-3, 0.6e-3, 1.2e-3}) {
    Simulated card(phase_s);
    std::size_t most = 0;
    for (int i = 0; i < 10000; ++i) {
      card.write(1e-3 * i, kBlock, 0.5F);
      most = std::max(most, card.waiting());
    }
    EXPECT_EQ(card.gaps(), 0U);
    EXPECT_LE(card.dropped(), kPeriod) << "at the start, when the card's first period was late";
    // The bound is the reserve, two periods (the card may take the first just before or after the start), and
    // a block.
    EXPECT_LE(most, std::size_t(kSpare_s * kQueueRate_hz) + 2 * kPeriod + kBlock);
  }
}

TEST(QueueLevel, WhatIsNotNeededIsDroppedWhereNobodyHearsIt) {
  Simulated loud, quiet;
  // A thread is late once by 8 ms and punctual afterwards: there is a gap, and then more samples wait than
  // needed.
  for (Simulated* card : {&loud, &quiet})
    for (int i = 0, late = 0; i < 20000; ++i) {
      if (i >= 2000 && i < 2008) {
        ++late;
        continue;
      }
      card->write(1e-3 * i, kBlock * std::size_t(1 + std::exchange(late, 0)), card == &loud ? 0.5F : 1e-4F);
    }
  EXPECT_EQ(loud.gaps(), 1U);
  EXPECT_EQ(quiet.gaps(), 1U);
  EXPECT_GT(quiet.dropped(), 0U);
  // The bound is the reserve with half of its growth, and the 0.25 ms that are too short to drop.
  const auto bound = std::size_t((kSpare_s + 0.625e-3 + 0.25e-3) * kQueueRate_hz) + kPeriod + kBlock;
  EXPECT_LE(quiet.waiting(), bound);
  EXPECT_LT(quiet.waiting(), loud.waiting());
}

TEST(QueueLevel, AThreadThatIsOftenLateHasFewGaps) {
  // A thread is late by 4 ms five times a second, for 20 s. Without memory there would be 100 gaps.
  Simulated card;
  int late = 0;
  for (int i = 0; i < 20000; ++i) {
    if (i % 200 >= 100 && i % 200 < 104) {
      ++late;
      continue;
    }
    card.write(1e-3 * i, kBlock * std::size_t(1 + std::exchange(late, 0)));
  }
  // There are five gaps in the first second, in which gaps do not count. After the first second each gap
  // makes the reserve 1.25 ms longer, and once or twice it has shrunk too far.
  EXPECT_GE(card.gaps(), 1U);
  EXPECT_LE(card.gaps(), 10U);
}

TEST(QueueLevel, LongBlocksAreNotTakenForLateOnes) {
  Simulated card;  // blocks of 10 ms, as a watcher of a session writes them
  for (int i = 0; i < 1000; ++i) card.write(10e-3 * i, 480, 0.5F);
  EXPECT_LE(card.dropped(), kPeriod) << "at the start, when the card's first period was late";
  EXPECT_EQ(card.gaps(), 0U);
}

TEST(QueueLevel, OfABurstTheNewestAreHeard) {
  Simulated card;
  for (int i = 0; i < 1000; ++i) card.write(1e-3 * i, kBlock, 0.5F);
  card.write(0.9995, 12000, 0.5F);  // 0.25 s of samples at once
  EXPECT_LE(card.waiting(), std::size_t(kSpare_s * kQueueRate_hz) + 2 * kPeriod + 2 * kBlock);
  EXPECT_LT(card.wait_s(), 6e-3);
}

TEST(QueueLevel, AMixerThatWasLateDelaysNothingForLong) {
  Simulated card;
  for (int i = 0; i < 1000; ++i) card.write(1e-3 * i, kBlock, 0.5F);
  card.stall(10e-3);
  for (int i = 1000; i < 1100; ++i) card.write(1e-3 * i, kBlock, 0.5F);
  EXPECT_LE(card.waiting(), std::size_t(kSpare_s * kQueueRate_hz) + 2 * kPeriod + 2 * kBlock);
}

TEST(QueueLevel, ACardThatTakesNothingForSecondsIsNotHeardSecondsLater) {
  Simulated card;
  for (int i = 0; i < 1000; ++i) card.write(1e-3 * i, kBlock, 0.5F);
  card.stall(5);
  for (int i = 1000; i < 6000; ++i) card.write(1e-3 * i, kBlock, 0.5F);
  constexpr double kMost_s = 10e-3 + 10e-3;  // the greatest reserve, and the greatest block
  EXPECT_LE(card.waiting(), std::size_t(kMost_s * kQueueRate_hz) + 2 * kPeriod + 3 * kBlock);
}

TEST(QueueLevel, ACutHasNoStep) {
  std::vector<float> wave(96);
  for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = std::sin(0.05F * static_cast<float>(i));
  EXPECT_EQ(shortened(wave, 0), wave);
  EXPECT_TRUE(shortened(wave, 96).empty());
  EXPECT_TRUE(shortened(wave, 1000).empty());
  const std::vector<float> rest = shortened(wave, 40);
  ASSERT_EQ(rest.size(), 56U);
  // Between two samples the wave changes by at most 0.05, and the fade by 1/56 of the difference of both
  // waves, which is at most 2.
  for (std::size_t i = 1; i < rest.size(); ++i) EXPECT_LT(std::abs(rest[i] - rest[i - 1]), 0.05F + 2.0F / 56);
  EXPECT_NEAR(rest.front(), wave.front(), 0.05F + 2.0F / 56);
  EXPECT_EQ(rest.back(), wave.back());
}

TEST(QueueLevel, APauseIsNoGap) {
  Simulated card;
  for (int i = 0; i < 100; ++i) card.write(1e-3 * i, kBlock);
  for (int i = 0; i < 100; ++i) card.write(1 + 1e-3 * i, kBlock);
  EXPECT_EQ(card.gaps(), 0U);
}

}  // namespace
}  // namespace vps::viewer

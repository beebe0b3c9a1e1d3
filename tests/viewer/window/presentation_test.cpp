// SPDX-License-Identifier: BSD-3-Clause
// All watchers show a snapshot at the same instant, however different the delays of their connections are.
#include "run/presentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

namespace vps::viewer {
namespace {

constexpr std::int64_t kMs = 1'000'000;

scenes::Snapshot shotOf(int step) {
  scenes::Snapshot shot;
  shot.step = step;
  return shot;
}

std::vector<int> dueAt(Presentation& presentation, std::int64_t now_ns) {
  std::vector<int> steps;
  presentation.take(now_ns, [&](const scenes::Snapshot& shot, std::int64_t) { steps.push_back(shot.step); });
  return steps;
}

TEST(Presentation, ASnapshotIsDueAFixedTimeAfterItWasTakenWheneverItCame) {
  Presentation presentation(50 * kMs);
  presentation.add(shotOf(1), 100 * kMs, 101 * kMs);
  presentation.add(shotOf(2), 117 * kMs, 140 * kMs);
  EXPECT_EQ(dueAt(presentation, 150 * kMs - 1), std::vector<int>{});
  EXPECT_EQ(dueAt(presentation, 150 * kMs), std::vector<int>{1});
  EXPECT_EQ(dueAt(presentation, 167 * kMs), std::vector<int>{2});
  EXPECT_EQ(presentation.late(), 0u);
}

TEST(Presentation, OneThatComesLateIsShownAtOnceAndCounted) {
  Presentation presentation(50 * kMs);
  presentation.add(shotOf(1), 100 * kMs, 151 * kMs);
  EXPECT_EQ(presentation.late(), 1u);
  EXPECT_EQ(dueAt(presentation, 151 * kMs), std::vector<int>{1});
}

// A clock that is an hour ahead delays no snapshot and lets no queue grow.
TEST(Presentation, TimesThatCannotBeHoldNothingUp) {
  Presentation presentation(50 * kMs);
  presentation.add(shotOf(1), 3'600'000 * kMs, 100 * kMs);
  presentation.add(shotOf(2), 20 * kMs, 110 * kMs);
  EXPECT_EQ(dueAt(presentation, 150 * kMs), (std::vector<int>{1, 2}));
  for (int i = 0; i < 1000; ++i) presentation.add(shotOf(i), 200 * kMs, 200 * kMs);
  EXPECT_EQ(dueAt(presentation, 1000 * kMs).size(), 64u);
}

/// The time at which a watcher shows each snapshot. Snapshots arrive with random delays, and the watcher
/// polls at equal intervals.
std::map<int, std::int64_t> shownBy(std::int64_t after_ns, std::int64_t look_ns, std::int64_t least_way_ns,
                                    std::int64_t most_way_ns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> way_ns(least_way_ns, most_way_ns);
  std::map<std::int64_t, int> comes;  // snapshots by time of arrival; the newest one counts
  for (int i = 0; i < 600; ++i) comes[(i * 50 * kMs) / 3 + way_ns(random)] = i;
  Presentation presentation(after_ns);
  std::map<int, std::int64_t> shown;
  int newest = -1;
  auto next = comes.begin();
  for (std::int64_t now_ns = 0; now_ns < 11'000 * kMs; now_ns += look_ns) {
    for (; next != comes.end() && next->first <= now_ns; ++next)
      if (next->second > newest) {
        newest = next->second;
        presentation.add(shotOf(newest), (newest * 50 * kMs) / 3, now_ns);
      }
    for (const int step : dueAt(presentation, now_ns)) shown[step] = now_ns;
  }
  return shown;
}

/// The greatest difference between the times at which two watchers show the same snapshot.
std::int64_t apart(const std::map<int, std::int64_t>& a, const std::map<int, std::int64_t>& b) {
  std::int64_t most_ns = 0;
  for (const auto& [step, at_ns] : a)
    if (const auto found = b.find(step); found != b.end())
      most_ns = std::max(most_ns, std::abs(found->second - at_ns));
  return most_ns;
}

// One watcher on the same machine polls 60 times a second; the other, with a delay of 20 ms and a jitter of 5
// ms, polls 50 times. The times of both watchers differ by the polling only, so by no more than the longer
// polling period.
TEST(Presentation, TwoWatchersAreApartByNoMoreThanTheirLooks) {
  const std::int64_t after_ns = kPresentAfter_ns;
  EXPECT_LE(apart(shownBy(after_ns, 16 * kMs, 0, kMs, 1), shownBy(after_ns, 20 * kMs, 20 * kMs, 25 * kMs, 2)),
            20 * kMs);
  EXPECT_GT(apart(shownBy(0, 16 * kMs, 0, kMs, 1), shownBy(0, 20 * kMs, 20 * kMs, 25 * kMs, 2)), 35 * kMs);
}

}  // namespace
}  // namespace vps::viewer

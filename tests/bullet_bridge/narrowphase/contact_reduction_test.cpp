// SPDX-License-Identifier: BSD-3-Clause
// Reduction of thousands of near points to the few contacts of the solver: properties that must be
// preserved.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

constexpr double kSide_m = 20e-3, kPatchMargin_m = 20e-6;
constexpr std::size_t kLimit = 32;

// Points of a square patch that lie up to 10 um above a plane; every tenth one faces down.
std::vector<Candidate> patch(std::uint64_t seed, bool has_two_sides) {
  test::Random random(seed);
  std::vector<Candidate> candidates(3000);
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    Candidate& c = candidates[i];
    c.id = i;
    c.n_W = Vec3(0, 0, has_two_sides && i % 10 == 0 ? -1 : 1);
    c.p_W = random.inBox(Vec3(0.5 * kSide_m, 0.5 * kSide_m, 0)) +
            (c.n_W.z() < 0 ? Vec3(0, 0, 5e-3) : Vec3(0, 0, 0));
    c.distance_m = c.predicted_m = random.uniform(0, 10e-6);
    c.area_m2 = 1e-6;
  }
  return candidates;
}

const Candidate& deepestOf(const std::vector<Candidate>& candidates, double side) {
  return *std::min_element(candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
    const bool is_a = a.n_W.z() * side > 0, is_b = b.n_W.z() * side > 0;
    return is_a != is_b ? is_a : a.distance_m < b.distance_m;
  });
}

bool contains(const std::vector<Candidate>& candidates, const Candidate& wanted) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](const Candidate& c) { return c.key() == wanted.key(); });
}

std::vector<Candidate> bySpread(std::vector<Candidate> candidates) {
  reduceBySpread(candidates, kLimit, kSide_m, kPatchMargin_m);
  return candidates;
}
std::vector<Candidate> byCell(std::vector<Candidate> candidates) {
  reduceByCell(candidates, 10 * kLimit, kSide_m / 16, kSide_m);
  return candidates;
}

TEST(ContactReduction, KeepsTheDeepestPointOfEachDirection) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Candidate> all = patch(seed, true);
    for (const double side : {1.0, -1.0}) EXPECT_TRUE(contains(byCell(all), deepestOf(all, side))) << seed;
    EXPECT_TRUE(contains(bySpread(all), deepestOf(all, 0))) << seed;
    const std::vector<Candidate> few = bySpread(all);
    for (const double side : {1.0, -1.0})
      EXPECT_TRUE(
          std::any_of(few.begin(), few.end(), [&](const Candidate& c) { return c.n_W.z() * side > 0; }));
  }
}

TEST(ContactReduction, KeepsNoMoreThanTheLimitAndAscendingKeys) {
  const std::vector<Candidate> few = bySpread(patch(1, true));
  EXPECT_EQ(few.size(), kLimit);
  EXPECT_TRUE(std::is_sorted(few.begin(), few.end(),
                             [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); }));
}

// The kept points support the part as all points do: no point is farther from its nearest kept point than
// with 32 evenly spread points.
TEST(ContactReduction, KeepsTheExtentOfThePatch) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Candidate> all = patch(seed, false), few = bySpread(all);
    const double room_m = kSide_m / std::sqrt(double(kLimit));
    for (const Candidate& c : all) {
      double nearest_m = 1e300;
      for (const Candidate& kept : few) nearest_m = std::min(nearest_m, (c.p_W - kept.p_W).norm());
      EXPECT_LE(nearest_m, 1.5 * room_m) << seed;
    }
  }
}

TEST(ContactReduction, DoesNotDependOnTheOrderOfThePoints) {
  std::vector<Candidate> all = patch(3, true);
  const std::vector<Candidate> cells = byCell(all), few = bySpread(cells);
  std::reverse(all.begin(), all.end());
  const std::vector<Candidate> again = bySpread(byCell(all));
  ASSERT_EQ(again.size(), few.size());
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(again[i].key(), few[i].key());
}

// A set that flickers from step to step would lose the impulses of the last step.
TEST(ContactReduction, PrefersTheContactsOfTheLastStepAmongEquals) {
  std::vector<Candidate> all = patch(4, false);
  for (Candidate& c : all) c.distance_m = c.predicted_m = 0;
  const std::vector<Candidate> first = bySpread(byCell(all));
  for (Candidate& c : all) c.was_contact = contains(first, c);
  std::size_t kept = 0;
  for (const Candidate& c : bySpread(byCell(all))) kept += contains(first, c);
  EXPECT_EQ(kept, first.size());
}

}  // namespace
}  // namespace vps::bullet

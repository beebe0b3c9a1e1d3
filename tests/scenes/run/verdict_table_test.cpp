// SPDX-License-Identifier: BSD-3-Clause
// Verdict, reason and exit status for each kind of evidence: one case in each row, on both sides of each
// limit.
#include "support/units.h"
#include "vps_scenes/run/verdict.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "vps_scenes/run/result.h"

namespace vps::scenes {
namespace {

struct VerdictCase {
  const char* name;
  Evidence evidence;
  Verdict verdict;
  std::string reason;
  int exit_status;
};

std::vector<VerdictCase> cases() {
  const double most_drift_m = kRestDriftLimit_m, more_drift_m = std::nextafter(kRestDriftLimit_m, 1);
  return {
      {"NothingAgainstIt", {}, Verdict::Fits, "", 0},
      {"Overlap",
       {.blocked = overlapReason("plate", 30 * kUm, 1 * kUm, Vec3(0.001, 0, 0))},
       Verdict::Blocked,
       "as drawn, the part overlaps 'plate' by 30.0 um (error 1.0 um) at (1.00, 0.00, 0.00) mm",
       1},
      {"ClosedRoomAtTheStart",
       {.blocked = closedRoomReason("box", true)},
       Verdict::Blocked,
       "the part starts in a cavity of 'box' that has no opening",
       1},
      {"ClosedRoomAtTheTarget",
       {.blocked = closedRoomReason("box", false)},
       Verdict::Blocked,
       "the part's target is in a cavity of 'box' that has no opening",
       1},
      {"ProofCountsMoreThanARunThatSucceeded",
       {.blocked = "proof", .is_in_place = true},
       Verdict::Blocked,
       "proof",
       1},
      {"ProofCountsMoreThanAFailure",
       {.blocked = "proof", .is_in_place = false, .failure = "stuck"},
       Verdict::Blocked,
       "proof",
       1},
      {"NotInPlace", {.is_in_place = false, .failure = "stuck"}, Verdict::NotShown, "stuck", 3},
      {"FailureCountsMoreThanDepth",
       {.is_in_place = false, .failure = "stuck", .depth_m = 1},
       Verdict::NotShown,
       "stuck",
       3},
      {"AsDeepAsAllowed", {.depth_m = 10 * kUm, .depth_limit_m = 10 * kUm}, Verdict::Fits, "", 0},
      {"JustTooDeep",
       {.depth_m = std::nextafter(10 * kUm, 1), .depth_limit_m = 10 * kUm, .deepest_against = "plate"},
       Verdict::NotShown,
       "on its path the part was 10.0 um deep inside 'plate', more than the 10.0 um that count as contact",
       3},
      {"DepthThatIsNoNumber",
       {.depth_m = std::numeric_limits<double>::quiet_NaN(), .depth_limit_m = 10 * kUm},
       Verdict::NotShown,
       "?",
       3},
      {"AtRest", {.rest_drift_m = 1, .late_drift_m = most_drift_m}, Verdict::Fits, "", 0},
      {"JustNotAtRest",
       {.rest_drift_m = 100 * kUm, .late_drift_m = more_drift_m},
       Verdict::NotShown,
       std::string("the part moved by 100.0 um after its release: ") + kHoldsRemedy,
       3},
      {"DepthCountsMoreThanDrift",
       {.depth_m = 20 * kUm, .depth_limit_m = 10 * kUm, .deepest_against = "plate", .late_drift_m = 1},
       Verdict::NotShown,
       "on its path the part was 20.0 um deep inside 'plate', more than the 10.0 um that count as contact",
       3},
      {"AsMuchForceAsNeeded", {.press_needed_N = 60, .hand_N = 60}, Verdict::Fits, "", 0},
      {"PressIn",
       {.press_needed_N = 61, .hand_N = 60},
       Verdict::NotShown,
       "the path is free, but pressing the part in takes about 61 N (by the formula for its declared "
       "interference), "
       "and "
       "the hand has 60 N ([operator] force_limit_N); use a press",
       3},
      {"PressOut",
       {.press_needed_N = 61, .hand_N = 60, .is_taken_off = true},
       Verdict::NotShown,
       "the path is free, but pressing the part out takes about 61 N (by the formula for its declared "
       "interference), and "
       "the hand has 60 N ([operator] force_limit_N); use a press",
       3},
      {"Doubt",
       {.doubt = "the mesh is coarse"},
       Verdict::NotShown,
       "the hand brought the part to its target, but the mesh is coarse",
       3},
      {"PressCountsMoreThanDoubt",
       {.press_needed_N = 61, .hand_N = 60, .doubt = "the mesh is coarse"},
       Verdict::NotShown,
       "?",
       3},
  };
}

class VerdictTable : public testing::TestWithParam<VerdictCase> {};

TEST_P(VerdictTable, GivesVerdictReasonAndExitStatus) {
  const Judgement judged = judge(GetParam().evidence);
  EXPECT_EQ(toText(judged.verdict), std::string(toText(GetParam().verdict)));
  EXPECT_EQ(exitStatusOf(judged.verdict), GetParam().exit_status);
  EXPECT_EQ(isGood(judged.verdict), judged.reason.empty());
  if (GetParam().reason != "?") {
    EXPECT_EQ(judged.reason, GetParam().reason);
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, VerdictTable, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Verdicts, HaveARowEachInTheOrderOfTheEnumeration) {
  for (std::size_t i = 0; i < kVerdicts.size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(kVerdicts[i].verdict), i);
  EXPECT_STREQ(rowOf(Verdict::Fits).words, "fits");
  EXPECT_STREQ(rowOf(Verdict::Blocked).words, "blocked");
  EXPECT_STREQ(rowOf(Verdict::NotShown).words, "not shown");
}

TEST(Verdicts, BlockedIsWorseThanNotShownAndNotShownIsWorseThanFits) {
  using enum Verdict;
  const std::vector<std::array<Verdict, 3>> rows{{Fits, Fits, Fits},           {Fits, NotShown, NotShown},
                                                 {Fits, Blocked, Blocked},     {NotShown, NotShown, NotShown},
                                                 {NotShown, Blocked, Blocked}, {Blocked, Blocked, Blocked}};
  for (const auto& [a, b, worst] : rows) {
    EXPECT_EQ(worse(a, b), worst);
    EXPECT_EQ(worse(b, a), worst);
  }
}

/// One row: the verdicts of the steps that were run, the number of planned steps, and the verdict of the run.
struct RunCase {
  std::vector<Verdict> steps;
  std::size_t planned;
  Verdict verdict;
};

TEST(Verdicts, ARunIsAsGoodAsItsWorstStepAndNotShownIfAStepIsMissing) {
  using enum Verdict;
  const std::vector<RunCase> rows{{{Fits, Fits}, 2, Fits},
                                  {{Fits, NotShown}, 2, NotShown},
                                  {{NotShown, Blocked}, 2, Blocked},
                                  {{Blocked, Fits}, 2, Blocked},
                                  {{Fits}, 2, NotShown},
                                  {{Blocked}, 2, Blocked},
                                  {{}, 1, NotShown}};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    std::vector<StepResult> steps(rows[row].steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i].verdict = rows[row].steps[i];
    EXPECT_EQ(verdictOf(steps, rows[row].planned), rows[row].verdict) << "row " << row;
  }
}

TEST(Verdicts, AMotionWithinThePlayIsRest) {
  StepResult step;
  step.completed = true;
  step.late_drift_m = 2 * kRestDriftLimit_m;
  EXPECT_FALSE(isAtRest(step));
  EXPECT_EQ(judge(evidenceOf(step, 60)).verdict, Verdict::NotShown);
  step.moves_in_play = true;
  EXPECT_TRUE(isAtRest(step));
  EXPECT_EQ(judge(evidenceOf(step, 60)).verdict, Verdict::Fits);
}

TEST(Verdicts, AStepsResultIsItsEvidence) {
  StepResult step;
  step.completed = false;
  step.failure_reason = "stuck";
  EXPECT_EQ(judge(evidenceOf(step, 60)).reason, "stuck");
  step.completed = true;
  step.penetration_limit_m = 10 * kUm;
  EXPECT_EQ(judge(evidenceOf(step, 60)).verdict, Verdict::Fits);
  step.max_penetration_m = 11 * kUm;
  EXPECT_FALSE(isWithinLimit(step));
  EXPECT_NE(judge(evidenceOf(step, 60)).reason.find("deep inside"), std::string::npos);
  step.max_penetration_m = 0;
  step.late_drift_m = 2 * kRestDriftLimit_m;
  EXPECT_FALSE(isAtRest(step));
  EXPECT_NE(judge(evidenceOf(step, 60)).reason.find("release"), std::string::npos);
  step.late_drift_m = 0;
  step.press_needed_N = 100;
  EXPECT_NE(judge(evidenceOf(step, 60)).reason.find("a press"), std::string::npos);
  EXPECT_EQ(judge(evidenceOf(step, 100)).verdict, Verdict::Fits);
  step.mesh_doubt = "coarse";
  EXPECT_NE(judge(evidenceOf(step, 100)).reason.find("coarse"), std::string::npos);
  step.blocked_by = "plate";
  step.reason = "proof";
  EXPECT_EQ(judge(evidenceOf(step, 100)).verdict, Verdict::Blocked);
  EXPECT_EQ(judge(evidenceOf(step, 100)).reason, "proof");
}

// Only a group that contains the part proves that the part is blocked.
TEST(Verdicts, OfAnOverlapIsThatOfTheGroupThatContainsThePart) {
  CheckedPlaces places;
  EXPECT_EQ(judgeOverlap(places, "pin").verdict, Verdict::Fits);
  places.verdict = Verdict::Blocked;
  places.reason = "the key is too wide";
  places.groups = {{{"key", "slot"}, Verdict::Blocked, "the key is too wide"},
                   {{"hole", "pin"}, Verdict::NotShown, "no places were found"}};
  EXPECT_EQ(judgeOverlap(places, "key").verdict, Verdict::Blocked);
  EXPECT_EQ(judgeOverlap(places, "key").reason, "the key is too wide");
  EXPECT_EQ(judgeOverlap(places, "pin").verdict, Verdict::NotShown);
}

}  // namespace
}  // namespace vps::scenes

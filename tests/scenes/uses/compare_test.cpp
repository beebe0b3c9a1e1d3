// SPDX-License-Identifier: BSD-3-Clause
// Runs of a trainee whose detour, force and time are known by construction.
#include "vps_scenes/uses/compare.h"
#include "support/units.h"

#include <gtest/gtest.h>

#include "record/run_record.h"
#include "record/scene_archive.h"
#include "scenes/peg_in_cup.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_device/operator.h"

namespace vps::scenes {
namespace {

/// A run along a straight path of 100 mm along x, in pieces of 1 mm.
struct Made {
  double duration_s = 2;
  double force_N = 2;
  double peak_N = 4;    ///< force in the middle of the path
  double detour_m = 0;  ///< height of the path between 30 and 70 mm above the straight path
  double turn_rad = 0;  ///< rotation about z in the middle of the path
  bool is_done = true;
  double shift_m = 0;  ///< displacement of the whole path along y
};

device::RunTrace rowAt(double time_s, const Vec3& p, double force_N, const Vec3& com_P) {
  device::RunTrace row;
  row.time_s = time_s;
  row.step = 0;
  row.X_WP.p = p - com_P;
  row.F_hand_W.f = Vec3(0, 0, -force_N);
  return row;
}

class Compare : public ::testing::Test {
 protected:
  device::RecordedRun record(const Made& made, const std::string& name, double peg_m = 4e-3) {
    PegInCup shape;
    shape.peg_m = peg_m;
    const Scene scene = pegInCup(shape);
    const Vec3 com_P = massProperties(scene.parts[1].part.mesh).com;
    device::RecordingHead head;
    head.device = "made up";
    head.attachments = {{kSceneAttachment, "application/octet-stream", sceneToBytes(scene)}};
    head.about["mesh_hash.peg"] = contentHash(scene.parts[1].part.mesh);
    const std::string file = (folder_.path() / name).string();
    device::Recorder recorder(file, head);
    constexpr double kBegun_s = 5;  // start of the step in the run; a step's times count from here
    device::RunEvent take;
    take.kind = device::RunEventKind::Take;
    take.step = 0;
    take.time_s = kBegun_s;
    recorder.add(take);
    std::vector<Vec3> way;
    const auto go = [&](int from, int to, double z_m) {
      for (int x = from; x <= to; ++x) way.emplace_back(x * kMm, made.shift_m, z_m);
    };
    go(0, 30, 0);
    for (double z_m = kMm; z_m < made.detour_m; z_m += kMm) way.emplace_back(30 * kMm, made.shift_m, z_m);
    go(30, 70, made.detour_m);
    for (double z_m = made.detour_m - kMm; z_m > 0; z_m -= kMm) way.emplace_back(70 * kMm, made.shift_m, z_m);
    go(70, 100, 0);
    for (std::size_t i = 0; i < way.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(way.size() - 1);
      const bool is_middle = i == way.size() / 2;
      device::RunTrace row =
          rowAt(kBegun_s + share * made.duration_s, way[i], is_middle ? made.peak_N : made.force_N, com_P);
      if (is_middle && made.turn_rad != 0) {
        row.X_WP.R = rotationFromVector(Vec3(0, 0, made.turn_rad));
        row.X_WP.p = way[i] - row.X_WP.R * com_P;
      }
      recorder.add(row);
    }
    if (made.is_done) {
      device::RunEvent done = take;
      done.kind = device::RunEventKind::Phase;
      done.phase = device::toByte({device::OperatorPhase::Done, {}});
      recorder.add(done);
    }
    device::RunTrace rest = rowAt(kBegun_s + made.duration_s + 1, {0, 0, -5}, 99, com_P);
    rest.phase = 3;  // the part is released: later rows are not the trainee's motion
    recorder.add(rest);
    recorder.finish();
    return device::loadRecording(file);
  }

  test::TemporaryFolder folder_;
};

constexpr double kRounding_m = 1e-9;

TEST_F(Compare, ARunAgainstItselfHasTheFullScore) {
  const device::RecordedRun run = record({}, "expert.mcap");
  const RunComparison result = compareRuns(run, run);
  ASSERT_EQ(result.steps.size(), 1U);
  EXPECT_DOUBLE_EQ(result.score, 100);
  EXPECT_EQ(result.steps[0].part, "peg");
  EXPECT_NEAR(result.steps[0].expert.path_m, 100 * kMm, kRounding_m);
  EXPECT_NEAR(result.steps[0].expert.duration_s, 2, 1e-9);
  EXPECT_NEAR(result.steps[0].deviation_m, 0, kRounding_m);
  EXPECT_TRUE(result.notes.empty());
}

TEST_F(Compare, ADetourOfFiveMillimetresAndSixNewtonsMoreAreFound) {
  const RunComparison result =
      compareRuns(record({}, "expert.mcap"),
                  record({.duration_s = 3, .force_N = 3, .peak_N = 10, .detour_m = 5 * kMm}, "trainee.mcap"));
  const ComparedStep& step = result.steps[0];
  // The detour goes up and down again.
  EXPECT_NEAR(step.detour_m, 10 * kMm, kRounding_m);
  EXPECT_NEAR(step.trainee.path_m, 110 * kMm, kRounding_m);
  EXPECT_NEAR(step.deviation_m, 5 * kMm, kRounding_m);
  // The path runs at a distance of 5 mm for 40 mm. Each flank of 5 mm counts the distances at the ends of its
  // pieces: 1, 2, 3, 4, 5 mm upwards, and 4, 3, 2, 1, 0 mm downwards.
  EXPECT_NEAR(step.mean_deviation_m, (40 * 5 + 15 + 10) / 110.0 * kMm, kRounding_m);
  EXPECT_NEAR(step.excess_force_N, 6, 1e-12);
  EXPECT_NEAR(step.trainee.duration_s, 3, 1e-9);
  EXPECT_NEAR(step.score, 100 * (2.0 / 3 + 100.0 / 110 + 4.0 / 10) / 3, 1e-6);
  EXPECT_DOUBLE_EQ(result.score, step.score);
  // One of 111 samples has the peak force; the first sample has a duration of 0.
  EXPECT_NEAR(step.trainee.mean_force_N, 3 + 7.0 / 110, 0.02);
}

TEST_F(Compare, AShiftedOrTurnedPathDeviatesByThat) {
  const device::RecordedRun expert = record({}, "expert.mcap");
  const RunComparison shifted = compareRuns(expert, record({.shift_m = 3 * kMm}, "shifted.mcap"));
  EXPECT_NEAR(shifted.steps[0].deviation_m, 3 * kMm, kRounding_m);
  EXPECT_NEAR(shifted.steps[0].mean_deviation_m, 3 * kMm, kRounding_m);
  EXPECT_NEAR(shifted.steps[0].detour_m, 0, kRounding_m);
  const RunComparison turned = compareRuns(expert, record({.turn_rad = 0.2}, "turned.mcap"));
  EXPECT_NEAR(turned.steps[0].deviation_rad, 0.2, 1e-9);
}

TEST_F(Compare, QuickerThanTheExpertIsNoMoreThanFull) {
  const RunComparison result = compareRuns(
      record({}, "expert.mcap"), record({.duration_s = 1, .force_N = 0.5, .peak_N = 0.5}, "quick.mcap"));
  EXPECT_DOUBLE_EQ(result.score, 100);
}

TEST_F(Compare, AStepThatIsNotDoneHasNoScore) {
  const RunComparison result =
      compareRuns(record({}, "expert.mcap"), record({.is_done = false}, "undone.mcap"));
  EXPECT_FALSE(result.steps[0].is_done);
  EXPECT_EQ(result.score, 0);
}

TEST_F(Compare, APartOfAnotherShapeIsNoted) {
  const RunComparison result = compareRuns(record({}, "expert.mcap"), record({}, "other.mcap", 3.9e-3));
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("'peg' has another shape"), std::string::npos) << result.notes[0];
}

TEST_F(Compare, ARecordingWithoutASceneIsRefused) {
  const device::RecordedRun expert = record({}, "expert.mcap");
  device::RecordedRun alone = expert;
  alone.head.attachments.clear();
  EXPECT_THROW(compareRuns(expert, alone), LoadError);
}

}  // namespace
}  // namespace vps::scenes

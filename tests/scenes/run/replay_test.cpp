// SPDX-License-Identifier: BSD-3-Clause
// Recorded runs repeat to the bit, and the scene in a recording can be read.
#include "vps_scenes/run/replay.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "record/scene_archive.h"
#include "support/recorded.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"

namespace vps::scenes {
namespace {

namespace fs = std::filesystem;
using test::expectSame;
using test::Recorded;

const std::string kFixture = VPS_SOURCE_DIR "/tests/scenes/recorded/peg_in_hole.mcap";

/// A pin that is lowered by 0.2 mm onto a plate, at a low rate: half a second of computing.
Scene pinOnPlate() {
  Scene scene;
  scene.file = "some/folder/scene.toml";
  scene.name = "pin on plate";
  scene.parts.resize(2);
  scene.parts[0].part = {"plate", makeBox({10e-3, 10e-3, 2e-3}), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[0].file = "/home/somebody/secret/plate.stl";
  scene.parts[1].part = {"pin", makeBox({2e-3, 2e-3, 2e-3}), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, 2e-3});
  scene.steps[0].tolerance_m = 0.5e-3;  // nothing guides the pin across: five standard deviations of sight
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 2.2e-3});
  scene.fidelity.haptic_rate_hz = scene.fidelity.physics_rate_hz = 250;
  scene.release_s = 0.1;
  scene.hand.aim_error_m = 0.05e-3;
  scene.coupling.b_Ns_per_m = 1.0 / 3;
  return scene;
}

Recorded recordedPin() {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Scene scene = pinOnPlate();
  Recorded recorded;
  recorded.result = assembleAndRecord(scene, file);
  recorded.run = device::loadRecording(file);
  return recorded;
}

// A recording as a user would send it, made by an earlier version. After a change that is meant to change
// results, record it again, in tests/scenes/recorded:
//   vps assemble scene.toml --no-pictures --out out --record peg_in_hole.mcap
TEST(Replay, TheCommittedRecordingRunsAgainBitForBit) {
#ifndef VPS_BULLET_DOUBLE
  GTEST_SKIP() << "recorded with double-precision Bullet";
#endif
  const device::RecordedRun run = device::loadRecording(kFixture);
  EXPECT_EQ(run.damage, "");
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "") << replayed.other_version;
  EXPECT_EQ(replayed.equal, run.entries.size());
  EXPECT_GT(run.reads(), 500u);
  ASSERT_EQ(replayed.result.steps.size(), 1u);
  EXPECT_TRUE(replayed.result.steps[0].completed);
  EXPECT_GT(replayed.result.steps[0].peak_force_N, 4);  // the peg was pressed to its target
}

TEST(Replay, ARecordedRunGivesTheSameReport) {
  const Recorded recorded = recordedPin();
  EXPECT_EQ(recorded.run.damage, "");
  EXPECT_TRUE(recorded.result.steps.at(0).completed) << recorded.result.steps.at(0).failure_reason;
  const ReplayResult replayed = replay(recorded.run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.other_version, "");
  EXPECT_EQ(replayed.equal, recorded.run.entries.size());
  expectSame(recorded.result, replayed.result);
}

TEST(Replay, RecordingChangesNoBitOfTheRun) {
  Scene scene = pinOnPlate();
  expectSame(recordedPin().result, assemble(scene));
}

TEST(Replay, AChangedSceneDepartsAndTheTickIsReported) {
  device::RecordedRun run = recordedPin().run;
  Scene heavier = recordedScene(run);
  heavier.parts[1].part.material.density_kg_m3 *= 1.01;
  run.head.attachments[0].data = sceneToBytes(heavier);
  run.head.about["version"] = "0.0.1";
  const ReplayResult replayed = replay(run);
  // The first row of the trace follows the first physics step, in which the pin falls.
  EXPECT_EQ(replayed.departure.find("tick 1 (0.004 s): /run/trace: p_wp_m.z was "), 0u) << replayed.departure;
  EXPECT_NE(replayed.other_version.find("was recorded by vps 0.0.1"), std::string::npos);
  EXPECT_EQ(replayed.result.haptic.count,
            recordedPin().result.haptic.count);  // the replay continued to its end
}

TEST(Replay, ACutRecordingRunsUpToTheCut) {
  Recorded recorded = recordedPin();
  device::RecordedRun cut = recorded.run;
  cut.entries.resize(cut.entries.size() / 3);
  cut.damage = "ends in the middle of a record";
  const ReplayResult replayed = replay(cut);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.result.haptic.count + 1, cut.reads());  // one read belongs to the grasp
  EXPECT_EQ(replayed.result.steps.at(0).failure_reason, "the recording ends here");
  for (std::size_t i = 0; i < replayed.result.trace.size(); ++i)
    ASSERT_EQ(replayed.result.trace[i].X_WP.p, recorded.result.trace[i].X_WP.p);
}

TEST(Replay, ARunThatFailsBeforeItStartsLeavesNoFile) {
  const test::TemporaryFolder folder;
  Scene scene = pinOnPlate();
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 1e-3});  // 1 mm inside the plate
  EXPECT_THROW(assembleAndRecord(scene, folder.path() / "run.mcap"), LoadError);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Replay, ARecordingWithoutASceneIsRefused) {
  device::RecordedRun run = device::loadRecording(kFixture);
  run.head.attachments.clear();
  try {
    replay(run);
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("holds no scene"), std::string::npos) << error.what();
  }
}

TEST(SceneArchive, EveryBitComesBackAndNoFolderIsStored) {
  const Scene scene = pinOnPlate();
  const std::string bytes = sceneToBytes(scene);
  const Scene back = sceneFromBytes(bytes, "x");
  EXPECT_EQ(sceneToBytes(back), bytes);
  EXPECT_EQ(back.coupling.b_Ns_per_m, 1.0 / 3);
  EXPECT_FALSE(back.coupling.k_N_per_m);
  EXPECT_EQ(back.parts[1].part.mesh.triangles, scene.parts[1].part.mesh.triangles);
  EXPECT_EQ(back.steps[0].X_WP_start.p, scene.steps[0].X_WP_start.p);
  EXPECT_EQ(back.fidelity.haptic_rate_hz, 250);
  EXPECT_EQ(back.parts[0].file, "plate.stl");
  EXPECT_EQ(bytes.find("somebody"), std::string::npos);
}

TEST(SceneArchive, ColorsOfFacesThatAreNotThereAreRefused) {
  Scene scene = pinOnPlate();
  FaceColors& colors = scene.parts[1].part.face_colors;
  colors.palette = {{1, 0, 0}};
  colors.of_triangle.assign(scene.parts[1].part.mesh.triangles.size(), 0);
  EXPECT_NO_THROW(static_cast<void>(sceneFromBytes(sceneToBytes(scene), "x")));
  colors.of_triangle.back() = 1;
  EXPECT_THROW(static_cast<void>(sceneFromBytes(sceneToBytes(scene), "x")), LoadError);
  colors.of_triangle.pop_back();
  EXPECT_THROW(static_cast<void>(sceneFromBytes(sceneToBytes(scene), "x")), LoadError);
}

TEST(SceneArchive, EarlierVersionsAreReadWithDefaultsForLaterSettings) {
  Scene scene = pinOnPlate();
  scene.fidelity.contact_method = ContactMethod::Penalty;
  scene.fidelity.substeps = 0;
  scene.device.has_indexing = false;
  scene.device.placement = Pose::translation({1, 2, 3});
  scene.steps[0].is_held = true;
  scene.steps[0].motion = StepMotion::Screw;
  scene.parts[1].youngs_modulus_Pa = 3e9;
  scene.steps[0].takes_off = true;
  scene.parts[1].part.face_colors = {{{1, 0, 0}, {0, 0, 1}}, {}};
  scene.parts[1].part.face_colors.of_triangle.assign(12, 1);
  const std::string bytes = sceneToBytes(scene), magic = "vps-scene-8\n";
  ASSERT_TRUE(bytes.starts_with(magic));
  // Version 2 brought the contact method, a byte, version 3 indexing, a byte, and version 4 `holds`, a byte,
  // a number of the operator, and for each of the two parts two bytes and two numbers. Version 5 brought the
  // motion, a byte, with two numbers, and for each part two numbers, and version 6 whether the step takes its
  // part off, a byte, and the device's placement, a byte and twelve numbers. Version 7 brought the colours of
  // faces: for each part two counts, here with two colours of three floats and twelve numbers, and version 8
  // the parts of a step, four bytes. The fields of each version follow those of the version before.
  const auto before = [&](const std::string& later, int version, std::size_t added) {
    return "vps-scene-" + std::to_string(version) + "\n" +
           later.substr(magic.size(), later.size() - magic.size() - added);
  };
  const std::string seventh = before(bytes, 7, 4), sixth = before(seventh, 6, 2 * 2 * 8 + 2 * 3 * 4 + 12 * 8),
                    fifth = before(sixth, 5, 1 + 1 + 12 * 8),
                    fourth = before(fifth, 4, 1 + 2 * 8 + 2 * 2 * 8),
                    third = before(fourth, 3, 1 + 8 + 2 * (2 + 2 * 8)), second = before(third, 2, 1),
                    first = before(second, 1, 1);
  EXPECT_EQ(sceneFromBytes(bytes, "x").fidelity.substeps, 0);
  EXPECT_EQ(sceneFromBytes(seventh, "x").fidelity.substeps, 1);
  EXPECT_EQ(sceneFromBytes(seventh, "x").parts[1].part.face_colors, scene.parts[1].part.face_colors);
  EXPECT_TRUE(sceneFromBytes(sixth, "x").parts[1].part.face_colors.isNone());
  EXPECT_TRUE(sceneFromBytes(bytes, "x").steps[0].takes_off);
  EXPECT_FALSE(sceneFromBytes(fifth, "x").steps[0].takes_off);
  EXPECT_EQ(sceneFromBytes(bytes, "x").device.placement.value().p, Vec3(1, 2, 3));
  EXPECT_FALSE(sceneFromBytes(fifth, "x").device.placement);
  EXPECT_EQ(sceneFromBytes(fifth, "x").steps[0].motion, StepMotion::Screw);
  EXPECT_EQ(sceneFromBytes(bytes, "x").parts[1].youngs_modulus_Pa, 3e9);
  EXPECT_EQ(sceneFromBytes(fourth, "x").steps[0].motion, StepMotion::Push);
  EXPECT_EQ(sceneFromBytes(fourth, "x").parts[1].youngs_modulus_Pa, 210e9);
  EXPECT_TRUE(sceneFromBytes(fourth, "x").steps[0].is_held);
  EXPECT_FALSE(sceneFromBytes(third, "x").steps[0].is_held);
  EXPECT_FALSE(sceneFromBytes(third, "x").device.has_indexing);
  EXPECT_TRUE(sceneFromBytes(second, "x").device.has_indexing);
  EXPECT_EQ(sceneFromBytes(second, "x").fidelity.contact_method, ContactMethod::Penalty);
  EXPECT_EQ(sceneFromBytes(first, "x").fidelity.contact_method, ContactMethod::Constraint);
  EXPECT_EQ(sceneFromBytes(first, "x").fidelity.haptic_rate_hz, 250);
}

TEST(SceneArchive, ALaterVersionIsRefusedWithARemedy) {
  std::string bytes = sceneToBytes(pinOnPlate());
  bytes.replace(0, 12, "vps-scene-9\n");
  try {
    sceneFromBytes(bytes, "run.mcap");
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("replay it with the version that made it"), std::string::npos)
        << error.what();
  }
}

TEST(SceneArchive, ASettingOutOfItsRangeIsRefused) {
  Scene scene = pinOnPlate();
  scene.fidelity.contact_limit = 0;
  EXPECT_THROW(sceneFromBytes(sceneToBytes(scene), "x"), LoadError);
}

TEST(SceneArchive, CutAtAnyByteItIsRefused) {
  const std::string bytes = sceneToBytes(pinOnPlate());
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(sceneFromBytes(std::string_view(bytes).substr(0, length), "x"), LoadError) << length;
}

TEST(SceneArchive, AChangedByteIsRefusedOrAScene) {
  const std::string whole = sceneToBytes(pinOnPlate());
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const unsigned flip : {0x01u, 0x80u, 0xffu}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ flip);
      try {
        const Scene scene = sceneFromBytes(bytes, "x");
        for (const ScenePart& part : scene.parts)
          for (const auto& triangle : part.part.mesh.triangles)
            for (const std::uint32_t corner : triangle) ASSERT_LT(corner, part.part.mesh.vertices.size());
        for (const SceneStep& step : scene.steps) ASSERT_LT(step.part, scene.parts.size());
      } catch (const LoadError&) {
      }
    }
}

}  // namespace
}  // namespace vps::scenes

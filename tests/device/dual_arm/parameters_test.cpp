// SPDX-License-Identifier: BSD-3-Clause
// data/dual_arm.toml, and files that override it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "vps/errors.h"
#include "vps_device/dual_arm/kinematics.h"

namespace vps::device {
namespace {

std::string complaint(const std::string& text) {
  try {
    parseDualArm(text, "my.toml");
  } catch (const LoadError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(DualArmParameters, BuiltInTextIsTheFileInTheSourceTree) {
  std::ifstream in(VPS_SOURCE_DIR "/device/data/dual_arm.toml", std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(file, kDualArmToml);
}

TEST(DualArmParameters, EachParameterStatesItsSource) {
  const DualArmFile& file = builtInDualArm();
  int sourced = 0;
  for (const ParameterNote& note : file.notes) {
    EXPECT_FALSE(note.words.empty()) << note.section << " " << note.key;
    EXPECT_FALSE(note.value.empty()) << note.section << " " << note.key;
    sourced += note.is_sourced ? 1 : 0;
  }
  EXPECT_EQ(file.notes.size(), 57u);
  EXPECT_EQ(sourced, 7);  // the paper gives seven values
  // Values of the paper's section 3: a number and a vector.
  EXPECT_EQ(DualArmParameters().handle_kg, 0.2);
  EXPECT_EQ(DualArmParameters().workspace_m, Vec3(0.4, 0.6, 0.4));
}

TEST(DualArmParameters, AUsersFileChangesOnlyItsOwnKeys) {
  const DualArmFile file =
      parseDualArm("[handle]\nmass_kg = 0.5\nlength_m = {value = 0.3, assumed = \"longer\"}\n", "");
  DualArmParameters expected;
  expected.handle_kg = 0.5;
  expected.handle_m = 0.3;
  EXPECT_EQ(file.parameters.handle_kg, 0.5);
  EXPECT_EQ(file.parameters.handle_m, 0.3);
  EXPECT_EQ(file.parameters.plate_kgm2, expected.plate_kgm2);
  const auto wordsOf = [&](const std::string& key) {
    for (const ParameterNote& note : file.notes)
      if (note.key == key) return note.words;
    return std::string("not found");
  };
  EXPECT_EQ(wordsOf("mass_kg"), "");
  EXPECT_EQ(wordsOf("length_m"), "longer");
  EXPECT_NE(wordsOf("plate_kgm2"), "");
}

TEST(DualArmParameters, ErrorsNameFileLineKeyAndRemedy) {
  EXPECT_EQ(complaint("[handle]\n\nmass_kg = -1\n"),
            "my.toml:3: [handle] mass_kg is -1; expected more than 0 and at most 100");
  EXPECT_EQ(complaint("[handle]\nmass_kg = nan\n"),
            "my.toml:2: [handle] mass_kg is nan; expected more than 0 and at most 100");
  EXPECT_EQ(complaint("[handle]\nmass_kg = \"heavy\"\n"),
            "my.toml:2: [handle] mass_kg is not a number; expected more than 0 and at most 100");
  EXPECT_EQ(
      complaint("[stops]\ndamp = 1\n"),
      "my.toml:2: [stops] has no 'damp'; it may have plate_Nm_per_rad, link_N_per_m, gimbal_Nm_per_rad, "
      "damping_s");
  EXPECT_NE(complaint("[motor]\n")
                .find("my.toml:1: section [motor] is unknown; there are workspace, handle, bases"),
            std::string::npos);
  EXPECT_EQ(complaint("handle = 3\n"),
            "my.toml:1: 'handle' is not a section; write [handle] on a line of its own");
  EXPECT_EQ(complaint("[workspace]\nsize_m = [1, 2]\n"),
            "my.toml:2: [workspace] size_m must be three numbers, [x, y, z]");
  EXPECT_EQ(complaint("[handle]\nmass_kg = {assumed = \"?\"}\n"),
            "my.toml:2: [handle] mass_kg has no value; write value = NUMBER");
  EXPECT_EQ(complaint("[handle]\nmass_kg = {value = 1, guessed = \"?\"}\n"),
            "my.toml:2: [handle] mass_kg has 'guessed'; next to value it may have sourced or assumed");
  EXPECT_EQ(complaint("[motors]\nplate_Nm = 20\n"),
            "my.toml:2: [motors] plate_Nm is 20, more than plate_peak_Nm 18.5; swap or change them");
  EXPECT_EQ(complaint("[timing]\ndelay_ticks = 1.5\n"),
            "my.toml:2: [timing] delay_ticks is 1.5; expected a whole number");
  EXPECT_EQ(
      complaint("[workspace]\nsize_m = [0.4, 1.6, 0.4]\n"),
      "my.toml: the arms do not reach a corner of [workspace] size_m; make it smaller, or [joints] wider");
  EXPECT_EQ(complaint("[handle\n").find("my.toml:1: not valid TOML: "), 0u);
  EXPECT_EQ(complaint("[=]\n").find("my.toml:1: not valid TOML: "), 0u);
}

TEST(DualArmParameters, AMissingFileIsRefused) {
  try {
    loadDualArm("no/such.toml");
    FAIL();
  } catch (const LoadError& error) {
    EXPECT_STREQ(error.what(), "no/such.toml: no such file; name a device's .toml file");
  }
  EXPECT_THROW(loadDualArm("."), LoadError);
}

TEST(DualArmParameters, CutAtEveryByteItIsReadOrRefusedWithAMessage) {
  const std::string whole(kDualArmToml);
  int refused = 0;
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    const std::string words = complaint(whole.substr(0, length));
    if (words == "no complaint") continue;
    ++refused;
    EXPECT_EQ(words.find("my.toml:"), 0u) << words;
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace vps::device

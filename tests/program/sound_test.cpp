// SPDX-License-Identifier: BSD-3-Clause
// What a run sounds like, as the program writes it.
#include "program.h"

namespace vps {
namespace {

TEST_F(Program, TheSoundOfARunHasTheSameBytesEachTimeAndIsNotSilence) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  const Ran ran = run("assemble " + scene + " --out a --no-pictures --sound a.wav");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("sound: at most"), std::string::npos) << ran.out;
  EXPECT_EQ(run("assemble " + scene + " --out b --no-pictures --sound b.wav").status, 0);
  const std::string bytes = slurp(folder_ / "a.wav");
  EXPECT_EQ(bytes, slurp(folder_ / "b.wav"));
  ASSERT_GT(bytes.size(), 44u + 2 * 48000u) << "a run takes more than a second";
  EXPECT_EQ(std::count(bytes.begin() + 44, bytes.begin() + 44 + 48000, '\0'), 48000)
      << "nothing touches in the first half second";
  EXPECT_LT(std::count(bytes.begin() + 44, bytes.end(), '\0'), static_cast<long>(bytes.size()) - 44 - 1000);
}

TEST_F(Program, SoundOfARunInRealTimeOrOfSeveralTriesIsRefused) {
  expectRefused("assemble scene.toml --sound a.wav --real-time", "--sound");
  expectRefused("assemble scene.toml --sound a.wav --tries 3", "--sound");
  expectRefused("assemble scene.toml --sound missing/a.wav", "missing");
}

}  // namespace
}  // namespace vps

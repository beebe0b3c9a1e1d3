// SPDX-License-Identifier: BSD-3-Clause
// The delays between picture, sound and force of a contact, as the program measures them. Times depend on the
// machine, so only their relations are tested.
#include <nlohmann/json.hpp>
#include <string>

#include "program.h"

namespace vps {
namespace {

const std::string kPegInHole = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";

TEST_F(Program, TheWayFromEncoderToPhotonAndSampleIsMeasuredInOneRun) {
  const Ran ran =
      run("view " + kPegInHole + " --measure-latency --taps 5 --width 320 --height 180 --json latency.json");
  ASSERT_TRUE(fs::exists(folder_ / "latency.json")) << ran.out << ran.err;
  const nlohmann::json json = nlohmann::json::parse(slurp(folder_ / "latency.json"));
  const nlohmann::json& wall = json["wall"];
  EXPECT_EQ(ran.status, wall["is_good"] == true ? 0 : 1) << ran.err;
  EXPECT_EQ(wall["contacts"], 5);
  const nlohmann::json& stages = wall["since_read"];
  for (const char* key : {"found", "force"}) EXPECT_EQ(stages[key]["seen"], 5) << key << ": " << wall;
  for (const char* key : {"found", "force", "drawing", "picture"}) {
    // On a busy machine it is possible that no picture shows a contact, or only a picture whose drawing began
    // before the contact.
    if (stages[key]["seen"] == 0) continue;
    EXPECT_LE(stages[key]["p50_s"], stages[key]["max_s"]) << key;
    EXPECT_GT(stages[key]["p50_s"], 0) << key;
  }
  if (json["has_sound"] == true) {
    EXPECT_GE(stages["sound"]["seen"], 1);
    EXPECT_GE(stages["sound"]["max_s"],
              stages["sound_written"]["p50_s"]);  // the sound is mixed after it was written
  }
  EXPECT_NE(ran.out.find("picture: drawn and read back"), std::string::npos) << ran.out;
}

TEST_F(Program, LatencyOfWhatMakesNoContactIsRefused) {
  expectRefused("view scene.toml --measure-latency", "has no [[step]]");
  expectRefused("view missing.mcap --measure-latency", "is a recording");
  // A step in which the part meets nothing.
  write("open.toml",
        "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n"
        "pose = {position = [0, 0, 90]}\n[[step]]\npart = 'pin'\nstart = {position = [0, 0, 80]}\n");
  const Ran ran = run("view open.toml --measure-latency");
  EXPECT_EQ(ran.status, 2) << ran.err;
  EXPECT_NE(ran.err.find("touched nothing on its path"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace vps

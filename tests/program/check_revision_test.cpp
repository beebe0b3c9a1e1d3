// SPDX-License-Identifier: BSD-3-Clause
// `vps check --against` and `vps check --section` as their users run them.
#include <nlohmann/json.hpp>

#include "program.h"

namespace vps {
namespace {

class CheckRevision : public Program {
 protected:
  /// A plate of 10 mm about z = 0, and a pin of 8 mm in height whose foot is gap_mm above the plate.
  void writePinScene(const std::string& file, double gap_mm) const {
    write(file,
          "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n"
          "pose = {position = [0, 0, " +
              std::to_string(9 + gap_mm) + "]}\n");
  }
};

TEST_F(CheckRevision, TheExitStatusAndTheResultsAreThoseOfTheNewRevision) {
  writePinScene("old.toml", 0.05);
  writePinScene("new.toml", -1.2);
  const Ran ran = run("check old.toml --against new.toml --no-play --json c.json --html c.html");
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("1.2500 mm along -z"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("apart -> clash"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("the answer was 'fits' and is 'blocked'"), std::string::npos) << ran.out;
  const auto found = nlohmann::json::parse(slurp(folder_ / "c.json"));
  EXPECT_EQ(found["verdict"], "blocked");
  EXPECT_EQ(found["against"]["old_verdict"], "fits");
  EXPECT_EQ(found["against"]["is_same"], false);
  EXPECT_NEAR(found["against"]["parts"][1]["by_m"][2], -1.25e-3, 1e-9);
  EXPECT_NE(slurp(folder_ / "c.html").find("apart -&gt; clash"), std::string::npos);
  EXPECT_EQ(run("check new.toml --against old.toml --no-play").status, 0);
}

TEST_F(CheckRevision, TheSameRevisionHasNoChanges) {
  writePinScene("old.toml", 0.05);
  const Ran ran = run("check old.toml --against old.toml --json c.json");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("nothing changed; the answer is 'fits'"), std::string::npos) << ran.out;
  EXPECT_EQ(nlohmann::json::parse(slurp(folder_ / "c.json"))["against"]["is_same"], true);
  ASSERT_EQ(run("check old.toml --no-play --json c.json").status, 0);
  EXPECT_FALSE(nlohmann::json::parse(slurp(folder_ / "c.json")).contains("against"));
  expectRefused("check old.toml --against gone.toml", "gone.toml");
  expectRefused("check plate.stl --units mm --against old.toml --json old.toml", "old.toml");
}

TEST_F(CheckRevision, ASectionIsDrawnIntoThePageAndNeedsOne) {
  writePinScene("drawn.toml", 0.05);
  const Ran ran = run("check drawn.toml --no-play --html c.html --section z=6mm --section y=0mm");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  const std::string page = slurp(folder_ / "c.html");
  EXPECT_NE(page.find("data-section=\"z=6mm\""), std::string::npos);
  EXPECT_NE(page.find("Section <b>z=6mm</b> through 1 part;"), std::string::npos);
  EXPECT_NE(page.find("Section <b>y=0mm</b> through 2 parts;"), std::string::npos);
  expectRefused("check drawn.toml --section z=6mm", "give --html FILE or --pdf FILE");
  expectRefused("check drawn.toml --html c.html --section z=60mm", "the parts reach from -5 mm to 13.05 mm");
  expectRefused("check drawn.toml --html c.html --section 6mm", "has no =");
}

}  // namespace
}  // namespace vps

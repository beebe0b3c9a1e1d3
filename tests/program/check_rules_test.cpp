// SPDX-License-Identifier: BSD-3-Clause
// Chosen pairs, rules and moved parts of `vps check`, as its users ask for them.
#include <nlohmann/json.hpp>

#include "program.h"

namespace vps {
namespace {

class CheckRules : public Program {
 protected:
  /// A plate, a pin whose foot is gap_mm above the top of the plate, and a post that stands on the plate.
  void draw(double gap_mm) const {
    write("drawn.toml",
          "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n[[part]]\nfile = 'pin.stl'\n"
          "pose = {position = [0, 0, " +
              std::to_string(9 + gap_mm) +
              "]}\n[[part]]\nname = 'post'\nfile = 'pin.stl'\npose = {position = [7, 0, 9]}\n");
  }
  [[nodiscard]] nlohmann::json result() const { return nlohmann::json::parse(slurp(folder_ / "c.json")); }
};

TEST_F(CheckRules, ALeastGapHasItsExitStatusAndItsWords) {
  draw(0.3);
  Ran ran = run("check --no-play --between plate,pin drawn.toml --min-gap 0.2mm --json c.json");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("no clash deeper than the error of the check among the chosen pairs"),
            std::string::npos)
      << ran.out;
  EXPECT_NE(ran.out.find("chosen pairs only: 1 pair near each other was left out"), std::string::npos)
      << ran.out;
  EXPECT_NE(ran.out.find("rules: 0 broken, 0 not decided, 1 kept"), std::string::npos) << ran.out;
  EXPECT_EQ(result()["rules"][0]["outcome"], "kept");
  EXPECT_EQ(result()["between"], nlohmann::json::parse(R"([["plate", "pin"]])"));
  EXPECT_EQ(result()["left_out"].size(), 1U);

  ran =
      run("check --no-play --between plate,pin drawn.toml --min-gap 0.4mm --json c.json --csv c.csv "
          "--html c.html");
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("'--min-gap' is broken by plate and pin: clearance 300.00 um"), std::string::npos)
      << ran.out;
  const nlohmann::json rule = result()["rules"][0];
  EXPECT_EQ(rule["outcome"], "broken");
  EXPECT_NEAR(rule["value_m"], 0.3e-3, 1e-8);  // single precision of the file
  EXPECT_NEAR(rule["bound_m"], 0.4e-3, 1e-15);
  EXPECT_EQ(result()["verdict"], "fits");  // of the assembly, which the rule does not change
  EXPECT_NE(slurp(folder_ / "c.csv").find("rule --min-gap,plate,pin,margin_m,"), std::string::npos);
  EXPECT_NE(slurp(folder_ / "c.html").find("is broken by plate and pin"), std::string::npos);
}

TEST_F(CheckRules, ALeastGapBeyondNearIsMeasured) {
  draw(5);
  EXPECT_EQ(run("check drawn.toml --no-play --between plate,pin --min-gap 4.9mm").status, 0);
  EXPECT_EQ(run("check drawn.toml --no-play --between plate,pin --min-gap 5.1mm").status, 1);
}

TEST_F(CheckRules, AnIgnoredClashIsCountedAndNotSilent) {
  draw(-1.2);
  EXPECT_EQ(run("check drawn.toml --no-play").status, 1);
  Ran ran = run("check drawn.toml --no-play --ignore plate,pin --json c.json --html c.html");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("1 pair near each other was left out (--ignore plate,pin)"), std::string::npos)
      << ran.out;
  EXPECT_EQ(result()["clashes"], 0);
  EXPECT_EQ(result()["left_out"][0]["reason"], "--ignore plate,pin");
  EXPECT_NE(slurp(folder_ / "c.html").find("No parts of the chosen pairs overlap"), std::string::npos);
  ran = run("check drawn.toml --no-play --ignore 'p*,p*'");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("all pairs of parts near each other were left out"), std::string::npos) << ran.out;
}

TEST_F(CheckRules, AFileOfRulesDecidesTheExitStatus) {
  draw(0.3);
  write("rules.toml", "[[rule]]\nname = 'gap'\nbetween = ['plate', 'pin']\nmin_clearance = '0.2mm'\n");
  EXPECT_EQ(run("check drawn.toml --no-play --rules rules.toml").status, 0);
  write("rules.toml", "[[rule]]\nname = 'coaxial'\nmax_axis_offset = '50um'\n");
  const Ran ran = run("check drawn.toml --no-play --rules rules.toml");
  EXPECT_EQ(ran.status, 3) << ran.out << ran.err;  // square pins have no axis
  EXPECT_NE(ran.out.find("'coaxial' is not decided: axis offset, at most 50.00 um wanted; no round fit"),
            std::string::npos)
      << ran.out;
  write("rules.toml", "[[rule]]\nbetween = ['plate', 'pine']\nmin_clearance = '0.2mm'\n");
  expectRefused("check drawn.toml --no-play --rules rules.toml",
                "rules.toml:2: 'pine' matches no part; did you mean 'pin'?");
}

TEST_F(CheckRules, AMovedPartIsCheckedWhereItIsAndSaysSo) {
  draw(0.3);
  const Ran ran =
      run("check --no-play --move pin,z,-0.1mm --move post,rz,90deg drawn.toml --json c.json --html c.html");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("'pin' was moved by -0.1000 mm along +z before the check"), std::string::npos)
      << ran.out;
  EXPECT_NE(ran.out.find("'post' was turned by 90.0000 degrees about +z"), std::string::npos) << ran.out;
  EXPECT_NE(slurp(folder_ / "c.html").find("was moved by -0.1000 mm"), std::string::npos);
  EXPECT_EQ(result()["moves"].size(), 2U);
  const nlohmann::json found = result();  // outlives the loop
  for (const nlohmann::json& pair : found["pairs"])
    if (pair["b"] == "pin") {
      EXPECT_NEAR(pair["clearance_m"], 0.2e-3, 1e-8);
    }
}

TEST_F(CheckRules, AMistakeInAWishIsRefused) {
  draw(0.3);
  expectRefused("check drawn.toml --between plate,pim",
                "--between plate,pim: 'pim' matches no part; did you mean 'pin'?");
  expectRefused("check drawn.toml --between plate", "--between: 'plate' is not a pair");
  expectRefused("check drawn.toml --ignore pin,pin", "matches only the part 'pin'");
  expectRefused("check drawn.toml --min-gap 0.3", "--min-gap");
  expectRefused("check drawn.toml --min-gap 0mm", "expected more than 0");
  expectRefused("check drawn.toml --rules none.toml", "none.toml: no such file");
  expectRefused("check drawn.toml --move pin,x", "--move: 'pin,x' is not a move");
  expectRefused("check drawn.toml --move pim,x,1mm", "did you mean 'pin'?");
}

}  // namespace
}  // namespace vps

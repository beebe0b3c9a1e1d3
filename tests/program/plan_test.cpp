// SPDX-License-Identifier: BSD-3-Clause
// `vps plan` as its users run it.
#include <nlohmann/json.hpp>

#include "program.h"

namespace vps {
namespace {

using nlohmann::json;

class Plan : public Program {
 protected:
  /// A plate, and a pin that stands on it.
  static std::string scene() {
    return "name = 'pin \"1\"'\nunit = 'mm'\n[[part]]\nfile = 'plate.stl'\n[[part]]\nfile = 'pin.stl'\n"
           "friction = 0.3\npose = {position = [0, 0, 9]}\n[[step]]\npart = 'pin'\ntimeout_s = 7\n"
           "[operator]\nseed = 5\n";
  }
};

TEST_F(Plan, WritesASceneThatCanBeVerifiedAndKeepsItsSettings) {
  write("drawn.toml", scene());
  const Ran ran = run("plan drawn.toml -o planned --json plan.json");
  ASSERT_EQ(ran.status, 0) << ran.out << ran.err;
  const json plan = json::parse(slurp(folder_ / "plan.json"));
  ASSERT_EQ(plan["assemblies"].size(), 1U);
  EXPECT_EQ(plan["assemblies"][0]["fixed"][0], "plate");
  EXPECT_EQ(plan["assemblies"][0]["steps"][0]["name"], "pin");
  EXPECT_EQ(plan["blocked_count"], 0);
  EXPECT_NE(slurp(folder_ / "planned/plan.dot").find("\"0/plate\" -> \"0/pin\""), std::string::npos);
  const std::string text = slurp(folder_ / "planned/scene.toml");
  for (const char* kept :
       {"seed = 5", "timeout_s = 7", "friction = 0.3", "fixed = true", "name = \"pin \\\"1\\\"\""})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << "\n" << text;
  EXPECT_EQ(run("plan --verify planned/scene.toml").status, 0);
  // The same once more, from what was written.
  EXPECT_EQ(run("plan planned/scene.toml -o again").status, 0);
}

TEST_F(Plan, AnEditThatBreaksAWayIsNamed) {
  write("drawn.toml", scene() +
                          "[[part]]\nfile = 'plate.stl'\nname = 'roof'\nfixed = true\n"
                          "pose = {position = [0, 0, 30]}\n");
  const Ran ran = run("plan --verify drawn.toml");  // from above, through the roof
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("leads through 'roof'"), std::string::npos) << ran.out;
}

TEST_F(Plan, RefusesABaseThatIsNoPartAndAFolderWithAScene) {
  write("drawn.toml", scene());
  const Ran ran = run("plan drawn.toml -o planned --base nobody");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("'nobody'"), std::string::npos) << ran.err;
  ASSERT_EQ(run("plan drawn.toml -o planned").status, 0);
  EXPECT_EQ(run("plan drawn.toml -o planned").status, 2);
  EXPECT_EQ(run("plan drawn.toml -o planned --force").status, 0);
}

}  // namespace
}  // namespace vps

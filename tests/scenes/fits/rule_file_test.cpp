// SPDX-License-Identifier: BSD-3-Clause
// Files of rules: what they mean, and messages for mistakes in them.
#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/fits/rules.h"

namespace vps::scenes {
namespace {

class RuleFile : public testing::Test {
 protected:
  std::vector<CheckRule> load(const std::string& text) const {
    std::ofstream(path(), std::ios::binary) << text;
    return loadRules(path());
  }
  /// Expects an error that begins with the line and contains the words.
  void expectRefused(const std::string& text, const std::string& line, const std::string& words) const {
    try {
      load(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const LoadError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with(path() + line)) << message;
      EXPECT_NE(message.find(words), std::string::npos) << message;
    }
  }
  [[nodiscard]] std::string path() const { return (folder_.path() / "rules.toml").string(); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(RuleFile, BoundsNamesAndPatternsAreRead) {
  const std::vector<CheckRule> rules = load(
      "unit = 'mm'\n[[rule]]\nname = 'gap'\nbetween = ['shaft*', 'bush']\nmin_clearance = 0.3\n"
      "max_overlap = '10um'\n[[rule]]\nmax_axis_offset = '0.05mm'\n");
  ASSERT_EQ(rules.size(), 2U);
  EXPECT_EQ(rules[0].name, "gap");
  ASSERT_TRUE(rules[0].between);
  EXPECT_EQ(rules[0].between->a, "shaft*");
  EXPECT_EQ(rules[0].between->b, "bush");
  EXPECT_EQ(rules[0].between->place, path() + ":4");
  EXPECT_NEAR(rules[0].min_clearance_m.value(), 0.3e-3, 1e-15);
  EXPECT_NEAR(rules[0].max_overlap_m.value(), 10e-6, 1e-15);
  EXPECT_FALSE(rules[0].max_axis_offset_m);
  EXPECT_EQ(rules[1].name, "rule 2");
  EXPECT_FALSE(rules[1].between);
  EXPECT_NEAR(rules[1].max_axis_offset_m.value(), 50e-6, 1e-15);
}

TEST_F(RuleFile, AMistakeIsNamedWithItsLineAndRemedy) {
  expectRefused("[[rule]]\nmin_clearence = '1mm'\n", ":2:", "did you mean 'min_clearance'?");
  expectRefused("[[rule]]\nmin_clearance = 0.3\n", ":2:", "without a unit");
  expectRefused("[[rule]]\nmin_clearance = '0.3'\n", ":2:", "has no unit");
  expectRefused("[[rule]]\nmin_clearance = '0mm'\n", ":2:", "expected more than 0");
  expectRefused("[[rule]]\nmax_overlap = '-1um'\n", ":2:", "expected at least 0");
  expectRefused("[[rule]]\n\nname = 'gap'\n", ":1:", "has no bound; give 'min_clearance'");
  expectRefused("[[rule]]\nmin_clearance = '1mm'\nbetween = ['a', 'b', 'c']\n", ":3:", "has 3 texts");
  expectRefused("[[rule]]\nname = 'x'\nmax_overlap = '1um'\n[[rule]]\nname = 'x'\nmax_overlap = '2um'\n",
                ":4:", "second rule named 'x'");
  expectRefused("unit = 'furlong'\n", ":1:", "expected one of: mm");
  expectRefused("unit = 'mm'\n", ": ", "has no rule");
  expectRefused("[rule]\nmax_overlap = '1um'\n", ":1:", "[[rule]]");
  expectRefused("[[rule]\n", ":", "not valid TOML");
  EXPECT_THROW(loadRules(path() + ".missing"), LoadError);
}

// Each cut of the text is either a file of rules or a LoadError.
TEST_F(RuleFile, ACutFileIsRefusedOrRead) {
  const std::string text = "[[rule]]\nbetween = ['a*', 'b']\nmin_clearance = '0.3mm'\nmax_overlap = '1um'\n";
  for (std::size_t size = 0; size < text.size(); ++size) {
    try {
      EXPECT_EQ(load(text.substr(0, size)).size(), 1U) << size;
    } catch (const LoadError&) {  // any other exception fails the test
    }
  }
}

TEST(PairText, IsTwoNamesWithACommaBetweenThem) {
  const PairPattern pair = pairFromText("pin 2,b*", "--between");
  EXPECT_EQ(pair.a, "pin 2");
  EXPECT_EQ(pair.b, "b*");
  EXPECT_EQ(pair.place, "--between pin 2,b*");
  for (const char* text : {"", "pin", "pin,", ",bush", "pin,bush,nut"})
    EXPECT_THROW(pairFromText(text, "--between"), LoadError) << text;
}

TEST_F(RuleFile, OverlapsAreDeclaredBesideRules) {
  EXPECT_TRUE(
      load("[[overlap]]\nbetween = ['oring*', 'housing']\nkind = 'seal'\nmax_squash = 0.2\n").empty());
  const std::vector<OverlapRule> overlaps = loadOverlapRules(path());
  ASSERT_EQ(overlaps.size(), 1U);
  EXPECT_EQ(overlaps[0].kind, OverlapWish::Seal);
  EXPECT_EQ(overlaps[0].between.a, "oring*");
  EXPECT_EQ(overlaps[0].max_squash, 0.2);
}

TEST_F(RuleFile, AMistakeInAnOverlapIsNamed) {
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(path(), std::ios::binary) << text;
    try {
      loadOverlapRules(path());
    } catch (const LoadError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(refusal("[[overlap]]\nkind = 'seal'\n").find("names no pairs"), std::string::npos);
  EXPECT_NE(refusal("[[overlap]]\nbetween = ['a', 'b']\n").find("has no 'kind'"), std::string::npos);
  EXPECT_NE(refusal("[[overlap]]\nbetween = ['a', 'b']\nkind = 'glue'\n").find("self-tapping"),
            std::string::npos);
  EXPECT_NE(refusal("[[overlap]]\nbetween = ['a', 'b']\nkind = 'thread'\nmax_squash = 0.2\n")
                .find("is for a seal only"),
            std::string::npos);
}

}  // namespace
}  // namespace vps::scenes

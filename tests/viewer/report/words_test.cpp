// SPDX-License-Identifier: BSD-3-Clause
// Results in words: numbers, counts and sentences.
#include "vps_viewer/report/words.h"

#include <gtest/gtest.h>

#include "files/html.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_viewer/report/columns.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {
namespace {

TEST(Words, ALengthHasTheUnitThatSuitsIt) {
  using scenes::lengthInWords;
  EXPECT_EQ(lengthInWords(12.34e-6), "12.3 um");
  EXPECT_EQ(lengthInWords(12.34e-6, 2), "12.34 um");
  EXPECT_EQ(lengthInWords(999.94e-6), "999.9 um");
  EXPECT_EQ(lengthInWords(999.96e-6), "1.00 mm");
  EXPECT_EQ(lengthInWords(11.71573e-3, 2), "11.716 mm");
  EXPECT_EQ(lengthInWords(-20e-3), "-20.00 mm");
  EXPECT_EQ(lengthInWords(84.15, 2), "84.150 m");
  EXPECT_EQ(lengthOnPage(20e-6), "20.00 µm");
  EXPECT_EQ(lengthOnPage(2), "2.000 m");
}

TEST(Words, OneThingIsSingular) {
  EXPECT_EQ(scenes::counted(0, "pair"), "0 pairs");
  EXPECT_EQ(scenes::counted(1, "pair"), "1 pair");
  EXPECT_EQ(scenes::counted(2, "subassembly", "subassemblies"), "2 subassemblies");
}

TEST(Words, TwoLengthsThatDifferAreWrittenDifferently) {
  using Two = std::array<std::string, 2>;
  EXPECT_EQ(toldApart(12e-6, 10e-6), (Two{"0.012", "0.010"}));
  EXPECT_EQ(toldApart(10.31e-6, 10e-6), (Two{"0.0103", "0.0100"}));
}

TEST(Words, PartsThatWerePutAtTheirTargetsAreToldOnceForTheRun) {
  scenes::AssembleResult result;
  for (const char* name : {"peg", "pin", "cap"}) result.steps.emplace_back().part = name;
  for (scenes::StepResult& step : result.steps) step.completed = true;
  EXPECT_EQ(putAtTargetWords(result), "");
  result.steps[0].completed = false;
  result.steps[1].stands_on = result.steps[2].stands_on = "peg";
  EXPECT_EQ(putAtTargetWords(result),
            "2 steps were tried with 'peg' put at its target, which this part had not reached");
  result.steps[1].completed = false;
  EXPECT_EQ(putAtTargetWords(result),
            "2 steps were tried with 'peg', 'pin', each put at its target, which it had not reached");
}

TEST(Words, AVerdictOfOneStepIsSingular) {
  scenes::AssembleResult result;
  result.verdict = result.steps.emplace_back().verdict = scenes::Verdict::Fits;
  result.steps[0].part = "peg";
  result.steps[0].completed = true;
  EXPECT_NE(verdictLine(result).find(" of 1 step fits."), std::string::npos) << verdictLine(result);
}

TEST(Words, AShaftBesideItsBoreIsNoRunningFit) {
  scenes::CheckedFit fit;
  fit.iso_286 = "H6/h5";
  EXPECT_EQ(standardOf(fit), "H6/h5");
  fit.offset_m = 70e-6;
  EXPECT_EQ(standardOf(fit), "sizes of H6/h5, but axes 70.00 um apart");
  fit.diametral_clearance_m = 140e-6;  // the shaft is drawn against the bore's wall
  EXPECT_EQ(standardOf(fit), "H6/h5");
}

TEST(Words, AColumnOfMetresIsWrittenInMillimetres) {
  scenes::CheckedPair pair;
  pair.a = "a";
  pair.b = "b";
  pair.clearance_m = 20e-6;
  const auto clearance = [&](const std::vector<scenes::CheckedPair>& pairs) {
    std::size_t at = 0;
    while (!columnHeadings(scenes::kCheckedPairFields, Medium::Terminal)[at].text.starts_with("clearance"))
      ++at;
    const ColumnTable table =
        columnTable(pairs, scenes::kCheckedPairFields, Medium::Terminal, [](double value, int digits) {
          return html::format(value, ("%." + std::to_string(digits) + "f").c_str());
        });
    return table.headings[at].text + ": " + table.rows.front()[at].text;
  };
  EXPECT_EQ(clearance({pair}), "clearance [um]: 20.00");
  scenes::CheckedPair far = pair;
  far.clearance_m = 1.5;
  EXPECT_EQ(clearance({pair, far}), "clearance [mm]: 0.0200");
}

TEST(Words, ThePageOfACheckHasNoFoldersInItsTitle) {
  scenes::CheckResult result;
  result.assembly = "\"/home/me/a.step\", \"/home/me/b.step\"";
  result.title = "a.step, b.step";
  const std::string page = checkPage(result);
  EXPECT_NE(page.find("<title>Check of a.step, b.step</title>"), std::string::npos);
  EXPECT_EQ(page.find("/home/me"), std::string::npos);
}

}  // namespace
}  // namespace vps::viewer

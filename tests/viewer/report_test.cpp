// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "vps_viewer/image.h"
#include "vps_viewer/plot.h"

namespace vps::viewer {
namespace {

namespace fs = std::filesystem;

std::string freshFolder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / "vps_report_test" / name;
  fs::remove_all(folder);
  return folder.string();
}

std::string textOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// One second: two taps of 5 ms, then contact over 10 mm of travel.
std::vector<scenes::TraceRow> tapTapSlide() {
  std::vector<scenes::TraceRow> trace;
  for (int i = 0; i < 1000; ++i) {
    scenes::TraceRow row;
    row.time_s = 1e-3 * i;
    row.step = 0;
    row.phase = i < 500 ? 1 : 2;
    const bool is_sliding = i >= 600 && i < 800;
    row.contacts = (i >= 100 && i < 105) || (i >= 300 && i < 305) || is_sliding ? 3 : 0;
    row.X_WP.p = Vec3(is_sliding ? 5e-5 * (i - 600) : 0, 0, 0);
    row.F_hand_W.f = Vec3(0, 0, row.contacts);
    row.depth_m = 1e-6 * row.contacts;
    trace.push_back(row);
  }
  return trace;
}

scenes::Scene smallScene() {
  scenes::Scene scene;
  scene.name = "peg & <hole>";
  scene.parts.resize(2);
  scene.parts[0].part.name = "hole";
  scene.parts[0].part.mesh = makeTube(0.02, 0.0101, 0.03, 32);
  scene.parts[0].is_fixed = true;
  scene.parts[1].part.name = "peg <1>";
  scene.parts[1].part.mesh = makeCylinder(0.01, 0.03, 32);
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_start = Pose::translation(Vec3(0, 0, 0.05));
  return scene;
}

scenes::AssembleResult smallResult() {
  scenes::AssembleResult result;
  result.scene = "peg & <hole>";
  scenes::StepResult step;
  step.part = "peg <1>";
  step.reason = step.failure_reason = "stuck at \"3 mm\" & <up>";
  step.penetration_limit_m = 10e-6;
  step.max_penetration_m = 12.5e-6;
  result.steps = {step};
  result.trace = tapTapSlide();
  scenes::Snapshot snapshot;
  snapshot.step = 0;
  snapshot.bodies = {{1, Pose::translation(Vec3(0, 0, 0.02)), scenes::BodyRole::InHand}};
  result.start = result.contact = result.end = {snapshot};
  result.finished = snapshot;
  return result;
}

TEST(Html, EscapesMarkup) {
  EXPECT_EQ(escapeHtml("<b a=\"1\" c='2'>&"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(escapeHtml("µm"), "µm");
}

TEST(Report, GivesTheVerdictWithItsReasonAndEveryPictureInItExists) {
  const std::string dir = freshFolder("report");
  const ReportOptions options = {
      .command = "vps assemble 'a&b.toml'", .progress = {}, .width = 160, .height = 120};
  const ReportOutcome outcome = writeReport(smallScene(), smallResult(), dir, options);
  const std::string page = textOf(outcome.file);
  EXPECT_NE(page.find("Not shown: "), std::string::npos);
  EXPECT_NE(page.find("stuck at &quot;3 mm&quot; &amp; &lt;up&gt;"), std::string::npos);
  EXPECT_NE(page.find("12.50"), std::string::npos);  // deepest [um]
  EXPECT_NE(page.find("a&amp;b.toml"), std::string::npos);
  EXPECT_EQ(page.find("<hole>"), std::string::npos);
  std::size_t count = 0;
  for (std::size_t at = page.find("src=\""); at != std::string::npos;
       at = page.find("src=\"", at + 1), ++count) {
    const std::string file = page.substr(at + 5, page.find('"', at + 5) - at - 5);
    EXPECT_TRUE(fs::exists(dir + "/" + file)) << file;
  }
  // Two pictures of the assembly and three of the step; the plot needs gnuplot.
  EXPECT_EQ(count, 2u + 3u + (hasGnuplot() ? 1u : 0u));
  EXPECT_EQ(outcome.notes.size(), hasGnuplot() ? 0u : 1u);
}

TEST(Report, RepeatsByteForByte) {
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  const std::string first = writeReport(smallScene(), smallResult(), freshFolder("first"), options).file;
  const std::string second = writeReport(smallScene(), smallResult(), freshFolder("second"), options).file;
  EXPECT_EQ(textOf(first), textOf(second));
}

TEST(Report, WithoutPicturesItHasTheTables) {
  const std::string dir = freshFolder("bare");
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  const ReportOutcome outcome = writeReport(smallScene(), smallResult(), dir, options);
  EXPECT_NE(textOf(outcome.file).find("<h2>Steps</h2>"), std::string::npos);
  for (const std::string& note : outcome.notes) EXPECT_EQ(note.find("pictures"), std::string::npos) << note;
}

TEST(TraceCsv, HasAColumnForEveryNumberOfEveryRow) {
  const std::string file = freshFolder("csv") + "/trace.csv";
  fs::create_directories(fs::path(file).parent_path());
  writeTraceCsv(tapTapSlide(), file);
  std::istringstream lines(textOf(file));
  std::string header, line;
  std::getline(lines, header);
  const auto columns = std::count(header.begin(), header.end(), ',');
  std::size_t rows = 0;
  for (; std::getline(lines, line); ++rows) EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
  EXPECT_EQ(rows, 1000u);
}

TEST(Plot, EpisodesDistinguishTapsFromSlides) {
  const auto episodes = scenes::contactEpisodes(tapTapSlide());
  ASSERT_EQ(episodes.size(), 3u);
  EXPECT_FALSE(episodes[0].is_slide);
  EXPECT_FALSE(episodes[1].is_slide);
  EXPECT_TRUE(episodes[2].is_slide);
  EXPECT_DOUBLE_EQ(episodes[1].start_s, 0.3);
}

TEST(Plot, WritesBothFilesTheSameTwice) {
  if (!hasGnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string file = freshFolder("plot") + "/forces";
  const PlotOutcome outcome = plotForces(tapTapSlide(), file, {"peg_\"1\" \\ `ls`"});
  ASSERT_TRUE(outcome) << outcome.failure_reason;
  EXPECT_GT(loadPng(file + ".png").width, 1000);
  const std::string png = textOf(file + ".png"), svg = textOf(file + ".svg");
  EXPECT_NE(svg.find("time [s]"), std::string::npos);
  EXPECT_NE(svg.find("impact (2)"), std::string::npos);
  ASSERT_TRUE(plotForces(tapTapSlide(), file, {"peg_\"1\" \\ `ls`"}));
  EXPECT_EQ(textOf(file + ".png"), png);
  EXPECT_EQ(textOf(file + ".svg"), svg);
}

TEST(Plot, WithoutGnuplotTheReasonNamesThePackage) {
  const char* path = std::getenv("PATH");
  const std::string kept = path != nullptr ? path : "";
  setenv("PATH", "/nowhere", 1);
  const PlotOutcome outcome = plotForces(tapTapSlide(), freshFolder("none") + "/forces");
  setenv("PATH", kept.c_str(), 1);
  EXPECT_FALSE(outcome);
  EXPECT_NE(outcome.failure_reason.find("gnuplot-nox"), std::string::npos) << outcome.failure_reason;
}

TEST(Plot, AnEmptyPlotFails) {
  EXPECT_FALSE(plotForces({}, freshFolder("empty") + "/forces"));
  EXPECT_FALSE(plotSeries({}, freshFolder("empty") + "/series"));
}

TEST(Report, LoadSheddingIsListedWithReasonAndCost) {
  const std::string folder = freshFolder("load_changes");
  scenes::AssembleResult result = smallResult();
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  ASSERT_TRUE(fs::create_directories(folder));
  writeReport(smallScene(), result, folder, options);
  EXPECT_EQ(textOf(folder + "/report.html").find("hold the rate"), std::string::npos)
      << "a lockstep run has no rate to hold";
  result.real_time.emplace();
  writeReport(smallScene(), result, folder, options);
  EXPECT_NE(textOf(folder + "/report.html").find("the fidelity was not reduced"), std::string::npos);
  scenes::LoadLevelChange change;
  change.is = "points every 1 mm";
  change.why = "34 % of <0.25 s> had no step";
  change.cost = "no touch is deeper unseen than 1 mm";
  result.real_time->load_changes = {change};
  writeReport(smallScene(), result, folder, options);
  const std::string page = textOf(folder + "/report.html");
  for (const char* words : {"points every 1 mm", "34 % of &lt;0.25 s&gt;", "deeper unseen than 1 mm"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace vps::viewer

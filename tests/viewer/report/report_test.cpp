// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/report.h"

#include "files/html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "viewer/small_run.h"
#include "vps_scenes/fits/check.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/report/csv.h"
#include "vps_viewer/report/pages.h"
#include "vps_viewer/report/plot.h"

namespace vps::viewer {
namespace {

namespace fs = std::filesystem;
using test::freshFolder, test::smallResult, test::smallScene, test::tapTapSlide, test::textOf;

TEST(Html, EscapesMarkup) {
  EXPECT_EQ(escapeHtml("<b a=\"1\" c='2'>&"), "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;");
  EXPECT_EQ(escapeHtml("µm"), "µm");
}

bool hasThree() {
  return fs::exists("/usr/share/javascript/three/build/three.min.js");
}

TEST(Report, GivesTheVerdictWithItsReasonAndHoldsItsPictures) {
  const std::string dir = freshFolder("report");
  const ReportOptions options = {
      .command = "vps assemble 'a&b.toml'", .progress = {}, .width = 160, .height = 120};
  const ReportOutcome outcome = writeReport(smallScene(), smallResult(), dir, options);
  const std::string page = textOf(outcome.file);
  EXPECT_NE(page.find("Not shown: "), std::string::npos);
  EXPECT_NE(page.find("stuck at &quot;3 mm&quot; &amp; &lt;up&gt;"), std::string::npos);
  EXPECT_NE(page.find("12.50"), std::string::npos);  // greatest overlap [um]
  EXPECT_NE(page.find("a&amp;b.toml"), std::string::npos);
  EXPECT_EQ(page.find("<hole>"), std::string::npos);
  std::size_t count = 0;
  for (std::size_t at = page.find("<img src=\""); at != std::string::npos;
       at = page.find("<img src=\"", at + 1), ++count)
    EXPECT_EQ(page.substr(at + 10, 22), "data:image/png;base64,");
  EXPECT_TRUE(fs::exists(dir + "/pictures/overview.png"));
  // The page has two pictures of the assembly and three of the step; the plot needs gnuplot.
  EXPECT_EQ(count, 2u + 3u + (hasGnuplot() ? 1u : 0u));
  EXPECT_EQ(outcome.notes.size(), (hasGnuplot() ? 0u : 1u) + (hasThree() ? 0u : 1u));
}

/// The targets of all links of a page.
std::vector<std::string> linksOf(const std::string& page) {
  std::vector<std::string> links;
  const std::string begin = "href=\"";
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    links.push_back(page.substr(from, page.find('"', from) - from));
  }
  return links;
}

TEST(Report, HoldsWhatItLinksToSoThatNoLinkIsDeadWhenItIsMailed) {
  const std::string dir = freshFolder("mailed");
  const ReportOptions options = {.command = {}, .progress = {}, .width = 160, .height = 120};
  const std::string page = textOf(writeReport(smallScene(), smallResult(), dir, options).file);
  std::size_t tables = 0;
  for (const std::string& link : linksOf(page)) {
    EXPECT_TRUE(link.starts_with("#") || link.starts_with("data:")) << link.substr(0, 80);
    tables += link.starts_with("data:text/csv;base64,");
  }
  EXPECT_EQ(tables, 1u) << "trace.csv";
  const std::string csv = textOf(dir + "/trace.csv");
  EXPECT_NE(page.find(base64(std::as_bytes(std::span(csv)))), std::string::npos);
}

TEST(Report, ATableThatIsTooLargeForMailIsNamedWithoutALink) {
  scenes::AssembleResult result = smallResult();
  result.trace = tapTapSlide();
  while (result.trace.size() < 60000) {  // each row has more than 100 bytes
    scenes::TraceRow row = result.trace.back();
    row.time_s += 1e-3;
    result.trace.push_back(row);
  }
  scenes::Scene scene = smallScene();
  scene.record.csv_rate_hz = 1000;
  const std::string dir = freshFolder("large");
  const std::string page =
      textOf(writeReport(scene, result, dir, {.command = {}, .progress = {}, .has_pictures = false}).file);
  ASSERT_GT(fs::file_size(dir + "/trace.csv"), 4'000'000u);
  EXPECT_NE(page.find("<a>trace.csv</a>"), std::string::npos);
  EXPECT_EQ(page.find("data:text/csv"), std::string::npos);
}

TEST(Report, HasTheSettingsOfTheRunAsASceneFile) {
  scenes::Scene scene = smallScene();
  scene.hand.seed = 1234567;
  const std::string page = textOf(writeReport(scene, smallResult(), freshFolder("settings"),
                                              {.command = {}, .progress = {}, .has_pictures = false})
                                      .file);
  const std::size_t from = page.find("<pre id=\"settings\">");
  ASSERT_NE(from, std::string::npos);
  const std::string settings = page.substr(from, page.find("</pre>", from) - from);
  for (const char* words : {"seed = 1234567", "[[part]]", "[[step]]", "peg &amp; &lt;hole&gt;"})
    EXPECT_NE(settings.find(words), std::string::npos) << words;
}

TEST(Report, NamesTheFilesOfItsPartsWithoutTheirFolders) {
  scenes::Scene scene = smallScene();
  scene.parts[0].file = "/home/somebody/secret/hole.stl";
  scene.parts[1].file = "../product/peg.stl";
  scene.device.data = "/home/somebody/arm.toml";
  const std::string page = textOf(writeReport(scene, smallResult(), freshFolder("folders"),
                                              {.command = {}, .progress = {}, .has_pictures = false})
                                      .file);
  for (const char* line :
       {"file = &quot;hole.stl&quot;", "file = &quot;peg.stl&quot;", "parameters = &quot;arm.toml&quot;"})
    EXPECT_NE(page.find(line), std::string::npos) << line;
  for (const char* folder : {"somebody", "../product"})
    EXPECT_EQ(page.find(folder), std::string::npos) << folder;
}

TEST(Report, HasTheTableOfTheCheckThatTheRunBeganWith) {
  scenes::AssembleResult result = smallResult();
  auto checked = std::make_shared<scenes::CheckResult>();
  checked->pairs.resize(1);
  checked->pairs[0].a = "hole";
  checked->pairs[0].b = "peg <1>";
  checked->pairs[0].clearance_m = 87.5e-6;
  result.checked = checked;
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  const std::string page = textOf(writeReport(smallScene(), result, freshFolder("checked"), options).file);
  EXPECT_NE(page.find("Pairs near each other"), std::string::npos);
  EXPECT_NE(page.find("87.50"), std::string::npos);
  result.checked.reset();
  const std::string without =
      textOf(writeReport(smallScene(), result, freshFolder("unchecked"), options).file);
  EXPECT_EQ(without.find("Pairs near each other"), std::string::npos);
}

TEST(Report, RepeatsByteForByte) {
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  const std::string first = writeReport(smallScene(), smallResult(), freshFolder("first"), options).file;
  const std::string second = writeReport(smallScene(), smallResult(), freshFolder("second"), options).file;
  EXPECT_EQ(textOf(first), textOf(second));
}

TEST(Report, SaysWhatAHoistCarries) {
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  scenes::AssembleResult result = smallResult();
  const auto pageOf = [&](const char* folder) {
    return textOf(writeReport(smallScene(), result, freshFolder(folder), options).file);
  };
  EXPECT_EQ(pageOf("by_hand").find("hoist"), std::string::npos);
  result.steps.front().hoist_N = 62.04;
  EXPECT_NE(pageOf("hoist").find("carries 62.0 N of the part's weight"), std::string::npos);
}

TEST(Report, WithoutPicturesItHasTheTables) {
  const std::string dir = freshFolder("bare");
  const ReportOptions options = {.command = {}, .progress = {}, .has_pictures = false};
  const ReportOutcome outcome = writeReport(smallScene(), smallResult(), dir, options);
  EXPECT_NE(textOf(outcome.file).find("<h2>Steps</h2>"), std::string::npos);
  for (const std::string& note : outcome.notes) EXPECT_EQ(note.find("pictures"), std::string::npos) << note;
}

struct EndOfWork : std::exception {};

TEST(Report, AStopWhileItsPicturesAreDrawnEndsIt) {
  int calls = 0;
  const ReportOptions options = {.command = {},
                                 .progress =
                                     [&calls](std::string_view doing, double) {
                                       if (doing == "pictures" && ++calls == 2) throw EndOfWork();
                                     },
                                 .width = 160,
                                 .height = 120};
  EXPECT_THROW(writeReport(smallScene(), smallResult(), freshFolder("stopped"), options), EndOfWork);
  EXPECT_EQ(calls, 2);
}

TEST(CheckPage, AStopWhileItsPicturesAreDrawnEndsIt) {
  scenes::CheckSettings settings;
  settings.has_maps = true;
  std::vector<scenes::DrawnPart> cubes(2);
  cubes[0].name = "below";
  cubes[1].name = "above";
  cubes[0].mesh = cubes[1].mesh = makeBox(Vec3::Constant(1e-2));
  cubes[1].X_WP = Pose::translation(Vec3(0, 0, 1e-2 + 1e-4));
  const scenes::CheckResult result = scenes::checkAssembly("two cubes", cubes, settings);
  ASSERT_EQ(result.maps.size(), 2u);
  int calls = 0;
  const Progress progress = [&calls](std::string_view, double) {
    if (++calls == 2) throw EndOfWork();
  };
  EXPECT_THROW(checkPage(result, "", progress), EndOfWork);
  EXPECT_EQ(calls, 2);
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

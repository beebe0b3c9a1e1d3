// SPDX-License-Identifier: BSD-3-Clause
#include "pages/sections.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "files/html.h"
#include "support/process/chromium.h"
#include "viewer/small_run.h"
#include "vps_scenes/run/assemble.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/report/report.h"

namespace vps::viewer {
namespace {

using test::freshFolder, test::smallResult, test::smallScene, test::textOf;

std::string encodedText(const std::string& text) {
  return base64(std::as_bytes(std::span(text)));
}

// Source: RFC 4648, section 10.
TEST(Base64, GivesTheExamplesOfItsStandard) {
  EXPECT_EQ(encodedText(""), "");
  EXPECT_EQ(encodedText("f"), "Zg==");
  EXPECT_EQ(encodedText("fo"), "Zm8=");
  EXPECT_EQ(encodedText("foo"), "Zm9v");
  EXPECT_EQ(encodedText("foob"), "Zm9vYg==");
  EXPECT_EQ(encodedText("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encodedText("foobar"), "Zm9vYmFy");
}

nlohmann::json dataOf(const std::string& html) {
  const std::string begin = "id=\"run-data\">";
  const std::size_t from = html.find(begin) + begin.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

TEST(RunView, HasThePartsAndTheirPlacesInTheRun) {
  scenes::Scene scene = smallScene();
  scene.parts[1].part.name = "</script><!--<script>";
  const RunView view = runView(scene, smallResult());
  if (view.html.empty()) GTEST_SKIP() << view.missing;
  const nlohmann::json data = dataOf(view.html);
  ASSERT_EQ(data["parts"].size(), 2u);
  EXPECT_TRUE(data["parts"][0]["fixed"]);
  EXPECT_EQ(data["steps"][0]["part"], 1);
  EXPECT_EQ(data["steps"][0]["name"], "1. </script><!--<script>");
  // The run lasts one second: 25 rows, and the last sample.
  const nlohmann::json& frames = data["frames"];
  ASSERT_EQ(frames.size(), 26u);
  EXPECT_EQ(frames.back()[0], 0.999);
  // Row: [time, step, position in mm, quaternion, force, depth in um, contacts]. At 0.64 s the peg has slid
  // for 40 ms.
  EXPECT_EQ(frames[16], nlohmann::json::parse("[0.64, 0, 2, 0, 0, 1, 0, 0, 0, 3, 3, 3]"));
  // The hole is 40 mm wide, and 30 mm high about the origin; the peg ends at 35 mm.
  EXPECT_NEAR(data["run"]["min"][2].get<double>(), -15, 1e-6);
  EXPECT_NEAR(data["run"]["max"][2].get<double>(), 35, 1e-6);
  EXPECT_LE(data["assembly"]["max"][2].get<double>(), 35 + 1e-6);
}

TEST(RunView, APartOfManyFacetsIsDrawnWithFewer) {
  scenes::Scene scene = smallScene();
  scene.parts[1].part.mesh = makeSphere(0.01, 8);
  ASSERT_GT(scene.parts[1].part.mesh.triangles.size(), 2 * kRunViewTriangles);
  const RunView view = runView(scene, smallResult());
  if (view.html.empty()) GTEST_SKIP() << view.missing;
  const std::size_t bytes = dataOf(view.html)["parts"][1]["triangles"].get<std::string>().size() * 3 / 4;
  EXPECT_LT(bytes, 12 * kRunViewTriangles * 3 / 2);
  EXPECT_GT(bytes, 12 * kRunViewTriangles / 4);
}

/// The console output of a browser without a display, which also saves a picture of the page.
std::string browse(const std::string& page, int width, int height, const std::string& picture) {
  const std::string command =
      "timeout 120 chromium --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--hide-scrollbars --virtual-time-budget=10000 --enable-logging=stderr --window-size=" +
      std::to_string(width) + "," + std::to_string(height) + " --screenshot='" + picture + "' 'file://" +
      page + "' 2>&1 | grep CONSOLE";
  std::string printed;
  FILE* pipe = popen(command.c_str(), "r");
  char chunk[512];
  while (pipe != nullptr && std::fgets(chunk, sizeof chunk, pipe) != nullptr) printed += chunk;
  if (pipe != nullptr) pclose(pipe);
  return printed;
}

TEST(RunView, ABrowserDrawsItAtTheWidthOfADeskAndOfAPhone) {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const RunView view = runView(smallScene(), smallResult());
  if (view.html.empty()) GTEST_SKIP() << view.missing;
  const std::string dir = freshFolder("browser");
  scenes::AssembleResult result = smallResult();
  writeReport(smallScene(), result, dir, {.command = {}, .progress = {}, .width = 160, .height = 120});
  // The page without the sections after the view.
  for (const int width : {1280, 400}) {
    const std::string picture = dir + "/browser_" + std::to_string(width) + ".png";
    EXPECT_EQ(browse(dir + "/report.html", width, 1000, picture), "");
    const Image image = loadPng(picture);
    ASSERT_EQ(image.width, width);
    // The part with the hole has the colour of lit steel: grey, neither white nor as dark as a line. It
    // covers some percent of the view.
    int grey = 0;
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
      const int r = image.rgb[i], g = image.rgb[i + 1], b = image.rgb[i + 2];
      grey += r > 90 && r < 210 && std::abs(r - g) < 12 && b > r;
    }
    EXPECT_GT(grey, 0.02 * width * 0.62 * width);
  }
}

TEST(RunView, ARealRunIsReadAndPlayedAtBothWidths) {
  if (!vps::test::Chromium::isThere()) GTEST_SKIP() << "chromium is not installed";
  const RunView small = runView(smallScene(), smallResult());
  if (small.html.empty()) GTEST_SKIP() << small.missing;
  scenes::Scene scene = scenes::loadScene(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml");
  const scenes::AssembleResult result = scenes::assemble(scene);
  ASSERT_FALSE(result.trace.empty());
  const std::string dir = freshFolder("real");
  writeReport(scene, result, dir, {.command = {}, .progress = {}, .width = 320, .height = 240});
  for (const int width : {1280, 400}) {
    vps::test::Chromium browser(dir + "/browser_" + std::to_string(width), width, 1000,
                                "file://" + dir + "/report.html");
    ASSERT_TRUE(
        browser.waitFor("document.readyState === 'complete' && document.querySelector('#run-view canvas')"));
    // No element makes the page wider than the screen. A wider table scrolls in its own box, with its whole
    // text large enough to read.
    EXPECT_LE(browser.evaluate("document.documentElement.scrollWidth").get<int>(), width);
    EXPECT_GE(browser.evaluate("document.querySelectorAll('table').length").get<int>(), 4);
    EXPECT_EQ(
        browser.evaluate("[...document.querySelectorAll('table')].filter(t => t.offsetWidth > innerWidth &&"
                         " getComputedStyle(t.parentElement).overflowX !== 'auto').length"),
        0);
    EXPECT_EQ(browser.evaluate(
                  "[...document.querySelectorAll('td')].filter(c => c.scrollWidth > c.clientWidth + 1 ||"
                  " parseFloat(getComputedStyle(c).fontSize) < 12).length"),
              0);
    EXPECT_EQ(browser.evaluate("[...document.images].filter(i => i.complete && !i.naturalWidth).length"), 0);
    // At another time the part is at another place.
    browser.evaluate("document.querySelector('#run-view').scrollIntoView()");
    const auto at = [&](double share) {
      browser.evaluate("(() => { const s = document.querySelector('#run-view input'); s.value = " +
                       std::to_string(share) + " * s.max; s.dispatchEvent(new Event('input')); })()");
      browser.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
      const std::string file = dir + "/at_" + std::to_string(width) + "_" + std::to_string(share) + ".png";
      browser.screenshot(file);
      return loadPng(file);
    };
    const Image begun = at(0), ended = at(1), again = at(0);
    // A peg of 8 mm moves by its length in a view of the whole scene, which changes more pixels than the
    // slider of about 20 x 20 pixels.
    EXPECT_GT(compare(begun, ended, 30).share_beyond * width * 1000, 1500);
    EXPECT_EQ(compare(begun, again, 2).share_beyond, 0) << "the same time gives the same picture";
    EXPECT_TRUE(browser.console().empty()) << browser.console().front();
  }
}

}  // namespace
}  // namespace vps::viewer

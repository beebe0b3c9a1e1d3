// SPDX-License-Identifier: BSD-3-Clause
// Runs and recordings in a browser: a part is moved to its target by mouse and by finger, and a recording is
// played, paused and scrubbed.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "beast/server.h"
#include "support/process/chromium.h"
#include "support/temporary_folder.h"
#include "vps_device/recording.h"
#include "vps_scenes/scene/scene.h"
#include "web/watched_run.h"

namespace vps::viewer {
namespace {

using vps::test::Chromium;

class WebRunInBrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!missingForWeb().empty()) GTEST_SKIP() << missingForWeb();
    if (!Chromium::isThere()) GTEST_SKIP() << "chromium is not installed";
  }
  void TearDown() override {
    browser_.reset();
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void serve(std::unique_ptr<WatchedRun> run, WebOptions options) {
    run_ = std::move(run);
    options.port = 0;
    options.stop = &stop_;
    server_ = std::make_unique<WebServer>(*run_, options);
    const std::string page = "http://127.0.0.1:" + std::to_string(server_->port()) + "/";
    thread_ = std::thread([this] { server_->serve(); });
    browser_.emplace((folder_.path() / "browser").string(), 1000, 700, page);
  }
  void servePegInHole() {
    WebOptions options;
    options.allows_hand = true;
    const scenes::Scene scene = scenes::loadScene(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml");
    serve(watchedScene(scene, options), options);
  }
  [[nodiscard]] std::string printed() const {
    std::string text;
    for (const std::string& line : browser_->console()) text += line + "\n";
    return text;
  }
  /// CSS display value of an element; "none": it is hidden.
  std::string shownAs(const std::string& id) {
    return browser_->evaluate("getComputedStyle(document.getElementById('" + id + "')).display")
        .get<std::string>();
  }
  double number(const std::string& expression) { return browser_->evaluate(expression).get<double>(); }
  bool isMounted(double limit_s) {
    return browser_->waitFor("vps.bodies[1] && vps.bodies[1].role === 'mounted'", limit_s);
  }

  /// The user of the page takes the peg, looks from the front, and moves the peg down into its hole. In the
  /// mouth of the hole the user also pushes the peg sideways by 0.5 mm, so that the wall guides it. Before
  /// the bottom the sideways force ends, since a peg that is pressed against the wall would move within its
  /// clearance when it is released.
  /// @param press, move, lift  mouse or finger events at a place of the page
  void bringHome(const std::function<void(double x, double y)>& press,
                 const std::function<void(double x, double y)>& move,
                 const std::function<void(double x, double y)>& lift) {
    ASSERT_TRUE(browser_->waitFor(
        "vps.bodies[1] && vps.bodies[1].role === 'in hand' && vps.hand && vps.hand.may_take", 120))
        << printed();
    browser_->evaluate("document.getElementById('take').click()");
    ASSERT_TRUE(browser_->waitFor("vps.hand.holder === vps.you"));
    browser_->evaluate(
        "const looks = document.getElementById('looks'); looks.value = 'front';"
        "looks.dispatchEvent(new Event('change'))");
    ASSERT_TRUE(browser_->waitFor("vps.placeOf(1)", 60));
    const double scale = number("vps.pixelsPerMetre()");
    bool is_home = false;
    for (int attempt = 0; attempt < 4 && !is_home; ++attempt) {
      const auto at = browser_->evaluate("vps.placeOf(1)");
      const double x = at[0], y = at[1];
      const double down_px = scale * number("vps.bodies[1].pose[2] - vps.targetOf(0)[2]");
      press(x, y);
      constexpr int kMoves = 50;
      for (int i = 1; i <= kMoves; ++i) {
        const double share = 1.04 * i / kMoves;  // a millimetre into the bottom, which stops the peg
        move(x + (share > 0.7 && share < 0.95 ? 0.5e-3 * scale : 0), y + share * down_px);
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
      }
      is_home = isMounted(15);
      lift(x, y + down_px);
    }
    EXPECT_TRUE(is_home) << printed();
    EXPECT_TRUE(browser_->waitFor("document.getElementById('verdict').textContent === 'fits'", 60))
        << browser_->evaluate("document.getElementById('news').textContent");
  }

  test::TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<WatchedRun> run_;
  std::unique_ptr<WebServer> server_;
  std::thread thread_;
  std::optional<Chromium> browser_;
};

TEST_F(WebRunInBrowser, APegIsBroughtHomeByTheMouse) {
  servePegInHole();
  bringHome([this](double x, double y) { browser_->mouse("mousePressed", x, y); },
            [this](double x, double y) { browser_->mouse("mouseMoved", x, y); },
            [this](double x, double y) { browser_->mouse("mouseReleased", x, y); });
  EXPECT_EQ(printed(), "");
}

TEST_F(WebRunInBrowser, APegIsBroughtHomeByAFinger) {
  servePegInHole();
  bringHome([this](double x, double y) { browser_->touch("touchStart", x, y); },
            [this](double x, double y) { browser_->touch("touchMove", x, y); },
            [this](double x, double y) { browser_->touch("touchEnd", x, y); });
  EXPECT_EQ(printed(), "");
}

// For a user who has not taken the part, the same motion turns the view and moves no part.
TEST_F(WebRunInBrowser, WhoHasNotTheRightToThePartMovesNothing) {
  servePegInHole();
  ASSERT_TRUE(browser_->waitFor("vps.bodies[1] && vps.bodies[1].role === 'in hand' && vps.placeOf(1)", 120))
      << printed();
  EXPECT_EQ(shownAs("player"), "none");                  // only recordings have a player
  std::this_thread::sleep_for(std::chrono::seconds(1));  // the part comes to rest in the hand
  const auto at = browser_->evaluate("vps.placeOf(1)");
  const double x = at[0], y = at[1], before_m = number("vps.bodies[1].pose[2]");
  browser_->mouse("mousePressed", x, y);
  for (int i = 1; i <= 20; ++i) browser_->mouse("mouseMoved", x, y + 5 * i);
  browser_->mouse("mouseReleased", x, y + 100);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_NEAR(number("vps.bodies[1].pose[2]"), before_m,
              1e-4);  // the page draws at 60 Hz, and the hand still settles
}

TEST_F(WebRunInBrowser, ARecordingPausesGoesOnAndIsScrubbed) {
  const device::RecordedRun recorded =
      device::loadRecording(VPS_SOURCE_DIR "/tests/scenes/recorded/peg_in_hole.mcap");
  serve(watchedRecording(recorded), {});
  // On a busy machine the recording may have ended before the browser connects.
  ASSERT_TRUE(browser_->waitFor("vps.playback", 60)) << printed();
  browser_->evaluate("vps.playback.is_playing || document.getElementById('play').click()");
  ASSERT_TRUE(browser_->waitFor("vps.playback.is_playing && vps.snapshots > 5", 60))
      << printed() << browser_->evaluate("JSON.stringify([vps.playback, vps.snapshots, vps.time_s])");
  EXPECT_EQ(shownAs("player"), "flex");
  const auto click = [this] { browser_->evaluate("document.getElementById('play').click()"); };
  const auto text = [this] { return browser_->evaluate("document.getElementById('play').textContent"); };
  EXPECT_EQ(text(), "Pause");
  click();
  ASSERT_TRUE(browser_->waitFor("!vps.playback.is_playing"));
  EXPECT_EQ(text(), "Play");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // messages that are still in transit
  const double stopped_s = number("vps.time_s");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ(number("vps.time_s"), stopped_s);
  const double middle_s = number("0.5 * (vps.playback.begin_s + vps.playback.end_s)");
  browser_->evaluate(
      "const at = document.getElementById('at'); at.value = 500;"
      "at.dispatchEvent(new Event('input')); at.dispatchEvent(new Event('change'))");
  const double length_s = number("vps.playback.end_s - vps.playback.begin_s");
  EXPECT_TRUE(browser_->waitFor(
      "Math.abs(vps.time_s - " + std::to_string(middle_s) + ") < " + std::to_string(0.02 * length_s), 10))
      << number("vps.time_s") << " of " << middle_s;
  EXPECT_EQ(browser_->evaluate("vps.playback.is_playing"), false);
  const double sought_s = number("vps.time_s");
  click();
  EXPECT_TRUE(
      browser_->waitFor("vps.playback.is_playing && vps.time_s > " + std::to_string(sought_s + 0.05), 20));
  EXPECT_EQ(printed(), "");
}

}  // namespace
}  // namespace vps::viewer

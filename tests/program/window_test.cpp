// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view` as its users see it, on a display in memory (Xvfb) with keys from xdotool.
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "program.h"
#include "support/child_process.h"
#include "vps_scenes/display.h"
#include "vps_scenes/network/session_pointers.h"
#include "vps_scenes/scene.h"
#include "vps_viewer/model_view.h"
#include "vps_viewer/renderer.h"
#include "vps_viewer/stereo.h"
#include "vps_viewer/window.h"
#include "window/camera_motion.h"
#include "window/timeline.h"

namespace vps {
namespace {

using namespace std::chrono_literals;
using viewer::Image;

std::string outputOf(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  pclose(pipe);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

bool has(const char* program) {
  return std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) == 0;
}

class Window : public Program {
 protected:
  // The part of a window of 1280 x 720 that the panels leave.
  static constexpr viewer::PictureSize kPicture = {950, 656};

  void SetUp() override {
    Program::SetUp();
    if (!viewer::missingForWindow().empty()) GTEST_SKIP() << viewer::missingForWindow();
    if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "needs Xvfb and xdotool (Debian: xvfb, xdotool)";
    const std::string number = (folder_ / "display.txt").string();
    // Without -noreset the server starts anew when its last client leaves, as xdotool does, and refuses a
    // window that opens at that moment.
    // A number of this process alone: of two servers that share one, the first to end takes the other's
    // socket.
    xvfb_ = std::stoi(outputOf("Xvfb :" + std::to_string(1000 + getpid() % 30000) +
                               " -noreset -displayfd 3 -screen 0 1400x900x24 3>'" + number +
                               "' >/dev/null 2>&1 & echo $!"));
    ASSERT_TRUE(soon([&] { return slurp(number).find('\n') != std::string::npos; }));
    const std::string text = slurp(number);
    display_number_ = text.substr(0, text.find('\n'));
    display_ = "DISPLAY=:" + display_number_ + " ";
  }
  void TearDown() override {
    if (view_ > 0) kill(view_, SIGKILL);
    if (xvfb_ > 0) kill(xvfb_, SIGTERM);
    for (int i = 0; i < 50 && fs::exists("/tmp/.X11-unix/X" + display_number_); ++i)
      std::this_thread::sleep_for(100ms);
    Program::TearDown();
  }

  /// Waits for a minute at most.
  template <class Condition>
  static bool soon(Condition is_true) {
    for (int i = 0; i < 600; ++i) {
      if (is_true()) return true;
      std::this_thread::sleep_for(100ms);
    }
    return false;
  }

  void open(const std::string& arguments) {
    view_ = std::stoi(outputOf("cd '" + folder_.string() + "'; (" + display_ +
                               " exec '" VPS_PROGRAM "' view " + arguments +
                               " >out.txt 2>err.txt & echo $! >pid.txt; wait $!; echo $? >status.txt) "
                               "</dev/null >/dev/null 2>&1 & sleep 0.3; cat pid.txt"));
    ASSERT_TRUE(soon([&] {
      window_ = outputOf(display_ + "xdotool search --name 'vps view' 2>/dev/null");
      return !window_.empty() || fs::exists(folder_ / "status.txt");
    }));
    ASSERT_FALSE(window_.empty()) << slurp(folder_ / "err.txt");
    xdotool("windowfocus " + window_);
  }
  void xdotool(const std::string& arguments) const {
    std::system((display_ + "xdotool " + arguments + " >/dev/null 2>&1").c_str());
  }
  /// The window's content, by its own key.
  Image picture() {
    const fs::path file = folder_ / ("view_" + std::to_string(++pictures_) + ".png");
    for (int i = 0; i < 20 && !fs::exists(file); ++i) {
      xdotool("key p");
      for (int k = 0; k < 50 && !fs::exists(file); ++k) std::this_thread::sleep_for(100ms);
    }
    // A key that was sent twice saves twice.
    while (fs::exists(folder_ / ("view_" + std::to_string(pictures_ + 1) + ".png"))) ++pictures_;
    return fs::exists(file) ? viewer::loadPng(file.string()) : Image();
  }
  /// Whether the window shows this picture, or does so soon.
  bool shows(const Image& wanted) {
    return soon([&] {
      const Image now = picture();
      if (now.width < wanted.width || now.height < wanted.height) return false;
      Image crop(wanted.width, wanted.height);
      for (int y = 0; y < crop.height; ++y)
        std::copy_n(now.at(0, y), 3 * static_cast<std::size_t>(crop.width), crop.at(0, y));
      return viewer::compare(crop, wanted, 2).share_beyond == 0;  // 2: as for other pictures, image.h
    });
  }
  /// The exit status.
  int close(const std::string& key = "q") {
    xdotool("key " + key);
    if (!soon([&] { return !slurp(folder_ / "status.txt").empty(); })) return -1;
    view_ = 0;
    return std::stoi(slurp(folder_ / "status.txt"));
  }
  /// What the finished assembly looks like from a standard view, or on a screen of a display file.
  Image expected(std::size_t view, viewer::StereoMode mode = viewer::StereoMode::Mono,
                 const std::string& display_file = "", int screen_row = 0) const {
    const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
    const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
    const scenes::Snapshot snapshot = viewer::sceneTour(scene).at(0);
    viewer::DrawOptions options;
    options.width = kPicture.width;
    options.height = kPicture.height;
    options.supersampling = 1;
    options.show_legend = false;
    viewer::Renderer renderer(drawn);
    const viewer::Camera camera =
        viewer::cameraFor(viewer::standardViews()[view], viewer::snapshotBounds(drawn, snapshot), kPicture);
    if (!display_file.empty()) {
      const scenes::Display display = scenes::loadDisplay((folder_ / display_file).string());
      const auto eye = [&](int side) {
        return viewer::cameraFor(display, display.screens[0], display.viewers[0].eye_S(side));
      };
      return viewer::renderStereo(renderer, snapshot, {eye(-1), eye(1)}, options, mode)[0];
    }
    if (mode == viewer::StereoMode::Mono) return renderer.render(snapshot, camera, options);
    const double distance_m = (camera.eye_W - camera.target_W).norm();
    const viewer::EyePair eyes =
        viewer::eyesOf(camera, viewer::kEyeShare * distance_m, double(kPicture.width) / kPicture.height);
    return viewer::renderStereo(renderer, snapshot, eyes, options, mode, {0, 0, screen_row})[0];
  }
  /// The part of the window that shows the scene.
  Image scenePicture() {
    const Image whole = picture();
    Image crop(kPicture.width, kPicture.height);
    if (whole.width < crop.width || whole.height < crop.height) return crop;
    for (int y = 0; y < crop.height; ++y)
      std::copy_n(whole.at(0, y), 3 * static_cast<std::size_t>(crop.width), crop.at(0, y));
    return crop;
  }
  /// The same once it is drawn in full, and rests.
  Image restingPicture() {
    Image last = scenePicture();
    int same = 0;  // a picture in full may take longer than the time between two looks
    soon([&] {
      std::this_thread::sleep_for(1s);
      Image now = scenePicture();
      same = now.rgb == last.rgb ? same + 1 : 0;
      last = std::move(now);
      return same >= 4;
    });
    return last;
  }

  std::string display_, window_, display_number_;
  pid_t xvfb_ = 0, view_ = 0;
  int pictures_ = 0;
};

TEST_F(Window, OpensShowsTheSceneObeysKeysAndClosesCleanly) {
  open("scene.toml");
  EXPECT_TRUE(shows(expected(0)));
  xdotool("key 6");
  EXPECT_TRUE(shows(expected(5)));
  const Image before = picture();
  xdotool("key question");
  EXPECT_TRUE(soon([&] { return viewer::compare(picture(), before, 2).share_beyond > 0.1; }))
      << "the list of keys covers a part of the picture";
  xdotool("key Escape");
  EXPECT_TRUE(shows(expected(5)));
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "err.txt"), "");
}

TEST_F(Window, SurvivesSizesFromOnePixelToMoreThanTheScreen) {
  open("scene.toml");
  EXPECT_TRUE(shows(expected(0)));
  for (const char* size : {"1 1", "40 900", "3000 2000", "1280 720"}) {
    xdotool("windowsize " + window_ + " " + size);
    std::this_thread::sleep_for(1s);
  }
  xdotool("key 2");
  EXPECT_TRUE(shows(expected(1)));
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, ARunThatIsWatchedIsRecordedWithTheSameBits) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  ASSERT_EQ(run("assemble " + scene + " --out out --no-pictures --record alone.mcap").status, 0);
  open(scene + " --run --speed 0 --record watched.mcap");
  EXPECT_TRUE(soon([&] { return fs::exists(folder_ / "watched.mcap"); }));
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "watched.mcap"), slurp(folder_ / "alone.mcap"));

  fs::remove(folder_ / "status.txt");
  open("watched.mcap");
  xdotool("key End");
  EXPECT_GT(picture().width, 0);
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, APegThatIsDraggedIntoItsHoleByTheMouseIsMountedRecordedAndReplayed) {
  const std::string scene = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  open(scene + " --hand mouse --record dragged.mcap");
  // Where the peg's middle is, and where it is once mounted: the camera is that of the tour's first picture.
  const scenes::Scene loaded = scenes::loadScene(scene);
  const viewer::RenderScene drawn = viewer::drawnMeshes(loaded);
  const scenes::SceneStep& step = loaded.steps[0];
  ASSERT_TRUE(soon([&] { return !outputOf("ls '" + folder_.string() + "' | grep unfinished").empty(); }));
  scenes::Snapshot taken;
  taken.step = 0;
  taken.has_target = true;
  taken.target_part = step.part;
  taken.X_WP_target = step.X_WP_target;
  taken.bodies = {{step.part, step.X_WP_start, scenes::BodyRole::InHand}};
  const viewer::Camera camera =
      viewer::cameraFor(viewer::standardViews()[1], viewer::snapshotBounds(drawn, taken), kPicture);
  const Vec3 middle_P = bounds(loaded.parts[step.part].part.mesh).center();
  const auto from = camera.project(step.X_WP_start * middle_P, kPicture.width, kPicture.height);
  const auto to = camera.project(step.X_WP_target * middle_P, kPicture.width, kPicture.height);
  // Once the peg is in the mouth it is pushed aside too, by half a millimetre, so that the wall guides it.
  const auto at = [&](double share) {
    constexpr int kAside_px = 4;
    return std::to_string(std::lround(from[0]) + (share > 0.7 ? kAside_px : 0)) + " " +
           std::to_string(std::lround(from[1] + share * (to[1] - from[1])));
  };
  // On a busy machine the window may still show what was before the run, where there is nothing to grab: then
  // again.
  bool is_done = false;
  for (int attempt = 0; attempt < 4 && !is_done; ++attempt) {
    xdotool("key 2");                 // from the front, where down on the screen is down in the scene
    std::this_thread::sleep_for(2s);  // the first snapshot of the run is shown
    xdotool("key f");
    ASSERT_GT(picture().width, 0);  // so the keys before have been obeyed
    xdotool("mousemove " + at(0) + " mousedown 1");
    std::this_thread::sleep_for(500ms);
    for (int i = 1; i <= 50; ++i) {
      xdotool("mousemove " + at(1.04 * i / 50));  // a millimetre into the bottom, which stops the peg
      std::this_thread::sleep_for(30ms);
    }
    for (int i = 0; i < 150 && !is_done; ++i) {
      std::this_thread::sleep_for(100ms);
      is_done = fs::exists(folder_ / "dragged.mcap");
    }
    xdotool("mouseup 1");
  }
  EXPECT_TRUE(is_done) << "the step is not done";
  EXPECT_EQ(close(), 0);
  const Ran replayed = run("replay dragged.mcap --json replayed.json --out replayed");
  EXPECT_EQ(replayed.status, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("fits"), std::string::npos) << replayed.out;
  EXPECT_EQ(replayed.out.find("by contact: no"), std::string::npos) << replayed.out;
  EXPECT_NE(replayed.out.find("the same bits"), std::string::npos) << replayed.out;
}

TEST_F(Window, AStepThatIsTakenBackAndDoneAgainGivesTheSameBits) {
  write("two.toml",
        "unit = 'mm'\nrelease_s = 0.2\n[[part]]\nfile = 'plate.stl'\nfixed = true\n"
        "[[part]]\nname = 'left'\nfile = 'pin.stl'\npose = {position = [-5, 0, 9]}\n"
        "[[part]]\nname = 'right'\nfile = 'pin.stl'\npose = {position = [5, 0, 9]}\n"
        "[[step]]\npart = 'left'\nstart = {position = [-5, 0, 9.5]}\ntolerance = '0.5mm'\n"
        "[[step]]\npart = 'right'\nstart = {position = [5, 0, 9.5]}\ntolerance = '0.5mm'\n");
  open("two.toml --run --speed 0 --silent --record run.mcap");
  const auto isRecorded = [&](const std::string& name) {
    return soon([&] { return fs::exists(folder_ / name); });
  };
  ASSERT_TRUE(isRecorded("run.mcap")) << slurp(folder_ / "err.txt");
  std::this_thread::sleep_for(2s);  // the window has taken the result as well
  xdotool("key z");
  ASSERT_TRUE(isRecorded("run_2.mcap")) << "only the second step";
  std::this_thread::sleep_for(2s);
  xdotool("key z");
  ASSERT_TRUE(isRecorded("run_3.mcap"));
  EXPECT_EQ(slurp(folder_ / "run_2.mcap"), slurp(folder_ / "run_3.mcap"));
  // The second step is taken back, and put in place again where it was without a run.
  xdotool("key 2");
  const Image done = restingPicture();
  xdotool("key z");
  xdotool("key y");
  EXPECT_TRUE(shows(done));
  EXPECT_EQ(close(), 0);
  const Ran replayed = run("replay run_2.mcap --out replayed");
  EXPECT_NE(replayed.out.find("right"), std::string::npos) << replayed.out;
  EXPECT_EQ(replayed.out.find("left"), std::string::npos) << replayed.out;
  EXPECT_NE(replayed.out.find("the same bits"), std::string::npos) << replayed.out;
}

TEST_F(Window, APartIsTakenFreelyMovedPutDownAndBroughtBack) {
  write("free.toml",
        "unit = 'mm'\n[[part]]\nfile = 'plate.stl'\nfixed = true\n"
        "[[part]]\nname = 'pin'\nfile = 'pin.stl'\npose = {position = [0, 0, 9]}\n"
        "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 30]}\n");
  open("free.toml --silent");
  xdotool("key u");
  xdotool("key 2");
  std::this_thread::sleep_for(1s);
  xdotool("key f");
  const Image before = restingPicture();
  // Where the pin is drawn.
  const scenes::Scene loaded = scenes::loadScene((folder_ / "free.toml").string());
  const viewer::RenderScene drawn = viewer::drawnMeshes(loaded);
  scenes::Snapshot lying;
  lying.bodies = {{0, loaded.parts[0].X_WP, scenes::BodyRole::Mounted},
                  {1, loaded.steps[0].X_WP_start, scenes::BodyRole::Mounted}};
  const viewer::Camera camera =
      viewer::cameraFor(viewer::standardViews()[1], viewer::snapshotBounds(drawn, lying), kPicture);
  const auto at = camera.project(loaded.steps[0].X_WP_start.p, kPicture.width, kPicture.height);
  const auto place = [&](int aside_px) {
    return std::to_string(std::lround(at[0]) + aside_px) + " " + std::to_string(std::lround(at[1]));
  };
  xdotool("mousemove " + place(0) + " click 1");
  xdotool("key Return");
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), before, 20).share_beyond > 1e-4; }))
      << "the pin in hand is blue";
  std::this_thread::sleep_for(2s);  // until the clutch has closed
  xdotool("mousemove " + place(0) + " mousedown 1");
  std::this_thread::sleep_for(300ms);
  for (int i = 1; i <= 20; ++i) {
    xdotool("mousemove " + place(5 * i));
    std::this_thread::sleep_for(30ms);
  }
  std::this_thread::sleep_for(1s);
  xdotool("mouseup 1");
  std::this_thread::sleep_for(300ms);
  xdotool("key Return");
  xdotool("mousemove 5 5");
  const Image after = restingPicture();
  EXPECT_GT(viewer::compare(after, before, 20).share_beyond, 5e-3) << "the pin lies elsewhere";
  xdotool("key z");
  EXPECT_TRUE(shows(before));
  xdotool("key y");
  EXPECT_TRUE(shows(after));
  EXPECT_EQ(close(), 0);
}

// Remote assistance: what others point at is marked in the window, and others see where it points.
TEST_F(Window, FollowsASessionShowsWhereOthersPointAndPointsItself) {
  write("scene.toml",
        std::string(kScene) +
            "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 12]}\ntarget = {position = [0, 0, "
            "9]}\ntolerance = '2mm'\n");
  const std::string session = "window-" + std::to_string(getpid());
  const auto start = [&](std::vector<std::string> words, const char* output) {
    words.insert(words.begin(), VPS_PROGRAM);
    words.insert(words.end(), {"--session", session});
    return test::ChildProcess(std::move(words), (folder_ / output).string());
  };
  test::ChildProcess render = start(
      {"render", (folder_ / "scene.toml").string(), "--no-pictures", "--out", (folder_ / "out").string()},
      "render.txt");
  open("--session " + session + " --silent");  // waits for the session, and for its device
  restingPicture();
  // The middle of the plate's upper side, from the camera that the window begins with.
  const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
  const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const viewer::Camera camera = viewer::cameraFor(
      viewer::standardViews()[0], viewer::snapshotBounds(drawn, viewer::sceneTour(scene).at(0)), kPicture);
  const Box plate = bounds(scene.parts[0].part.mesh);
  const Vec3 p_W(0.8 * plate.max.x(), 0.8 * plate.min.y(), plate.max.z());
  const auto at = camera.project(p_W, kPicture.width, kPicture.height);
  const auto isMarked = [&](const std::array<int, 3>& color) {
    const Image now = scenePicture();
    const unsigned char* pixel = now.at(static_cast<int>(at[0]), static_cast<int>(at[1]));
    for (int i = 0; i < 3; ++i)
      if (std::abs(pixel[i] - color[static_cast<std::size_t>(i)]) > 2) return false;
    return true;
  };
  constexpr std::array<int, 3> kOther = {214, 39, 140}, kOwn = {20, 130, 60};
  scenes::SessionPointers pointers(session);
  EXPECT_FALSE(isMarked(kOther));
  pointers.point(1, p_W);
  EXPECT_TRUE(soon([&] {
    (void)pointers.take();
    return isMarked(kOther);
  })) << "the mark of another watcher";
  pointers.point(1, {});
  EXPECT_TRUE(soon([&] {
    (void)pointers.take();
    return !isMarked(kOther);
  }));
  xdotool("mousemove " + std::to_string(std::lround(at[0])) + " " + std::to_string(std::lround(at[1])) +
          " click 1");
  std::optional<Vec3> seen_W;
  for (int attempt = 0; attempt < 10 && !seen_W; ++attempt) {
    xdotool("key m");
    ASSERT_GT(picture().width, 0);  // so the key has been obeyed, and a second one would take the mark away
    for (int i = 0; i < 50 && !seen_W; ++i) {
      for (const scenes::SessionPointer& pointer : pointers.take()) seen_W = pointer.p_W;
      std::this_thread::sleep_for(100ms);
    }
  }
  EXPECT_TRUE(seen_W) << "the mark of the window";
  // A pixel is about a tenth of a millimetre here; a whole millimetre is still the place that was clicked.
  EXPECT_LT((seen_W.value_or(Vec3::Constant(1)) - p_W).norm(), 1e-3);
  EXPECT_TRUE(isMarked(kOwn));
  const Image before = restingPicture();  // with the mark, which stays
  test::ChildProcess device = start({"device"}, "device.txt");
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), before, 20).share_beyond > 1e-4; }))
      << "the window shows the run";
  EXPECT_EQ(render.wait(), 0) << slurp(folder_ / "render.txt");
  EXPECT_GT(picture().width, 0);  // so it has read the verdict
  EXPECT_EQ(close(), 0) << slurp(folder_ / "err.txt");
}

TEST_F(Window, ASessionThatIsLeftBeforeItsVerdictIsNotReportedAsFit) {
  write("scene.toml", std::string(kScene) + "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 12]}\n");
  const std::string session = "left-" + std::to_string(getpid());
  const test::ChildProcess render({VPS_PROGRAM, "render", (folder_ / "scene.toml").string(), "--no-pictures",
                                   "--out", (folder_ / "out").string(), "--session", session},
                                  (folder_ / "render.txt").string());  // waits for a device
  open("--session " + session + " --silent");
  EXPECT_GT(picture().width, 0) << slurp(folder_ / "render.txt");
  EXPECT_EQ(close(), 3) << slurp(folder_ / "err.txt");
}

TEST_F(Window, ThePlannedPathIsShownAndHidden) {
  write("scene.toml", std::string(kScene) + "[[step]]\npart = 'pin'\nstart = {position = [0, 0, 40]}\n");
  open("scene.toml");
  xdotool("key Down");
  xdotool("key 2");
  std::this_thread::sleep_for(1s);
  xdotool("key f");
  const Image without = restingPicture();
  xdotool("key w");
  const Image with = restingPicture();
  // A line of 6 pixels over at least a tenth of the picture's height.
  EXPECT_GT(viewer::compare(with, without, 20).share_beyond, 4 * 0.1 * 656 / (950.0 * 656));
  xdotool("key w");
  EXPECT_TRUE(shows(without));
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, ShowsStereoAndSwitchesItsModeByAKey) {
  using enum viewer::StereoMode;
  open("scene.toml --stereo anaglyph");
  EXPECT_TRUE(shows(expected(0, Anaglyph)));
  for (const viewer::StereoMode mode : {Interleaved, Mono, SideBySide, TopBottom}) {
    xdotool("key s");
    EXPECT_TRUE(shows(expected(0, mode))) << viewer::toText(mode);
  }
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, ShowsTheModelsOfContactInPlaceOfTheParts) {
  open("scene.toml --show voxels");
  const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
  viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const viewer::ModelView models(scene, {.has_voxels = true}, drawn);
  const scenes::Snapshot snapshot = viewer::sceneTour(scene).at(0);
  viewer::DrawOptions options;
  options.width = kPicture.width;
  options.height = kPicture.height;
  options.supersampling = 1;
  options.show_legend = options.show_edges = false;
  viewer::Renderer renderer(drawn);
  const Image wanted = renderer.render(
      snapshot,
      viewer::cameraFor(viewer::standardViews()[0], viewer::snapshotBounds(drawn, snapshot), kPicture),
      options);
  EXPECT_TRUE(shows(wanted));
  EXPECT_GT(viewer::compare(wanted, expected(0), 20).share_beyond, 0.01) << "which differs from the parts";
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, IsAScreenOfADisplayFile) {
  write("wall.toml",
        "[scene]\npose = {position = [0, 0.3, 0.6]}\nscale = 12\n[[screen]]\nlower_left = [-0.8, 0, 0]\n"
        "lower_right = [0.8, 0, 0]\nupper_left = [-0.8, 0, 1.1]\n"
        "[[viewer]]\nhead = {position = [0.3, -1, 0.8], rpy_deg = [90, 0, 0]}\n");
  open("scene.toml --display wall.toml --stereo top_bottom");
  EXPECT_TRUE(shows(expected(0, viewer::StereoMode::TopBottom, "wall.toml")));
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, InterleavedRowsStayWithTheScreensRowsWhereverTheWindowIs) {
  open("scene.toml --stereo interleaved");
  const auto eyeOf = [&](int row) {  // the same picture with the rows of both eyes exchanged, or not
    return expected(0, viewer::StereoMode::Interleaved, "", row);
  };
  xdotool("windowmove " + window_ + " 20 41");
  EXPECT_TRUE(shows(eyeOf(41)));
  xdotool("windowmove " + window_ + " 20 10");
  EXPECT_TRUE(shows(eyeOf(10)));
  EXPECT_NE(eyeOf(41).rgb, eyeOf(10).rgb);
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, ARunGoesOnWithoutPicturesWhereTheDriverIsTooOldForThem) {
  display_ += "MESA_GL_VERSION_OVERRIDE=3.3 ";  // enough for the window, too old for the renderer
  open(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml --run --speed 0 --silent --record run.mcap");
  EXPECT_TRUE(soon([&] { return fs::exists(folder_ / "run.mcap"); })) << slurp(folder_ / "err.txt");
  const Image whole = picture();
  ASSERT_GT(whole.width, 0);
  if (const char* kept = std::getenv("VPS_KEEP_PICTURES"))
    viewer::savePng(whole, std::string(kept) + "/no_gl.png");
  int ink = 0;  // of the message in the middle of where the picture would be
  for (int y = 250; y < 400; ++y)
    for (int x = 100; x < 850; ++x) ink += whole.at(x, y)[0] < 100;
  EXPECT_GT(ink, 300);
  EXPECT_EQ(close(), 0);
}

TEST_F(Window, ClosingAWindowWithARunStopsTheRun) {
  open(VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml --run");
  std::this_thread::sleep_for(2s);
  EXPECT_EQ(close(), 0);
}

TEST_F(Program, AWindowWithoutADisplayIsRefusedInWords) {
  if (!viewer::missingForWindow().empty()) GTEST_SKIP() << viewer::missingForWindow();
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  expectRefused("view scene.toml", "no window can be opened");
  expectRefused("view missing.toml", "missing.toml");
  expectRefused("view scene.toml --width 0", "--width");
  expectRefused("view", "--session NAME");
  expectRefused("view scene.toml --session x", "leave out the file");
  expectRefused("view --session nobody-" + std::to_string(getpid()), "no window can be opened");
  expectRefused("view scene.toml --hand spoon", "known are dual_arm");
}

TEST_F(Program, AWatcherWhoseDisplayIsGonePrintsInstead) {
  if (!viewer::missingForWindow().empty()) GTEST_SKIP() << viewer::missingForWindow();
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", ":4711", 1);  // which nobody serves
  test::ChildProcess watch({VPS_PROGRAM, "watch", "--session", "nobody-" + std::to_string(getpid())},
                           (folder_ / "watch.txt").string());
  unsetenv("DISPLAY");
  const auto hasWords = [&](const char* words) {
    return slurp(folder_ / "watch.txt").find(words) != std::string::npos;
  };
  for (int i = 0; i < 300 && watch.isRunning() && !hasWords("waiting for the session"); ++i)
    std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(watch.isRunning());
  EXPECT_TRUE(hasWords("waiting for the session")) << slurp(folder_ / "watch.txt");
  EXPECT_TRUE(hasWords("no window can be opened")) << slurp(folder_ / "watch.txt");
  watch.interrupt();
  EXPECT_EQ(watch.wait(), 2) << "stopped";
}

TEST_F(Window, ADisplayWithAnOldOpenGlIsRefusedInWords) {
  const Ran ran = run("view scene.toml >old.txt 2>&1; env " + display_ +
                      "MESA_GL_VERSION_OVERRIDE=2.1 '" VPS_PROGRAM "' view scene.toml");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("OpenGL 3.3"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace vps

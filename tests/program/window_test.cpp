// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view` as its users see it, on a display in memory (Xvfb) with keys from xdotool.
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "support/process/child_process.h"
#include "view/camera_motion.h"
#include "view/picture_worker.h"
#include "vps_scenes/network/session_pointers.h"
#include "vps_scenes/scene/display.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/model_meshes.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/draw/stereo.h"
#include "window_on_display.h"

namespace vps {
namespace {

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
  // Positions of the peg's middle at the start and after mounting; the camera is that of the tour's first
  // picture.
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
  // After the peg has entered the mouth, it is also pushed sideways by half a millimetre, so that the wall
  // guides it.
  const auto at = [&](double share) {
    constexpr int kAside_px = 4;
    return std::to_string(std::lround(from[0]) + (share > 0.7 ? kAside_px : 0)) + " " +
           std::to_string(std::lround(from[1] + share * (to[1] - from[1])));
  };
  // On a busy machine the window may still show the scene before the run, in which nothing can be grabbed;
  // the test then tries again.
  bool is_done = false;
  for (int attempt = 0; attempt < 4 && !is_done; ++attempt) {
    xdotool("key 2");  // from the front, where down on the screen is down in the scene
    settle();
    std::this_thread::sleep_for(2s);  // the first snapshot of the run is shown
    xdotool("key f");
    ASSERT_GT(picture().width, 0);  // so the window has handled the keys before
    xdotool("mousemove " + at(0) + " mousedown 1");
    std::this_thread::sleep_for(500ms);
    for (int i = 1; i <= 50; ++i) {
      xdotool("mousemove " +
              at(1.04 * i / 50));  // the last position is a millimetre below the bottom, which stops the peg
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
  restingPicture();  // so the window has also received the result
  xdotool("key z");
  ASSERT_TRUE(isRecorded("run_2.mcap")) << "only the second step";
  restingPicture();
  xdotool("key z");
  ASSERT_TRUE(isRecorded("run_3.mcap"));
  EXPECT_EQ(slurp(folder_ / "run_2.mcap"), slurp(folder_ / "run_3.mcap"));
  // The second step is undone, and then redone without a run.
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
  settle();
  xdotool("key f");
  const Image before = restingPicture();
  // The place where the pin is drawn.
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
  // If the clutch has not closed yet, the pin does not move; the test then tries again.
  const double moved_share = 5e-3;
  double share = 0;
  for (int attempt = 0; attempt < 3 && share <= moved_share; ++attempt) {
    std::this_thread::sleep_for(2s);
    xdotool("mousemove " + place(0) + " mousedown 1");
    settle();
    for (int i = 1; i <= 20; ++i) {
      xdotool("mousemove " + place(5 * i));
      std::this_thread::sleep_for(30ms);
    }
    for (int i = 0; i < 10 && share <= moved_share; ++i) {
      std::this_thread::sleep_for(200ms);
      share = viewer::compare(scenePicture(), before, 20).share_beyond;
    }
    xdotool("mouseup 1");
    settle();
  }
  xdotool("key Return");
  xdotool("mousemove 5 5");
  const Image after = restingPicture();
  EXPECT_GT(viewer::compare(after, before, 20).share_beyond, moved_share) << "the pin lies elsewhere";
  xdotool("key z");
  EXPECT_TRUE(shows(before));
  xdotool("key y");
  EXPECT_TRUE(shows(after));
  EXPECT_EQ(close(), 0);
}

// Remote assistance: the window marks the points at which others point, and others see where the window
// points.
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
  // The middle of the plate's upper side, in the first view of the window.
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
    ASSERT_GT(picture().width, 0);  // so the window has handled the key; a second key would remove the mark
    for (int i = 0; i < 50 && !seen_W; ++i) {
      for (const scenes::SessionPointer& pointer : pointers.take()) seen_W = pointer.p_W;
      std::this_thread::sleep_for(100ms);
    }
  }
  EXPECT_TRUE(seen_W) << "the mark of the window";
  // A pixel is about a tenth of a millimetre, so a point within a millimetre counts as the clicked point.
  EXPECT_LT((seen_W.value_or(Vec3::Constant(1)) - p_W).norm(), 1e-3);
  EXPECT_TRUE(isMarked(kOwn));
  const Image before = restingPicture();  // with the mark, which remains
  test::ChildProcess device = start({"device"}, "device.txt");
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), before, 20).share_beyond > 1e-4; }))
      << "the window shows the run";
  EXPECT_EQ(render.wait(), 0) << slurp(folder_ / "render.txt");
  EXPECT_GT(picture().width, 0);  // so the window has read the verdict
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
  settle();  // the view is fitted to the step
  xdotool("key f");
  const Image without = restingPicture();
  xdotool("key w");
  // A line of 6 pixels over at least a tenth of the picture's height.
  const double least_share = 4 * 0.1 * 656 / (950.0 * 656);
  double share = 0;
  soon([&] {
    share = viewer::compare(scenePicture(), without, 20).share_beyond;
    return share > least_share;
  });
  EXPECT_GT(share, least_share);
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
    if (mode == Mono) xdotool("key s");  // past spectral, whose two pictures DisplayTiles looks at
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

TEST_F(Window, ShowsAllPicturesOfADisplayFileAndOneAloneByAKey) {
  write("wall.toml",
        "[scene]\npose = {position = [0, 0.3, 0.6]}\nscale = 12\n"
        "[[screen]]\nname = 'front'\nlower_left = [-0.8, 0, 0]\nlower_right = [0.8, 0, 0]\n"
        "upper_left = [-0.8, 0, 1.1]\n"
        "[[screen]]\nname = 'floor'\nlower_left = [-0.8, -1, 0]\nlower_right = [0.8, -1, 0]\n"
        "upper_left = [-0.8, 0, 0]\n"
        "[[viewer]]\nname = 'anna'\nhead = {position = [0.3, -1.2, 0.8], rpy_deg = [90, 0, 0]}\n"
        "[[viewer]]\nname = 'ben'\nhead = {position = [-0.3, -1.2, 0.9], rpy_deg = [90, 0, 0]}\n");
  open("scene.toml --display wall.toml --stereo anaglyph");
  const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
  const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const scenes::Snapshot snapshot = viewer::sceneTour(scene).at(0);
  const scenes::Display display = scenes::loadDisplay((folder_ / "wall.toml").string());
  const auto outputs = viewer::outputsOf(display, viewer::StereoMode::Anaglyph);
  ASSERT_EQ(outputs.size(), 4u);
  viewer::PictureRequest wanted;
  wanted.snapshot = snapshot;
  wanted.stereo = viewer::StereoMode::Anaglyph;
  wanted.options.width = kPicture.width;
  wanted.options.height = kPicture.height;
  wanted.options.supersampling = 1;
  wanted.options.show_legend = false;
  const auto places = viewer::tilePlaces(outputs, kPicture);
  for (std::size_t i = 0; i < outputs.size(); ++i)
    wanted.tiles.push_back(
        {viewer::eyesOf(display, display.screens[outputs[i].screen], display.viewers[outputs[i].viewer]),
         places[i], 0});
  viewer::Renderer renderer(drawn);
  const Image all = viewer::drawInFull(renderer, wanted);
  // The names of the views cover a little of each picture.
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), all, 2).share_beyond < 0.02; }));
  EXPECT_GT(viewer::compare(scenePicture(), all, 2).share_beyond, 0.0005) << "the names";

  xdotool("key o");  // the front as Anna sees it
  EXPECT_TRUE(shows(expected(0, viewer::StereoMode::Anaglyph, "wall.toml")));
  for (int i = 0; i < 4; ++i) xdotool("key o");
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), all, 2).share_beyond < 0.02; }));

  xdotool("key F11");  // hides the panels
  EXPECT_TRUE(soon([&] { return picture().width == 1400; }));
  EXPECT_EQ(picture().height, 900);
  xdotool("key F11");
  EXPECT_TRUE(soon([&] { return viewer::compare(scenePicture(), all, 2).share_beyond < 0.02; }));
  EXPECT_EQ(close(), 0);

  fs::remove(folder_ / "status.txt");
  open("scene.toml --display wall.toml --output front_anna");
  EXPECT_TRUE(shows(expected(0, viewer::StereoMode::Mono, "wall.toml")));
  EXPECT_EQ(close(), 0);
  expectRefused("view scene.toml --display wall.toml --output back",
                "has no output 'back'; its outputs are front_anna, front_ben, floor_anna, floor_ben");
}

TEST_F(Window, ADriverWithoutABufferForEachEyeIsSaid) {
  open("scene.toml --quad-buffer");
  EXPECT_TRUE(shows(expected(0)));
  EXPECT_EQ(close(), 0);
  const std::string words = slurp(folder_ / "err.txt");
  EXPECT_EQ(std::count(words.begin(), words.end(), '\n'), 1) << words;
  EXPECT_NE(words.find("this driver has no buffer for each eye"), std::string::npos) << words;
}

TEST_F(Window, InterleavedRowsStayWithTheScreensRowsWhereverTheWindowIs) {
  open("scene.toml --stereo interleaved");
  const auto eyeOf = [&](int row) {  // the picture with or without exchanged rows of both eyes
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
  int ink = 0;  // pixels of the message in the middle of the picture's place
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
  expectRefused("view --full-screen scene.toml", "no window can be opened");
  expectRefused("view --full-screen 2", "--full-screen=2");
  expectRefused("view --full-screen=65 scene.toml", "--full-screen");
}

TEST_F(Program, AWatcherWhoseDisplayIsGonePrintsInstead) {
  if (!viewer::missingForWindow().empty()) GTEST_SKIP() << viewer::missingForWindow();
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", ":4711", 1);  // a display that does not exist
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

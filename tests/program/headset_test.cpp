// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view --headset` with the headset of fake_headset.cpp, through the loader of OpenXR.
#include <cmath>
#include <fstream>
#include <vector>

#include "fake_headset.h"
#include "run/hand_drag.h"
#include "view/table_room.h"
#include "vps_device/recording.h"
#include "vps_scenes/run/replay.h"
#include "window_on_display.h"

namespace vps {
namespace {

class Headset : public Window {
 protected:
  void SetUp() override {
    Window::SetUp();
    if (IsSkipped()) return;
    write("runtime.json", R"({"file_format_version": "1.0.0", "runtime": {"library_path": ")" VPS_FAKE_RUNTIME
                          R"(", "name": "test headset"}})");
    // The window inherits this environment.
    display_ += "XR_RUNTIME_JSON='" + (folder_ / "runtime.json").string() + "' VPS_FAKE_HEADSET='" +
                folder_.string() + "' ";
  }
  [[nodiscard]] int frames() const {
    const std::string text = slurp(folder_ / "frames.txt");
    return text.empty() ? 0 : std::stoi(text);
  }
  /// Waits for `count` more pairs of pictures.
  bool drew(int count) {
    const int first = frames();
    return soon([&] { return frames() >= first + count; });
  }
  [[nodiscard]] Image eye(const char* name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::string kind;
    int width = 0, height = 0, most = 0;
    file >> kind >> width >> height >> most;
    file.get();
    Image image(width, height);
    file.read(reinterpret_cast<char*>(image.rgb.data()), static_cast<std::streamsize>(image.rgb.size()));
    return image;
  }
  void putHand(const Vec3& p_R, bool is_taking) const {
    std::ostringstream text;
    text << p_R.x() << " " << p_R.y() << " " << p_R.z() << " " << is_taking << "\n";
    write("hand.next", text.str());
    fs::rename(folder_ / "hand.next", folder_ / "hand.txt");
  }
  static viewer::HeadsetEye fakeEye(int side) {
    viewer::HeadsetEye eye;
    eye.X_RE = Pose(rotationFromVector(Vec3(-kFakePitch_rad, 0, 0)), Vec3(0.5 * side * kFakeEyes_m, 0, 0));
    eye.left = std::tan(side < 0 ? -kFakeOuter_rad : -kFakeInner_rad);
    eye.right = std::tan(side < 0 ? kFakeInner_rad : kFakeOuter_rad);
    eye.down = std::tan(-kFakeDown_rad);
    eye.up = std::tan(kFakeUp_rad);
    return eye;
  }
};

TEST_F(Headset, BothEyesSeeTheSceneOnATableBeforeThem) {
  open("scene.toml --headset");
  ASSERT_TRUE(drew(3)) << slurp(folder_ / "err.txt") << slurp(folder_ / "errors.txt");
  const scenes::Scene scene = scenes::loadScene((folder_ / "scene.toml").string());
  const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const scenes::Snapshot snapshot = viewer::sceneTour(scene).at(0);
  const Box box_W = viewer::snapshotBounds(drawn, snapshot);
  viewer::DrawOptions options;
  options.width = kFakeWidth_px;
  options.height = kFakeHeight_px;
  options.supersampling = 1;
  options.show_legend = options.show_ground = false;
  viewer::Renderer renderer(drawn);
  for (const auto& [side, file] : {std::pair(-1, "left.ppm"), std::pair(1, "right.ppm")}) {
    const Image wanted =
        renderer.render(snapshot, viewer::cameraOf(viewer::onTable(box_W), fakeEye(side), box_W), options);
    EXPECT_TRUE(soon([&] { return viewer::compare(eye(file), wanted, 2).share_beyond == 0; })) << file;
  }
  EXPECT_GT(viewer::compare(eye("left.ppm"), eye("right.ppm"), 2).share_beyond, 0.01) << "parallax";
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "errors.txt"), "") << "calls that the specification does not allow";
  EXPECT_NE(slurp(folder_ / "err.txt").find("test headset shows the scene"), std::string::npos)
      << slurp(folder_ / "err.txt");
}

TEST_F(Headset, ItsControllerTakesThePartInHandAndBringsItHome) {
  write("aside.toml",
        "unit = 'mm'\nrelease_s = 0.2\n[[part]]\nfile = 'plate.stl'\nfixed = true\n"
        "[[part]]\nname = 'pin'\nfile = 'pin.stl'\npose = {position = [0, 0, 9.1]}\n"
        "[[step]]\npart = 'pin'\nstart = {position = [4, 0, 9.6]}\ntolerance = '0.5mm'\n");
  open("aside.toml --hand mouse --silent --headset --record taken.mcap");
  ASSERT_TRUE(soon([&] { return !outputOf("ls '" + folder_.string() + "' | grep unfinished").empty(); }));
  ASSERT_TRUE(drew(3));
  // The table is placed for the part that the tour shows first.
  const scenes::Scene scene = scenes::loadScene((folder_ / "aside.toml").string());
  const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const viewer::TableRoom room =
      viewer::onTable(viewer::snapshotBounds(drawn, viewer::sceneTour(scene).at(0)));
  const scenes::SceneStep& step = scene.steps[0];
  const Vec3 middle_P = bounds(scene.parts[step.part].part.mesh).center();
  // The hand points away from the part.
  const Vec3 from_R = room.toRoom(step.X_WP_start * middle_P) + Vec3(0, 0, 0.2);
  const Vec3 way_R = room.toRoom(step.X_WP_target * middle_P) - room.toRoom(step.X_WP_start * middle_P);
  std::this_thread::sleep_for(2s);  // the run shows the part in hand
  putHand(from_R, false);
  ASSERT_TRUE(drew(10));
  EXPECT_EQ(slurp(folder_ / "trembles.txt"), "") << "nothing is held";
  putHand(from_R, true);
  ASSERT_TRUE(drew(10));
  for (int i = 1; i <= 20; ++i) {
    putHand(from_R + i / 20.0 * way_R, true);
    ASSERT_TRUE(drew(2));
  }
  EXPECT_TRUE(soon([&] { return fs::exists(folder_ / "taken.mcap"); })) << "it rests at home";
  EXPECT_NE(slurp(folder_ / "trembles.txt"), "") << "the force is felt";
  putHand(from_R + way_R, false);
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "errors.txt"), "");

  const device::RecordedRun run = device::loadRecording((folder_ / "taken.mcap").string());
  const scenes::Scene recorded = scenes::recordedScene(run);  // the timeline refers to this scene
  const viewer::Timeline line = viewer::recordedTimeline(recorded, run);
  std::vector<Vec3> places_W;
  for (double t = 0; t < line.end_s; t += 0.02) {
    const scenes::Snapshot shot = line.at(t);
    if (const scenes::BodySnapshot* body = viewer::partInHand(shot)) places_W.push_back(body->X_WP.p);
  }
  ASSERT_FALSE(places_W.empty());
  // The tolerance at the end is that of the step, at the beginning the deflection of the hand's spring.
  EXPECT_LT((places_W.front() - step.X_WP_start.p).norm(), 1e-3);
  EXPECT_LT((places_W.back() - step.X_WP_target.p).norm(), 0.5e-3);
}

TEST_F(Headset, OneThatIsTakenOffLeavesTheWindow) {
  open("scene.toml --headset");
  ASSERT_TRUE(drew(2));
  write("leave.txt", "");
  EXPECT_TRUE(soon([&] { return slurp(folder_ / "err.txt").find("session was ended") != std::string::npos; }))
      << slurp(folder_ / "err.txt");
  EXPECT_TRUE(shows(expected(0)));
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "errors.txt"), "");
}

TEST_F(Headset, OneWhosePicturesCannotBeDrawnIsLeftInOrder) {
  display_ += "MESA_GL_VERSION_OVERRIDE=3.3 ";  // enough for the window, too old for the renderer
  open("scene.toml --headset");
  EXPECT_TRUE(soon([&] {
    return slurp(folder_ / "err.txt").find("the headset stops showing the scene") != std::string::npos;
  })) << slurp(folder_ / "err.txt");
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "errors.txt"), "");
}

TEST_F(Headset, OneThatIsNotConnectedIsSaid) {
  display_ += "VPS_FAKE_UNPLUGGED=1 ";
  open("scene.toml --headset");
  EXPECT_TRUE(shows(expected(0)));
  EXPECT_EQ(close(), 0);
  EXPECT_NE(slurp(folder_ / "err.txt").find("test headset (OpenXR) finds no headset; connect it"),
            std::string::npos)
      << slurp(folder_ / "err.txt");
}

TEST_F(Window, WithoutARuntimeForHeadsetsOneLineSaysSo) {
  display_ += "XR_RUNTIME_JSON=/nowhere.json ";
  open("scene.toml --headset");
  EXPECT_TRUE(shows(expected(0)));
  EXPECT_EQ(close(), 0);
  const std::string words = slurp(folder_ / "err.txt");
  EXPECT_EQ(std::count(words.begin(), words.end(), '\n'), 1) << words;
  EXPECT_NE(words.find("headset"), std::string::npos) << words;
}

}  // namespace
}  // namespace vps

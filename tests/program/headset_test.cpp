// SPDX-License-Identifier: BSD-3-Clause
// The window of `vps view --headset` with a headset of this folder (fake_headset.cpp), through the loader of
// OpenXR.
#include <cmath>
#include <fstream>

#include "fake_headset.h"
#include "vps_device/recording.h"
#include "vps_scenes/replay.h"
#include "window/table_room.h"
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
    // The window inherits it.
    display_ += "XR_RUNTIME_JSON='" + (folder_ / "runtime.json").string() + "' VPS_FAKE_HEADSET='" +
                folder_.string() + "' ";
  }
  [[nodiscard]] int frames() const {
    const std::string text = slurp(folder_ / "frames.txt");
    return text.empty() ? 0 : std::stoi(text);
  }
  /// After `count` more pairs of pictures.
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

TEST_F(Headset, ItsControllerTakesThePartInHandAndTheRecordingHasItsWay) {
  const std::string file = VPS_SOURCE_DIR "/scenes/peg_in_hole/scene.toml";
  open(file + " --hand mouse --headset --record taken.mcap");
  ASSERT_TRUE(soon([&] { return !outputOf("ls '" + folder_.string() + "' | grep unfinished").empty(); }));
  ASSERT_TRUE(drew(3));
  // The table is made for what the tour shows first.
  const scenes::Scene scene = scenes::loadScene(file);
  const viewer::RenderScene drawn = viewer::drawnMeshes(scene);
  const viewer::TableRoom room =
      viewer::onTable(viewer::snapshotBounds(drawn, viewer::sceneTour(scene).at(0)));
  const scenes::SceneStep& step = scene.steps[0];
  const Vec3 peg_R = room.toRoom(step.X_WP_start * bounds(scene.parts[step.part].part.mesh).center());
  const Image before = eye("left.ppm");
  std::this_thread::sleep_for(3s);  // the run shows the part in hand
  putHand(peg_R + Vec3(0, 0, 0.2), false);
  ASSERT_TRUE(drew(10));
  putHand(peg_R + Vec3(0, 0, 0.2), true);
  ASSERT_TRUE(drew(10));
  for (int i = 1; i <= 20; ++i) {
    putHand(peg_R + Vec3(0.005 * i, 0, 0.2), true);  // 0.1 m to the right, in the room
    ASSERT_TRUE(drew(2));
  }
  EXPECT_TRUE(soon([&] { return !slurp(folder_ / "trembles.txt").empty(); })) << "the force is felt";
  ASSERT_TRUE(drew(50));
  putHand(peg_R + Vec3(0.1, 0, 0.2), false);
  ASSERT_TRUE(drew(5));
  EXPECT_GT(viewer::compare(eye("left.ppm"), before, 2).share_beyond, 0.01);
  EXPECT_EQ(close(), 0);
  EXPECT_EQ(slurp(folder_ / "errors.txt"), "");

  const device::RecordedRun run = device::loadRecording((folder_ / "taken.mcap").string());
  const viewer::Timeline line = viewer::recordedTimeline(scenes::recordedScene(run), run);
  double least = 1e9, most = -1e9;
  for (double t = 0; t < line.end_s; t += 0.02)
    for (const scenes::BodySnapshot& body : line.at(t).bodies)
      if (body.role == scenes::BodyRole::InHand) {
        least = std::min(least, body.X_WP.p.x());
        most = std::max(most, body.X_WP.p.x());
      }
  // The spring between hand and part is all but relaxed in air; the least that a person would call following.
  EXPECT_GT(most - least, 0.9 * 0.1 / room.scale);
  EXPECT_LT(most - least, 1.3 * 0.1 / room.scale);
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

TEST_F(Headset, OneThatIsNotConnectedIsSaid) {
  display_ += "VPS_FAKE_UNPLUGGED=1 ";
  open("scene.toml --headset");
  EXPECT_TRUE(shows(expected(0)));
  EXPECT_EQ(close(), 0);
  EXPECT_NE(slurp(folder_ / "err.txt").find("test headset (OpenXR) has no headset; connect it"),
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

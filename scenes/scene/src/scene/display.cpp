// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/display.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>

#include "scene/scene_file_keys.h"
#include "vps/errors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/number_table.h"

namespace vps::scenes {
namespace {

constexpr double kSquare = 0.01;     // greatest cosine of a corner's angle
constexpr double kNearest_m = 1e-3;  // least distance of an eye to a screen's plane

void readCorners(const SceneKeys& keys, DisplayScreen& screen) {
  for (const char* key : {"lower_left", "lower_right", "upper_left"})
    if (!keys.has(key)) keys.fail(key, "is missing; a screen needs lower_left, lower_right and upper_left");
  keys.position("lower_left", screen.lower_left_S);
  keys.position("lower_right", screen.lower_right_S);
  keys.position("upper_left", screen.upper_left_S);
  const Vec3 across = screen.lower_right_S - screen.lower_left_S,
             up = screen.upper_left_S - screen.lower_left_S;
  if (!(across.norm() > 0) || !(up.norm() > 0))
    keys.failWhole("has no area, because two of its corners coincide; measure the corners again");
  if (std::abs(across.normalized().dot(up.normalized())) > kSquare)
    keys.fail("upper_left", "makes no right angle with lower_right at lower_left; measure the corners again");
}

DisplayScreen readScreen(const SceneKeys& keys, std::size_t number) {
  DisplayScreen screen;
  screen.name = "screen" + std::to_string(number);
  keys.text("name", screen.name);
  readCorners(keys, screen);
  double pixels[2] = {double(screen.width), double(screen.height)};
  keys.numbers("pixels", 2, pixels, {.min = 16, .max = 8192});
  screen.width = static_cast<int>(std::lround(pixels[0]));
  screen.height = static_cast<int>(std::lround(pixels[1]));
  return screen;
}

/// Reads a head's record; `name` is relative to the display file's folder, unless it is absolute.
void readTrack(const SceneKeys& keys, const std::string& name, DisplayViewer& viewer) {
  const std::string place = keys.placeOf("recorded");
  const std::filesystem::path display(place.substr(0, place.rfind(':')));
  viewer.track = loadHeadTrack((display.parent_path() / name).string());
  viewer.X_SE = viewer.track.X_SE.front();
  viewer.is_placed = true;
}

void readTopic(const SceneKeys& keys, DisplayViewer& viewer) {
  const auto is_good = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/';
  };
  if (viewer.topic.size() < 2 || viewer.topic.front() != '/' || !std::ranges::all_of(viewer.topic, is_good))
    keys.fail("topic", "is '" + viewer.topic + "'; expected a topic of ROS 2, for example \"/anna/head\"");
  std::int64_t domain = viewer.ros_domain;
  keys.integer("ros_domain", domain, {.min = 0, .max = 232});
  viewer.ros_domain = static_cast<int>(domain);
  keys.text("network", viewer.network);
}

DisplayViewer readViewer(const SceneKeys& keys, std::size_t number) {
  DisplayViewer viewer;
  viewer.name = "viewer" + std::to_string(number);
  keys.text("name", viewer.name);
  viewer.is_placed = keys.pose("head", viewer.X_SE);
  std::string recorded;
  const bool is_recorded = keys.text("recorded", recorded), is_topic = keys.text("topic", viewer.topic);
  if (is_recorded && (is_topic || viewer.is_placed))
    keys.fail("recorded", "gives the pose of the head at all times; leave out " +
                              std::string(is_topic ? "'topic'" : "'head'") + ", or 'recorded'");
  if (!viewer.is_placed && !is_recorded && !is_topic)
    keys.fail(
        "head",
        "is missing; give the head's pose, {position = [...]}, or a stream of poses: 'recorded' or 'topic'");
  if (is_recorded) readTrack(keys, recorded, viewer);
  if (is_topic) readTopic(keys, viewer);
  keys.length("eye_distance", viewer.eye_distance_m, {.min = 0, .max = 1});
  return viewer;
}

void requireInFront(const SceneKeys& keys, const DisplayViewer& viewer, const DisplayScreen& screen) {
  const char* const remedy =
      "', whose front is the side from which lower_left is at the left; move the head, or swap the screen's "
      "left and right corners";
  if (!viewer.track.time_s.empty()) {
    DisplayViewer moved = viewer;
    for (std::size_t i = 0; i < viewer.track.time_s.size(); ++i) {
      moved.X_SE = viewer.track.X_SE[i];
      if (isBehind(moved, screen))
        keys.fail("recorded", "has '" + viewer.name + "' at " + std::to_string(viewer.track.time_s[i]) +
                                  " s behind '" + screen.name + remedy);
    }
    return;
  }
  if (isBehind(viewer, screen))
    keys.fail("head", "of '" + viewer.name + "' is behind '" + screen.name + remedy);
  const Vec3 across_S = screen.lower_right_S - screen.lower_left_S;
  bool is_seen = false;
  for (const Vec3& corner_S :
       {screen.lower_left_S, screen.lower_right_S, screen.upper_left_S, Vec3(screen.upper_left_S + across_S)})
    is_seen = is_seen || -viewer.X_SE.R.col(2).dot(corner_S - viewer.X_SE.p) > 0;
  if (!is_seen)
    keys.fail("head",
              "of '" + viewer.name + "' has '" + screen.name +
                  "' behind the head; a head looks along its -z: rotate it by rpy_deg or rotation_xyzw");
}

}  // namespace

bool isBehind(const DisplayViewer& viewer, const DisplayScreen& screen) {
  const Vec3 n_S = screen.axes().col(2);
  for (const int side : {-1, 0, 1})
    if (n_S.dot(viewer.eye_S(side) - screen.lower_left_S) < kNearest_m) return true;
  return false;
}

Pose HeadTrack::at(double t_s) const {
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  if (after == time_s.begin()) return X_SE.front();
  if (after == time_s.end()) return X_SE.back();
  const auto i = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  const Pose &a = X_SE[i - 1], &b = X_SE[i];
  return {a.quaternion().slerp(share, b.quaternion()), Vec3((1 - share) * a.p + share * b.p)};
}

HeadTrack loadHeadTrack(const std::string& file) {
  HeadTrack track;
  for (const NumberRow& row :
       readNumberTable(file, 8, "time [s], x, y, z [m] and quaternion x, y, z, w of a head in the room")) {
    const std::vector<double>& n = row.numbers;
    const std::optional<Pose> X_SE = poseOf(std::span(n).subspan<1, 7>());
    if (!X_SE)
      throw LoadError(row.place, "",
                      "has no rotation in columns 5 to 8; expected a unit quaternion x, y, z, w");
    if (!track.time_s.empty() && n[0] <= track.time_s.back())
      throw LoadError(row.place, "",
                      "has a time that is not later than in the row before; put the rows in order of time");
    track.time_s.push_back(n[0]);
    track.X_SE.push_back(*X_SE);
  }
  if (track.time_s.empty()) throw LoadError(file, "", "has no row; record the poses of the head");
  return track;
}

Mat3 DisplayScreen::axes() const {
  const Vec3 x = (lower_right_S - lower_left_S).normalized();
  const Vec3 z = x.cross(upper_left_S - lower_left_S).normalized();
  Mat3 R;
  R << x, z.cross(x), z;
  return R;
}

void Display::placeDevice(DeviceSettings& device) const {
  if (!X_SD) return;
  // p_S = X_SD p_D and p_S = X_SW (scale p_W), and DeviceSettings defines p_W = placement (device.scale p_D).
  const Pose X_AD = X_SW.inverse() * *X_SD;  // frame A: the scene's axes and origin, in metres of the room
  device.scale = 1 / scale;
  device.placement = Pose(X_AD.R, Vec3(X_AD.p / scale));
}

Display loadDisplay(const std::string& file) {
  const toml::table root = parseToml(readTomlText(file, "display file", "wall.toml"), file);
  SceneFileContext context{file, {}};
  const SceneKeys top(root, context, "", {"unit", "screen", "viewer", "scene", "device"});
  context.unit_m = 1;
  if (std::string unit; top.text("unit", unit)) {
    context.unit_m = unitFromText(unit);
    if (!context.unit_m) top.fail("unit", "is '" + unit + "'; expected one of: mm, cm, m, um, inch");
  }
  Display display;
  display.file = file;
  if (const toml::table* table = top.table("scene")) {
    const SceneKeys keys(*table, context, "[scene]", {"pose", "scale"});
    keys.pose("pose", display.X_SW);
    keys.number("scale", display.scale, kPositive);
  }
  if (const toml::table* table = top.table("device")) {
    const SceneKeys keys(*table, context, "[device]", {"placement"});
    if (keys.has("placement")) keys.pose("placement", display.X_SD.emplace());
  }
  for (const toml::table* table : top.tables("screen"))
    display.screens.push_back(
        readScreen(SceneKeys(*table, context, "[[screen]]",
                             {"name", "lower_left", "lower_right", "upper_left", "pixels"}),
                   display.screens.size() + 1));
  if (display.screens.empty()) throw LoadError(file, "", "has no [[screen]]; give the corners of a screen");
  for (const toml::table* table : top.tables("viewer")) {
    const SceneKeys keys(*table, context, "[[viewer]]",
                         {"name", "head", "recorded", "topic", "ros_domain", "network", "eye_distance"});
    display.viewers.push_back(readViewer(keys, display.viewers.size() + 1));
    if (!display.viewers.back().is_placed) continue;  // the pose of the head comes from the network
    for (const DisplayScreen& screen : display.screens) requireInFront(keys, display.viewers.back(), screen);
  }
  if (display.viewers.empty()) throw LoadError(file, "", "has no [[viewer]]; give the pose of a head");
  return display;
}

}  // namespace vps::scenes

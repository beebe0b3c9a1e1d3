// SPDX-License-Identifier: BSD-3-Clause
// vps snapshot: draws the finished assembly without a display, and compares the picture with an earlier one.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps/solid.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/network/tracked_heads.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/draw/image.h"
#include "vps_viewer/draw/model_meshes.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

namespace {

struct SnapshotArguments {
  std::string scene;
  std::string out, compare, difference, json;
  std::string size = "1280x960";
  std::string view = "iso";
  bool has_section = false;
  int tolerance = 2;
  std::string display;     ///< display file; empty: one picture from `view`
  double head_time_s = 0;  ///< time at which recorded head poses are used
  std::string stereo = "mono";
  std::string
      eye_distance;  ///< distance between the eyes, in the scene; empty: a thirtieth of the viewing distance
  std::vector<std::string> show;
  CacheArguments cache;
};

/// The directions from the scene to the eye.
const std::map<std::string, Vec3>& views() {
  static const std::map<std::string, Vec3> views = {{"iso", Vec3(1, -1.4, 0.9)}, {"front", Vec3(0, -1, 0)},
                                                    {"back", Vec3(0, 1, 0)},     {"left", Vec3(-1, 0, 0)},
                                                    {"right", Vec3(1, 0, 0)},    {"top", Vec3(0, 0, 1)},
                                                    {"bottom", Vec3(0, 0, -1)}};
  return views;
}

/// Width and height from a text such as "1280x960". Throws LoadError.
std::array<int, 2> sizeFromText(const std::string& text) {
  std::array<int, 2> size{};
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size[0]);
  const bool has_width = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
  const auto height = has_width ? std::from_chars(width.ptr + 1, end, size[1]) : width;
  // OpenGL drivers commonly support textures of up to 16384 pixels; a quarter leaves room for supersampling.
  if (!has_width || height.ec != std::errc{} || height.ptr != end || size[0] < 16 || size[1] < 16 ||
      size[0] > 4096 || size[1] > 4096)
    throw LoadError("", "", "--size is '" + text + "'; expected WIDTHxHEIGHT, each 16 to 4096");
  return size;
}

scenes::Snapshot finished(const scenes::Scene& scene) {
  scenes::Snapshot snapshot;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    snapshot.bodies.push_back({i, scene.parts[i].X_WP, scenes::BodyRole::Mounted});
  for (const scenes::SceneStep& step : scene.steps) snapshot.bodies[step.part].X_WP = step.X_WP_target;
  return snapshot;
}

std::vector<std::string> viewNames() {
  std::vector<std::string> names;
  for (const auto& [name, direction] : views()) names.push_back(name);
  return names;
}

/// Prints how much the picture differs from the expected one, and fills the answer. Returns whether the
/// pictures agree.
bool compareWith(const Image& wanted, const Image& image, const SnapshotArguments& given,
                 SnapshotAnswer& answer) {
  const ImageDifference found = compare(image, wanted, given.tolerance);
  answer.is_compared = true;
  answer.is_same_size = found.is_same_size;
  answer.tolerance = given.tolerance;
  answer.share_beyond = found.is_same_size ? found.share_beyond : 1;
  answer.greatest_difference = found.greatest;
  answer.mean_difference = found.mean;
  const char* const file = given.compare.c_str();
  if (!found.is_same_size) {
    std::printf("the expected picture %s has %d x %d pixels, and the new picture has %d x %d\n", file,
                wanted.width, wanted.height, image.width, image.height);
    return false;
  }
  const bool is_equal = found.share_beyond == 0;
  std::printf(
      "the picture %s %s: %.3f %% of the pixels differ by more than %d, and the greatest difference is %d\n",
      is_equal ? "is the same as" : "differs from", file, 100 * found.share_beyond, given.tolerance,
      found.greatest);
  return is_equal;
}

/// A picture, and the suffix of the file that it is written to.
struct NamedPicture {
  std::string suffix;  ///< before the file's extension; empty: none
  Image image;
};

std::vector<NamedPicture> renderFor(const SnapshotArguments& given, Renderer& renderer,
                                    const scenes::Snapshot& snapshot, const Camera& camera,
                                    const DrawOptions& options) {
  const StereoMode mode = stereoModeOf(given.stereo);
  std::vector<NamedPicture> pictures;
  if (!given.display.empty()) {
    scenes::TrackedHeads heads(scenes::loadDisplay(given.display));
    heads.waitForAll(scenes::kHeadWait_s);
    const scenes::Display& display = heads.at(given.head_time_s);
    for (const std::string& news : heads.takeNews()) warn(news);
    for (ScreenPicture& picture : renderDisplay(renderer, snapshot, display, options, mode))
      pictures.push_back({"_" + picture.name, std::move(picture.image)});
    return pictures;
  }
  if (mode == StereoMode::Mono) return {{"", renderer.render(snapshot, camera, options)}};
  const double distance_m = (camera.eye_W - camera.target_W).norm();
  const double eyes_m = given.eye_distance.empty()
                            ? kEyeShare * distance_m
                            : scenes::lengthFromText(given.eye_distance, "--eye-distance");
  const EyePair eyes = eyesOf(camera, eyes_m, double(options.width) / options.height);
  std::vector<Image> images = renderStereo(renderer, snapshot, eyes, options, mode);
  if (images.size() == 1) return {{"", std::move(images[0])}};
  return {{"_left", std::move(images[0])}, {"_right", std::move(images[1])}};
}

std::string withSuffix(const std::string& file, const std::string& suffix) {
  const std::filesystem::path path(file);
  return (path.parent_path() / (path.stem().string() + suffix + path.extension().string())).string();
}

void writePictures(const SnapshotArguments& given, const std::vector<NamedPicture>& pictures) {
  for (const NamedPicture& picture : pictures) {
    OutputFile file(withSuffix(given.out, picture.suffix), {given.scene, given.compare, given.display});
    savePng(picture.image, file.partial());
    file.commit();
    if (!picture.suffix.empty()) std::printf("%s\n", withSuffix(given.out, picture.suffix).c_str());
  }
}

int runSnapshot(const SnapshotArguments& given) {
  if (given.out.empty() && given.compare.empty())
    throw LoadError("", "", "give -o FILE.png, --compare IMAGE, or both");
  if (!given.difference.empty() && given.compare.empty())
    throw LoadError("", "", "--difference needs --compare IMAGE");
  const bool is_one = given.display.empty() && stereoModeOf(given.stereo) != StereoMode::Spectral;
  if (!given.compare.empty() && !is_one)
    throw LoadError("", "", "--compare needs one picture, and --display and --stereo spectral make several");
  DrawOptions options;
  const auto [width, height] = sizeFromText(given.size);
  options.width = width;
  options.height = height;
  const std::vector<std::string> inputs = {given.scene, given.compare, given.display};
  OutputFile out(is_one ? given.out : "", inputs), difference(given.difference, inputs),
      json(given.json, inputs);
  // The image is loaded before rendering, so that a missing image is reported at once.
  const Image wanted = given.compare.empty() ? Image() : loadPng(given.compare);

  const scenes::Scene scene =
      sceneFrom(given.scene, {}, {given.out, given.difference, given.json}, given.cache);
  RenderScene drawn = drawnMeshes(scene);
  const ModelView models(scene, shownModels(given.show), drawn);
  // Each point and each cube has edges of its own, which would darken the picture.
  if (!given.show.empty()) options.show_edges = false;
  const scenes::Snapshot snapshot = finished(scene);
  const Box box = snapshotBounds(drawn, snapshot);
  if (given.has_section) options.cut = CutPlane{.p_W = box.center(), .n_W = -Vec3::UnitY()};
  Camera camera = frameScene(box, views().at(given.view), 0.5, double(width) / height);
  if (given.view == "top" || given.view == "bottom") camera.up_W = Vec3::UnitY();
  Renderer renderer(drawn);
  const std::vector<NamedPicture> pictures = renderFor(given, renderer, snapshot, camera, options);
  const Image& image = pictures.front().image;

  SnapshotAnswer answer{.scene = given.scene, .width = width, .height = height};
  bool is_equal = true;
  if (!given.compare.empty()) {
    is_equal = compareWith(wanted, image, given, answer);
    if (!given.difference.empty() && answer.is_same_size) {
      writeDifference(image, wanted, given.tolerance, difference.partial());
      difference.commit();
    }
  }
  if (!given.out.empty() && is_one) {
    savePng(image, out.partial());
    out.commit();
  } else if (!given.out.empty()) {
    writePictures(given, pictures);
  }
  json.write(toJson(answer));
  return is_equal ? kGood : kBad;
}

}  // namespace

std::function<int()> addSnapshot(CLI::App& command) {
  const auto given = std::make_shared<SnapshotArguments>();
  addSceneArgument(command, given->scene);
  addCacheOptions(command, given->cache);
  command.add_option("-o,--out", given->out, "picture to write")->type_name("FILE.png");
  command.add_option("--size", given->size, "width and height in pixels")
      ->capture_default_str()
      ->type_name("WxH");
  command.add_option("--view", given->view, "direction from which the scene is seen")
      ->capture_default_str()
      ->check(CLI::IsMember(viewNames()));
  command.add_flag("--section", given->has_section, "cut away the front half of the scene");
  std::vector<std::string> modes;
  for (const StereoMode mode : stereoModes()) modes.emplace_back(toText(mode));
  command.add_option("--stereo", given->stereo, "how the pictures for both eyes are combined")
      ->capture_default_str()
      ->check(CLI::IsMember(modes));
  command
      .add_option("--eye-distance", given->eye_distance,
                  "distance between the eyes, in the scene, such as 2mm (default: a thirtieth of the viewing "
                  "distance)")
      ->type_name("LENGTH");
  command
      .add_option("--display", given->display,
                  "display file (TOML): one picture for each of its screens and viewers, NAME_SCREEN.png")
      ->type_name("FILE")
      ->excludes("--eye-distance");
  command
      .add_option("--head-time", given->head_time_s,
                  "time [s] at which recorded head poses are used (default: the start)")
      ->needs("--display")
      ->type_name("SECONDS");
  command
      .add_option("--show", given->show,
                  "draw the models of contact instead of the parts: points, voxels, or points,voxels (points "
                  "of the parts that a step moves, voxels of the others)")
      ->delimiter(',')
      ->check(CLI::IsMember({"points", "voxels"}));
  command
      .add_option("--compare", given->compare,
                  "compare the picture with this PNG file, and exit with status 1 if they differ")
      ->type_name("IMAGE");
  command
      .add_option("--tolerance", given->tolerance,
                  "greatest difference of a colour channel that counts as equal, 0 to 255")
      ->capture_default_str()
      ->check(CLI::Range(0, 255));
  command.add_option("--difference", given->difference, "picture of the difference to write")
      ->type_name("FILE.png");
  addJsonOption(command, given->json);
  return [given] { return runSnapshot(*given); };
}

}  // namespace vps::viewer

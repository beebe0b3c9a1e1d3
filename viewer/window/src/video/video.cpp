// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/window/video.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

#include "files/external.h"
#include "view/camera_motion.h"
#include "view/picture_worker.h"
#include "view/timeline.h"
#include "vps/errors.h"
#include "vps_scenes/network/tracked_heads.h"
#include "vps_scenes/run/replay.h"

namespace vps::viewer {
namespace {

/// Bounds of the scene over the whole time.
Box boxOf(const RenderScene& drawn, const Timeline& line) {
  constexpr int kSamples = 40;
  Box all = snapshotBounds(drawn, line.at(0));
  for (int i = 1; i <= kSamples; ++i) {
    const Box box = snapshotBounds(drawn, line.at(line.end_s * i / kSamples));
    all.min = all.min.cwiseMin(box.min);
    all.max = all.max.cwiseMax(box.max);
  }
  return all;
}

const StandardView& viewNamed(const std::string& name) {
  for (const StandardView& view : standardViews())
    if (view.name == name) return view;
  throw LoadError("", "", "there is no view named '" + name + "'");
}

Camera turnedAbout(Camera camera, double turn_rad) {
  const Mat3 R = rotationFromVector(turn_rad * camera.up_W.normalized());
  camera.eye_W = camera.target_W + R * (camera.eye_W - camera.target_W);
  return camera;
}

/// The film's camera. CameraPath::Follow follows the part in hand with a lag, so that a person's tremor does
/// not shake the picture.
class FilmCamera {
 public:
  FilmCamera(const Camera& start, const RenderScene& drawn, const VideoSettings& settings)
      : start_(start),
        drawn_(drawn),
        settings_(settings),
        target_W_(start.target_W),
        wanted_W_(start.target_W) {}

  Camera at(double share, const scenes::Snapshot& shot) {
    if (settings_.path == CameraPath::Orbit) return turnedAbout(start_, 2 * std::numbers::pi * share);
    if (settings_.path == CameraPath::Fixed) return start_;
    for (const scenes::BodySnapshot& body : shot.bodies)
      if (body.role == scenes::BodyRole::InHand)
        wanted_W_ = body.X_WP * bounds(*drawn_[body.part].mesh).center();
    // A film that begins with a part in hand begins with this part in the centre.
    const double keep =
        std::exchange(has_begun_, true) ? std::exp(-1 / (kLag_s * settings_.frames_per_s)) : 0;
    target_W_ = keep * target_W_ + (1 - keep) * wanted_W_;
    Camera camera = start_;
    camera.target_W = target_W_;
    camera.eye_W = target_W_ + kNearer * (start_.eye_W - start_.target_W);
    return camera;
  }

 private:
  static constexpr double kLag_s = 0.5, kNearer = 0.6;  // assumed: calm, and near enough to see contacts
  Camera start_;
  const RenderScene& drawn_;
  const VideoSettings& settings_;
  Vec3 target_W_;
  Vec3 wanted_W_;  ///< centre of the part that was in hand last
  bool has_begun_ = false;
};

/// The view of each frame: from the display's viewer, or from the film's camera.
class FilmView {
 public:
  FilmView(const FilmCamera& camera, const VideoSettings& settings) : camera_(camera), settings_(settings) {
    if (!settings.display) return;
    for (const scenes::DisplayViewer& viewer : settings.display->viewers)
      if (!viewer.topic.empty())
        throw LoadError(settings.display->file, viewer.name,
                        "has its head from the network, which a film cannot wait for; give 'recorded' or "
                        "'head' alone");
    heads_.emplace(*settings.display);
  }

  [[nodiscard]] PictureSize size() const {
    if (!heads_) return {settings_.width, settings_.height};
    const scenes::DisplayScreen& screen = heads_->display().screens.front();
    return {screen.width, screen.height};
  }
  void look(double share, double time_s, PictureRequest& wanted) {
    wanted.stereo = settings_.stereo;
    if (heads_) {
      const scenes::Display& display = heads_->at(time_s);
      wanted.eyes = eyesOf(display, display.screens.front(), display.viewers.front());
      wanted.options.show_ground = false;  // the room has a floor of its own
      return;
    }
    wanted.camera = camera_.at(share, wanted.snapshot);
    const PictureSize pixels = size();
    if (settings_.stereo != StereoMode::Mono)
      wanted.eyes = eyesOf(wanted.camera, kEyeShare * (wanted.camera.eye_W - wanted.camera.target_W).norm(),
                           double(pixels.width) / pixels.height);
  }

 private:
  FilmCamera camera_;
  const VideoSettings& settings_;
  std::optional<scenes::TrackedHeads> heads_;
};

std::string frameFile(const std::string& folder, std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "/%06zu.png", number);
  return folder + name;
}

}  // namespace

std::size_t writeFrames(const device::RecordedRun& run, const std::string& folder,
                        const VideoSettings& settings) {
  const scenes::Scene scene = scenes::recordedScene(run);
  const Timeline line = recordedTimeline(scene, run);
  if (line.time_s.empty()) throw LoadError(run.file, "", "has no recorded step, so there is nothing to show");
  const RenderScene drawn = drawnMeshes(scene);
  Renderer renderer(drawn);
  const Camera start =
      cameraFor(viewNamed(settings.view), boxOf(drawn, line), {settings.width, settings.height});
  FilmView view(FilmCamera(start, drawn, settings), settings);
  PictureRequest last;
  Image image;
  const double frame_s = settings.speed / settings.frames_per_s;
  const auto count = static_cast<std::size_t>(std::floor(line.end_s / frame_s)) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    if (settings.progress) settings.progress("drawing frames", share);
    PictureRequest wanted;
    wanted.snapshot = line.at(static_cast<double>(i) * frame_s);
    wanted.options.width = view.size().width;
    wanted.options.height = view.size().height;
    view.look(share, static_cast<double>(i) * frame_s, wanted);
    wanted.options.title = line.chapters[line.chapterAt(wanted.snapshot.time_s)].name;
    if (image.rgb.empty() || !isSame(wanted, last)) image = drawInFull(renderer, wanted);
    savePng(image, frameFile(folder, i + 1));
    last = std::move(wanted);
  }
  return count;
}

std::string encodeVideo(const std::string& folder, double frames_per_s, const std::string& sound,
                        const std::string& file) {
  char rate[32];
  std::snprintf(rate, sizeof rate, "%g", frames_per_s);
  std::vector<std::string> words = {"ffmpeg",     "-y", "-loglevel", "error",
                                    "-framerate", rate, "-i",        folder + "/%06d.png"};
  if (!sound.empty()) words.insert(words.end(), {"-i", sound, "-c:a", "aac", "-shortest"});
  // Colour is stored at half resolution (yuv420p), as most players expect; it needs even sizes.
  words.insert(words.end(), {"-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-crf", "18",
                             "-pix_fmt", "yuv420p", "-f", "mp4", file});
  return runProgram(words, "", "ffmpeg is not installed (Debian: apt install ffmpeg)");
}

}  // namespace vps::viewer

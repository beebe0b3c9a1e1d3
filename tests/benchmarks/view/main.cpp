// SPDX-License-Identifier: BSD-3-Clause
// The cost of pictures and of a window, as one table. Times are processor times of all threads of this
// process, on which other programs have little effect; the load average is printed to show whether the
// machine is busy.
//
//   vps_bench_view           everything, about a minute
//   vps_bench_view --check   small, and tests only that pictures show what they should
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "run/live_run.h"
#include "view/camera_motion.h"
#include "view/picture_worker.h"
#include "view/timeline.h"
#include "vps_device/device.h"
#include "vps_viewer/draw/renderer.h"

namespace {

using namespace vps;
using namespace vps::viewer;

double cpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  // CAD files are read by a process of their own.
  rusage children{};
  getrusage(RUSAGE_CHILDREN, &children);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec) +
         seconds(children.ru_utime) + seconds(children.ru_stime);
}
double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double loadAverage() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

/// Median and greatest of several measurements.
struct Row {
  std::string what, bar;
  std::vector<double> cpu_s, wall_s;
};
void print(const Row& row) {
  const auto median = [](std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
  };
  std::printf("%-58s %8.3f %8.3f %8.3f   %s\n", row.what.c_str(), median(row.cpu_s),
              *std::ranges::max_element(row.cpu_s), median(row.wall_s), row.bar.c_str());
}
template <class Work>
void time(Row& row, Work work) {
  const double cpu_s = cpuSeconds(), wall_s = wallSeconds();
  work();
  row.cpu_s.push_back(cpuSeconds() - cpu_s);
  row.wall_s.push_back(wallSeconds() - wall_s);
}

/// Four balls on a plate: curved surfaces that occlude each other and cast shadows.
struct Balls {
  Mesh ball, plate = makeBox({0.5, 0.5, 0.02});
  RenderScene drawn;
  scenes::Snapshot shot;

  explicit Balls(int subdivisions) : ball(makeSphere(0.06, subdivisions)) {
    drawn = {{&plate}};
    shot.bodies = {{0, Pose::translation(Vec3(0, 0, -0.07)), scenes::BodyRole::Mounted}};
    for (int i = 0; i < 6; ++i) {
      drawn.push_back({&ball});
      shot.bodies.push_back({drawn.size() - 1, Pose::translation(Vec3(0.13 * (i % 3 - 1), 0.15 * (i / 3), 0)),
                             scenes::BodyRole::Mounted});
    }
  }
  [[nodiscard]] std::size_t triangles() const { return plate.triangles.size() + 6 * ball.triangles.size(); }
};

DrawOptions sized(bool is_draft) {
  DrawOptions options;
  options.width = 1280;
  options.height = 720;
  options.supersampling = 1;  // in addition to 4 samples per pixel
  options.show_legend = false;
  options.is_draft = is_draft;
  return options;
}

/// Returns false if the picture does not show the scene.
bool timePictures(int subdivisions, int repeats) {
  const Balls balls(subdivisions);
  Renderer renderer(balls.drawn);
  Camera camera = frameScene(snapshotBounds(balls.drawn, balls.shot), Vec3(1, -1, 1), 0.5, 1280.0 / 720);
  std::printf("drawn by %s\n", renderer.description().c_str());
  bool shows = true;
  for (const bool is_draft : {false, true}) {
    char what[80];
    std::snprintf(what, sizeof what, "%s of %zu triangles, 1280 x 720, 4 samples",
                  is_draft ? "draft" : "picture", balls.triangles());
    Row row{what, is_draft ? "" : "bar 0.25", {}, {}};
    static_cast<void>(
        renderer.render(balls.shot, camera, sized(is_draft)));  // the first picture compiles the shaders
    for (int i = 0; i < repeats; ++i) {
      camera.eye_W.x() += 1e-3;  // like a view that turns
      Image image;
      time(row, [&] { image = renderer.render(balls.shot, camera, sized(is_draft)); });
      // The plate alone covers more than a twentieth of the picture.
      const Image empty = renderer.render({}, camera, sized(is_draft));
      std::size_t drawn = 0;
      for (std::size_t k = 0; k < image.rgb.size(); k += 3)
        drawn += !std::equal(&image.rgb[k], &image.rgb[k] + 3, &empty.rgb[k]);
      shows = shows && drawn > image.rgb.size() / 3 / 20;
    }
    print(row);
  }
  return shows;
}

/// @param cache  cache of the parts; null: the CAD file is read each time
void timeFirstPicture(const char* what, const ByteCache* cache, int repeats) {
  Row row{what, "bar 1", {}, {}};
  for (int i = 0; i < repeats; ++i)
    time(row, [cache] {
      const scenes::Scene scene = scenes::loadScene(VPS_SCENE_FOLDER "/bearing_block/scene.toml", {}, cache);
      const RenderScene drawn = drawnMeshes(scene);
      const scenes::Snapshot shot = sceneTour(scene).at(0);
      Renderer renderer(drawn);
      const Camera camera = cameraFor(standardViews()[0], snapshotBounds(drawn, shot), {1280, 720});
      static_cast<void>(renderer.render(shot, camera, sized(true)));
    });
  print(row);
}

/// A device whose handle is at rest in a person's hand.
class Resting final : public device::Device {
 public:
  device::DeviceSample read() noexcept override {
    device::DeviceSample sample;
    sample.time_s = 1e-3 * static_cast<double>(++reads_);
    return sample;
  }
  void write(const Wrench& /*F_Ho_D*/) noexcept override {}
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return {.peak_force_N = 10}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "resting"; }

 private:
  long reads_ = 0;
};

/// Counts the periods that the haptic loop misses in some seconds of real time, with pictures drawn as in a
/// window, or without.
void countMissed(bool is_watched, double seconds) {
  const scenes::Scene scene = scenes::loadScene(VPS_SCENE_FOLDER "/peg_in_hole/scene.toml");
  const RenderScene drawn = drawnMeshes(scene);
  LiveSettings settings;
  settings.has_sound = false;
  settings.device = [] { return std::make_unique<Resting>(); };
  std::optional<PictureWorker> worker;
  PictureRequest wanted;
  if (is_watched) worker.emplace(drawn, [] {});
  wanted.options = sized(false);
  LiveRun run(scene, settings, [] {});
  run.ask();
  std::optional<scenes::RunFigures> first, last;
  double end_s = 1e300;
  while (wallSeconds() < end_s && !run.status().is_over) {
    if (std::optional<scenes::Snapshot> shot = run.take()) {
      if (shot->figures && !first) {
        first = shot->figures;
        end_s = wallSeconds() + seconds;
      }
      if (shot->figures) last = shot->figures;
      if (worker) {
        wanted.snapshot = std::move(*shot);
        wanted.camera = cameraFor(standardViews()[0], snapshotBounds(drawn, wanted.snapshot), {1280, 720});
        wanted.camera.eye_W.x() +=
            1e-4 * static_cast<double>(worker->count() % 2);  // so that each picture is drawn
        worker->request(wanted);
        static_cast<void>(worker->take());
      }
      run.ask();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!first || !last) return void(std::printf("the run did not begin: %s\n", run.status().error.c_str()));
  std::printf("haptic loop %s: %llu of %llu ticks missed, p99 %.0f us%s\n",
              is_watched ? "with a window's pictures" : "alone",
              static_cast<unsigned long long>(last->missed - first->missed),
              static_cast<unsigned long long>(last->ticks - first->ticks), last->tick_p99_us,
              worker ? (", " + std::to_string(worker->count()) + " pictures").c_str() : "");
}

}  // namespace

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // line-buffered, so that rows appear at once
  const bool is_check = count > 1 && std::strcmp(arguments[1], "--check") == 0;
  std::printf("load average %.1f on %u processors\n", loadAverage(), std::thread::hardware_concurrency());
  std::printf("%-58s %8s %8s %8s\n", "", "cpu [s]", "most", "wall [s]");
  // 6 balls of 20 * 4^6 triangles.
  const bool shows = timePictures(is_check ? 3 : 6, is_check ? 1 : 7);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("vps_bench_view_" + std::to_string(getpid()));
  const ByteCache cache(folder);
  timeFirstPicture("first picture of the demo: scene, renderer, draft", nullptr, is_check ? 1 : 3);
  // The first of these pictures reads the CAD file again, which is the greatest value of its row.
  timeFirstPicture("the same with its parts from the cache", &cache, is_check ? 2 : 4);
  std::filesystem::remove_all(folder);
  if (!is_check)
    for (const bool is_watched : {false, true}) countMissed(is_watched, 10);
  std::printf("load average %.1f\n", loadAverage());
  if (!shows) std::printf("a picture does not show the scene\n");
  return shows ? 0 : 1;
}

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/window/latency.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "latency/contact_times.h"
#include "latency/tapping_handle.h"
#include "run/live_run.h"
#include "sound/live_sound.h"
#include "view/camera_motion.h"
#include "view/picture_worker.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"

namespace vps::viewer {
namespace {

// Taps that do not count: the first pictures and sounds are late, since the modes of the parts are computed
// when the run begins. If there is no sound after kMostWarmUp taps, the measurement goes on without sound.
constexpr std::size_t kWarmUp = 3, kMostWarmUp = 100;
constexpr double kMostTap_s = 2;  // upper bound of a tap with its pauses, for the size of the log

/// A sound output that logs the times of its writes.
class StampedOutput final : public SoundOutput {
 public:
  StampedOutput(std::unique_ptr<SoundOutput> inner, std::vector<LatencyLog::Written>& written,
                std::atomic<bool>& has_begun)
      : inner_(std::move(inner)), written_(written), has_begun_(has_begun) {}
  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) override {
    float peak = 0;
    for (const float x : parts) peak = std::max(peak, std::abs(x));
    written_.push_back({device::monotonicSeconds(), peak});
    has_begun_ = true;
    inner_->write(parts, beeps, to_L);
    written_.back().gaps = inner_->gaps();
  }
  [[nodiscard]] bool isThere() const override { return inner_->isThere(); }

 private:
  std::unique_ptr<SoundOutput> inner_;
  std::vector<LatencyLog::Written>& written_;
  std::atomic<bool>& has_begun_;
};

/// Lets the run own a device object while the measurement keeps the handle.
class SharedHandle final : public device::Device {
 public:
  explicit SharedHandle(std::shared_ptr<TappingHandle> handle) : handle_(std::move(handle)) {}
  device::DeviceSample read() noexcept override { return handle_->read(); }
  void write(const Wrench& F_Ho_D) noexcept override { handle_->write(F_Ho_D); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override { return handle_->limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return handle_->name(); }

 private:
  std::shared_ptr<TappingHandle> handle_;
};

TapPlan planFor(const scenes::Scene& scene) {
  const scenes::SceneStep& step = scene.steps.front();
  const Pose& X_WP_end = step.way_points.empty() ? step.X_WP_target : step.way_points.front();
  const Vec3 way_W = X_WP_end.p - step.X_WP_start.p;
  const scenes::ScenePart& part = scene.parts[step.part];
  if (!(way_W.norm() > 0))
    throw LoadError(scene.file, part.part.name,
                    "does not move, so there is no contact to measure; set a start pose for its step");
  TapPlan plan;
  plan.d_D = way_W.normalized();  // this handle's axes are parallel to the scene's
  const Vec3 across_W = plan.d_D.unitOrthogonal();
  const Box box_P = bounds(part.part.mesh);
  const Vec3 size_W = step.X_WP_start.R.cwiseAbs() * box_P.size();
  const double scale = scene.device.scale;
  plan.aside_D = 0.25 * across_W.cwiseAbs().dot(size_W) / scale * across_W;
  plan.reach_m = 1.5 * way_W.norm() / scale;
  return plan;
}

bool isLit(const Image& image) {
  const int middle = flashSize_px(image.height) / 2;
  return image.at(middle, image.height - 1 - middle)[0] > 127;
}

/// Draws pictures of the run's snapshots as the window does, and logs them.
class Watcher {
 public:
  explicit Watcher(const scenes::Scene& scene, const LatencySettings& settings)
      : worker_(drawnMeshes(scene), [this] { wake(); }) {
    wanted_.options.width = settings.width;
    wanted_.options.height = settings.height;
    wanted_.options.supersampling = 1;  // as in the window
    wanted_.options.show_legend = false;
    wanted_.options.show_flash = true;
  }
  void wake() {
    {
      const std::lock_guard lock(mutex_);
      has_news_ = true;
    }
    news_.notify_one();
  }
  /// Waits for a new snapshot or picture, for at most 0.1 s.
  void wait() {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, std::chrono::milliseconds(100), [this] { return has_news_; });
    has_news_ = false;
  }
  void follow(LiveRun& run, const Camera& camera, LatencyLog& log) {
    if (std::optional<scenes::Snapshot> shot = run.take()) {
      wanted_.snapshot = std::move(*shot);
      wanted_.camera = camera;
      worker_.request(wanted_);
      run.ask();
    }
    if (const std::string why = worker_.failure(); !why.empty()) throw std::runtime_error(why);
    if (const std::optional<DrawnPicture> picture = worker_.take())
      log.pictures.push_back({picture->clock_s - picture->wall_s, picture->clock_s, isLit(picture->image)});
  }
  [[nodiscard]] std::string description() const { return worker_.description(); }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  bool has_news_ = false;
  PictureRequest wanted_;
  PictureWorker worker_;  // declared last, since it calls wake()
};

Camera cameraOf(const scenes::Scene& scene, const LatencySettings& settings) {
  scenes::Snapshot shot;
  const scenes::SceneStep& step = scene.steps.front();
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    shot.bodies.push_back(
        {i, i == step.part ? step.X_WP_start : scene.parts[i].X_WP, scenes::BodyRole::Mounted});
  return cameraFor(standardViews()[0], snapshotBounds(drawnMeshes(scene), shot),
                   {settings.width, settings.height});
}

void requireGoing(const LiveRun& run, const TappingHandle& handle, const scenes::Scene& scene) {
  const std::string& part = scene.parts[scene.steps.front().part].part.name;
  const LiveStatus status = run.status();
  if (!status.error.empty()) throw std::runtime_error(status.error);
  if (handle.hasFoundNothing())
    throw LoadError(scene.file, part,
                    "touched nothing on its path next to the hole; measure with another scene, such as "
                    "scenes/peg_in_hole");
  if (status.is_over) throw LoadError(scene.file, part, "was put down before all taps were made");
}

}  // namespace

LatencyResult measureLatency(scenes::Scene scene, const LatencySettings& settings) {
  if (scene.steps.empty()) throw LoadError(scene.file, "", "has no [[step]], so no part is taken in hand");
  LatencyResult result;
  result.scene = scene.name;
  result.part = scene.parts[scene.steps.front().part].part.name;
  result.width = settings.width;
  result.height = settings.height;
  const std::size_t wanted = settings.taps + 1;  // the last tap is not recorded to its end
  const std::size_t most_taps = kMostWarmUp + wanted;
  LatencyLog log;
  log.steps.reserve(
      static_cast<std::size_t>(kMostTap_s * static_cast<double>(most_taps) * scene.fidelity.physics_rate_hz));
  const auto handle = std::make_shared<TappingHandle>(
      planFor(scene),
      static_cast<std::size_t>(kMostTap_s * static_cast<double>(most_taps) * scene.fidelity.haptic_rate_hz));
  std::atomic<bool> has_sound{false}, has_sounded{false};
  LiveSettings live;
  live.models = settings.models;
  live.device = [handle] { return std::make_unique<SharedHandle>(handle); };
  live.watch = [&log](const scenes::Snapshot& shot) {
    log.steps.push_back({shot.sample_s, shot.clock_s, totalForce_N(shot.contacts)});
  };
  live.open_sound = [&](int rate_hz, std::string& why) -> std::unique_ptr<SoundOutput> {
    log.rate_hz = rate_hz;
    auto card = openSoundLoopback(
        rate_hz,
        [&log](std::span<const float> samples, double time_s) {
          log.heard.push_back({time_s, {samples.begin(), samples.end()}});
        },
        why);
    result.silence = why;
    if (!card) return nullptr;
    has_sound = true;
    return std::make_unique<StampedOutput>(std::move(card), log.written, has_sounded);
  };
  const Camera camera = cameraOf(scene, settings);
  double from_s = 0;
  {
    Watcher watcher(scene, settings);
    LiveRun run(scene, live, [&watcher] { watcher.wake(); });
    run.listenAt(camera.pose());
    run.ask();
    std::size_t warm_up = kWarmUp;
    while (handle->taps() < warm_up + wanted && (settings.stop == nullptr || !settings.stop->load())) {
      watcher.wait();
      watcher.follow(run, camera, log);
      requireGoing(run, *handle, scene);
      if (has_sound && !has_sounded) warm_up = std::min(handle->taps() + kWarmUp, kMostWarmUp);
      if (handle->taps() < warm_up) from_s = device::monotonicSeconds();
      if (settings.models.progress) {
        const LiveStatus status = run.status();
        if (handle->taps() == 0)
          settings.models.progress(status.doing, status.share);
        else
          settings.models.progress(
              "tapping", static_cast<double>(handle->taps()) / static_cast<double>(warm_up + wanted));
      }
    }
    result.drawn_by = watcher.description();
  }
  log.ticks = handle->ticks();
  result.contacts = findContacts(log, from_s);
  result.late_samples = lateSamples(log, from_s);
  result.late_mixes = lateMixes(log, from_s);
  result.contacts.resize(std::min(result.contacts.size(), settings.taps));
  std::vector<double> wall_s;
  for (const LatencyLog::Picture& picture : log.pictures) wall_s.push_back(picture.done_s - picture.begun_s);
  result.picture_wall_s = percentile(wall_s, 0.5);
  return result;
}

}  // namespace vps::viewer

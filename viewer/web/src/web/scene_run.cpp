// SPDX-License-Identifier: BSD-3-Clause
// A run in this process as a WatchedRun.
#include <cmath>
#include <utility>

#include "run/live_run.h"
#include "vps_device/metronome.h"
#include "vps_viewer/report/words.h"
#include "web/watched_run.h"

namespace vps::viewer {

namespace {

constexpr double kBetweenRuns_s = 3;  // assumed: long enough to see the end of a run

double clock_s() {
  return 1e-9 * static_cast<double>(device::monotonicClock().now_ns());
}

class SceneRun final : public WatchedRun {
 public:
  SceneRun(scenes::Scene scene, const WebOptions& options) : scene_(std::move(scene)), options_(options) {
    begin();
  }

  void poll() override {
    run_->ask();
    for (std::string& words : run_->takeMessages()) news_.push_back({status_.time_s, std::move(words), {}});
    status_ = run_->status();
    for (; told_ < status_.result.steps.size(); ++told_) {
      const scenes::StepResult& step = status_.result.steps[told_];
      news_.push_back({status_.time_s,
                       "'" + step.part + "' " + toText(step.verdict) +
                           (step.reason.empty() ? std::string() : ": " + step.reason),
                       {}});
    }
    if (!status_.is_over) return;
    if (!over_s_) {
      over_s_ = clock_s();
      if (status_.error.empty())
        news_.push_back({status_.time_s, toText(status_.result.verdict), status_.result.verdict});
      else
        news_.push_back({status_.time_s, status_.error, {}});
    }
    if (status_.error.empty() && clock_s() > *over_s_ + kBetweenRuns_s) begin();
  }
  [[nodiscard]] const scenes::Scene* scene() const override { return &scene_; }
  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] std::string doing() const override {
    if (status_.is_over) return status_.error.empty() ? "the next run begins soon" : "stopped";
    if (status_.steps > 0) return {};
    return (status_.doing.empty() ? "building models" : status_.doing) + " " +
           std::to_string(std::lround(100 * status_.share)) + " %";
  }
  std::optional<WatchedShot> takeShot() override {
    std::optional<scenes::Snapshot> shot = run_->take();
    if (!shot) return {};
    return WatchedShot{std::move(*shot), device::monotonicClock().now_ns()};
  }
  std::vector<WatchedNews> takeNews() override { return std::exchange(news_, {}); }
  [[nodiscard]] HandDrag* drag() override { return drag_ ? &*drag_ : nullptr; }

 private:
  void begin() {
    run_.reset();
    ++number_;
    told_ = 0;
    over_s_.reset();
    LiveSettings settings;
    settings.models = options_.models;
    settings.has_sound = false;  // browsers play their own sound
    if (options_.allows_hand) {
      drag_.emplace(scene_.device.scale);
      settings.hand = "mouse";
      settings.wish = drag_->wish();
    }
    run_.emplace(scene_, settings, [] {});
    status_ = {};
  }

  scenes::Scene scene_;
  WebOptions options_;
  std::optional<HandDrag> drag_;
  std::vector<WatchedNews> news_;
  LiveStatus status_;
  std::size_t told_ = 0;  ///< number of steps whose verdicts were sent
  std::optional<double> over_s_;
  int number_ = 0;
  std::optional<LiveRun> run_;  // declared last, since its threads use the other members
};

}  // namespace

std::unique_ptr<WatchedRun> watchedScene(const scenes::Scene& scene, const WebOptions& options) {
  return std::make_unique<SceneRun>(scene, options);
}

}  // namespace vps::viewer

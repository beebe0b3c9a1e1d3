// SPDX-License-Identifier: BSD-3-Clause
// A recording as a WatchedRun. All watchers see the same instant, and each of them may play, pause and seek.
#include <algorithm>
#include <cmath>
#include <utility>

#include "view/timeline.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"
#include "vps_scenes/run/replay.h"
#include "web/watched_run.h"

namespace vps::viewer {

namespace {

std::int64_t recordingClock_ns() {
  return device::monotonicClock().now_ns();
}

class RecordingRun final : public WatchedRun {
 public:
  explicit RecordingRun(const device::RecordedRun& run)
      : scene_(scenes::recordedScene(run)),
        line_(recordedTimeline(scene_, run)),
        begin_s_(line_.time_s.empty() ? 0 : line_.time_s.front()) {
    if (line_.time_s.empty())
      throw LoadError(run.file, "", "has no recorded step, so there is nothing to show");
    seek(begin_s_);
    play(true);
  }

  void poll() override {
    if (!is_playing_) return;
    const double before_s = time_s_;
    time_s_ = std::min(line_.end_s, from_s_ + 1e-9 * static_cast<double>(recordingClock_ns() - from_ns_));
    for (const Message& message : line_.messages)
      if (message.time_s > before_s && message.time_s <= time_s_)
        news_.push_back({message.time_s, message.words, {}});
    is_new_ = is_new_ || time_s_ > before_s;
    if (time_s_ >= line_.end_s) is_playing_ = false;
  }
  [[nodiscard]] const scenes::Scene* scene() const override { return &scene_; }
  [[nodiscard]] int number() const override { return 1; }
  [[nodiscard]] std::string doing() const override { return "a recording"; }
  std::optional<WatchedShot> takeShot() override {
    if (!std::exchange(is_new_, false)) return {};
    return WatchedShot{line_.at(time_s_), recordingClock_ns()};
  }
  std::vector<WatchedNews> takeNews() override { return std::exchange(news_, {}); }
  [[nodiscard]] HandDrag* drag() override { return nullptr; }

  [[nodiscard]] std::optional<Playback> playback() const override {
    return Playback{begin_s_, line_.end_s, is_playing_};
  }
  void play(bool on) override {
    if (on && time_s_ >= line_.end_s) seek(begin_s_);
    is_playing_ = on;
    from_s_ = time_s_;
    from_ns_ = recordingClock_ns();
  }
  void seek(double time_s) override {
    time_s_ = std::clamp(time_s, begin_s_, line_.end_s);
    is_new_ = true;
    if (is_playing_) play(true);
  }

 private:
  scenes::Scene scene_;
  Timeline line_;
  double begin_s_;
  double time_s_ = 0, from_s_ = 0;  ///< time shown now; time at which playing began
  std::int64_t from_ns_ = 0;
  bool is_playing_ = false, is_new_ = false;
  std::vector<WatchedNews> news_;
};

}  // namespace

std::unique_ptr<WatchedRun> watchedRecording(const device::RecordedRun& run) {
  return std::make_unique<RecordingRun>(run);
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "run/live_run.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "vps_device/device_kinds.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/replay.h"

namespace vps::viewer {
namespace {

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

bool isByPerson(const std::string& kind) {
  const device::DeviceKind* found = device::findDeviceKind(kind);
  return found != nullptr && !found->isSimulated();
}

LiveRun::LiveRun(scenes::Scene scene, const LiveSettings& settings, std::function<void()> on_news)
    : scene_(std::move(scene)),
      on_news_(std::move(on_news)),
      watch_(settings.watch),
      speed_(settings.speed),
      is_paused_(settings.is_paused) {
  if (!settings.hand.empty()) scene_.device.kind = settings.hand;
  is_by_clock_ = settings.device != nullptr || isByPerson(scene_.device.kind);
  if (scene_.device.kind == "mouse" || settings.device != nullptr)
    scene_.device.placement.reset();  // a mouse and a settings.device have no place in the room
  snaps_ = settings.snaps;
  if (is_by_clock_) {
    is_paused_ = false;
    for (scenes::SceneStep& step : scene_.steps)
      step.timeout_s = std::max(step.timeout_s, scenes::kPersonTimeout_s);
  }
  if (settings.has_sound) {
    std::string why;
    const std::function<std::unique_ptr<SoundOutput>(int, std::string&)> open =
        settings.open_sound ? settings.open_sound : openSoundOutput;
    if (std::unique_ptr<SoundOutput> output = open(SoundSettings{}.rate_hz, why))
      sound_ = std::make_unique<LiveSound>(scene_, std::move(output), [open] {
        std::string still_silent;
        return open(SoundSettings{}.rate_hz, still_silent);
      });
    if (!why.empty()) messages_.push_back(why);
  }
  tap_.give = [this](scenes::Snapshot&& snapshot) {
    if (watch_) watch_(snapshot);
    if (sound_) sound_->hear(snapshot);
    if (sound_ || watch_) {
      tap_.is_wanted = true;
      if (!is_asked_.exchange(false)) return;
    }
    {
      const std::lock_guard lock(mutex_);
      newest_ = std::move(snapshot);
    }
    on_news_();
  };
  thread_ = std::thread([this, settings] { run(settings); });
}

LiveRun::~LiveRun() {
  stop_ = true;
  {
    const std::lock_guard lock(mutex_);
    is_paused_ = false;
  }
  wake_.notify_one();
  thread_.join();
}

void LiveRun::pause(bool is_paused) {
  if (is_by_clock_) return;
  {
    const std::lock_guard lock(mutex_);
    is_paused_ = is_paused;
    steps_allowed_ = 0;
    is_clock_set_ = false;
  }
  wake_.notify_one();
}

bool LiveRun::isPaused() const {
  const std::lock_guard lock(mutex_);
  return is_paused_;
}

void LiveRun::oneStep() {
  if (is_by_clock_) return;
  {
    const std::lock_guard lock(mutex_);
    ++steps_allowed_;
  }
  is_asked_ = true;
  tap_.is_wanted = true;
  wake_.notify_one();
}

void LiveRun::ask() {
  is_asked_ = true;
  tap_.is_wanted = true;
}

std::optional<scenes::Snapshot> LiveRun::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(newest_, std::nullopt);
}

LiveStatus LiveRun::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void LiveRun::report(const device::DeviceEvent& event) {
  if (sound_) sound_->beep(device::beepOf(event.kind));
  std::string words = toText(event.kind);
  if (const std::string remedy = remedyOf(event.kind); !remedy.empty()) words.append("; ").append(remedy);
  const std::lock_guard lock(mutex_);
  constexpr std::size_t kMost = 50;
  if (messages_.size() < kMost && (messages_.empty() || messages_.back() != words))
    messages_.push_back(words);
}

std::vector<std::string> LiveRun::takeMessages() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> taken = std::exchange(messages_, {});
  if (sound_)
    if (std::string news = sound_->takeNews(); !news.empty()) taken.push_back(std::move(news));
  return taken;
}

void LiveRun::keepTime(double time_s) {
  std::unique_lock lock(mutex_);
  status_.time_s = time_s;
  ++status_.steps;
  if (is_by_clock_) return;
  if (is_paused_ && steps_allowed_ == 0) {
    wake_.wait(lock, [this] { return stop_ || !is_paused_ || steps_allowed_ > 0; });
    is_clock_set_ = false;
  }
  if (steps_allowed_ > 0) --steps_allowed_;
  if (speed_ <= 0) return;
  const double now_s = wallSeconds();
  if (!is_clock_set_) {
    is_clock_set_ = true;
    clock_s_ = now_s;
    clock_time_s_ = time_s;
  }
  const double ahead_s = (time_s - clock_time_s_) / speed_ - (now_s - clock_s_);
  // A run that fell behind does not catch up.
  if (ahead_s < 0) clock_s_ -= ahead_s;
  constexpr double kLeastWait_s = 1e-3;  // shorter waits are not worth their overhead
  if (ahead_s >= kLeastWait_s)
    wake_.wait_for(lock, std::chrono::duration<double>(ahead_s), [this] { return stop_.load(); });
}

void LiveRun::run(const LiveSettings& settings) {
  scenes::AssembleOptions options;
  static_cast<scenes::ModelOptions&>(options) = settings.models;
  options.progress = [this](std::string_view doing, double share) {
    {
      const std::lock_guard lock(mutex_);
      status_.doing = doing;
      status_.share = share;
    }
    on_news_();
  };
  options.stop = &stop_;
  options.snaps = &snaps_;
  options.tap = &tap_;
  options.on_device_event = [this](const device::DeviceEvent& event) { report(event); };
  options.is_real_time = is_by_clock_;
  options.wish = settings.wish;
  options.device = settings.device;
  options.after_step = [this](double time_s) { keepTime(time_s); };
  options.on_step = [this](const scenes::AssembleResult& so_far) {
    const std::lock_guard lock(mutex_);
    status_.result.steps = so_far.steps;
    status_.result.verdict = so_far.verdict;
    status_.result.finished = so_far.finished;
  };
  scenes::AssembleResult result;
  std::string error;
  try {
    result = settings.record.empty() ? scenes::assemble(scene_, options)
                                     : scenes::assembleAndRecord(scene_, settings.record, options);
  } catch (const std::exception& failed) {
    error = failed.what();
  }
  {
    const std::lock_guard lock(mutex_);
    result.trace.clear();  // status() copies the result, so large data is removed
    result.start.clear();
    result.contact.clear();
    result.end.clear();
    if (error.empty() && !result.finished.bodies.empty()) newest_ = result.finished;
    status_.is_over = true;
    status_.error = error;
    if (error.empty()) status_.result = std::move(result);
  }
  on_news_();
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "sound/live_sound.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vps::viewer::inline v0 {
namespace {

constexpr double kFullScale_Pa = 0.2;   // 80 dB at the listener: a tool that is put down. assumed
constexpr float kLiveBeepLevel = 0.1f;  // -20 dB, as in a file
constexpr std::size_t kMostWaiting =
    500;  // snapshots: half a second at 1 kHz; older ones are late and dropped

float loudness(float pressure_Pa) {
  return std::tanh(pressure_Pa / static_cast<float>(kFullScale_Pa));  // louder ones are rounded, not cut
}

}  // namespace

struct LiveSound::Impl {
  const scenes::Scene& scene;
  std::unique_ptr<SoundOutput> output;
  std::mutex mutex;
  std::condition_variable wake;
  std::vector<scenes::Snapshot> waiting;
  std::vector<device::Beep> beeps;
  std::string news;  ///< empty: none so far
  bool is_ending = false, was_told = false;
  std::thread thread;

  Impl(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output)
      : scene(scene), output(std::move(output)), thread([this] { work(); }) {}

  bool isEnding() {
    const std::lock_guard lock(mutex);
    return is_ending;
  }
  void work() {
    std::vector<scenes::Snapshot> shots;
    std::vector<device::Beep> new_beeps;
    RunSound sound(scene);
    bool is_ready = false;
    for (;;) {
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [this] { return is_ending || !waiting.empty(); });
        if (is_ending) return;
        shots = std::exchange(waiting, {});
        new_beeps = std::exchange(beeps, {});
      }
      if (!std::exchange(is_ready, true))  // before anything touches
        for (std::size_t i = 0; i < scene.parts.size() && !isEnding(); ++i)
          if (scene.parts[i].model) sound.prepare(i);
      for (const device::Beep beep : new_beeps) sound.beep(beep);
      for (const scenes::Snapshot& shot : shots) sound.hear(shot);
      play(sound.take());
    }
  }

  void play(const RunSound::Samples& heard) {
    std::vector<float> mixed(heard.pressure_Pa.size());
    for (std::size_t i = 0; i < mixed.size(); ++i)
      mixed[i] = std::clamp(loudness(heard.pressure_Pa[i]) + kLiveBeepLevel * heard.beeps[i], -1.0f, 1.0f);
    output->write(mixed);
    if (output->isThere()) return;
    const std::lock_guard lock(mutex);
    if (!std::exchange(was_told, true)) news = "the sound card is gone; the run goes on in silence";
  }
};

LiveSound::LiveSound(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output)
    : impl_(std::make_unique<Impl>(scene, std::move(output))) {}

LiveSound::~LiveSound() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->is_ending = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
}

void LiveSound::hear(const scenes::Snapshot& shot) {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->waiting.size() >= kMostWaiting) impl_->waiting.erase(impl_->waiting.begin());
    impl_->waiting.push_back(shot);
  }
  impl_->wake.notify_one();
}

void LiveSound::beep(device::Beep beep) {
  const std::lock_guard lock(impl_->mutex);
  impl_->beeps.push_back(beep);
}

std::string LiveSound::takeNews() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->news, {});
}

}  // namespace vps::viewer::inline v0

// SPDX-License-Identifier: BSD-3-Clause
#include "sound/live_sound.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "vps_device/metronome.h"

namespace vps::viewer {
namespace {

constexpr double kFullScale_Pa = 0.2;  // 80 dB at the listener. assumed: the sound of a tool that is put down
constexpr float kLiveBeepLevel = 0.1f;  // -20 dB, as in WAV files
// Number of snapshots that may wait: half a second at 1 kHz. Older snapshots are too late and are dropped.
constexpr std::size_t kMostWaiting = 500;

float loudness(float pressure_Pa) {
  return std::tanh(pressure_Pa / static_cast<float>(kFullScale_Pa));  // louder samples saturate smoothly
}

}  // namespace

struct LiveSound::Impl {
  const scenes::Scene& scene;
  LastingOutput output;
  std::mutex mutex;
  std::condition_variable wake;
  std::vector<scenes::Snapshot> waiting;
  std::vector<device::Beep> beeps;
  std::string news;  ///< next message to the user; empty: no message
  Pose X_WL;         ///< listener's pose
  std::string told;  ///< last message
  bool is_ending = false;
  std::thread thread;

  Impl(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output,
       std::function<std::unique_ptr<SoundOutput>()> open, double wait_s)
      : scene(scene),
        output(std::move(output), std::move(open), wait_s, [this](const std::string& words) { tell(words); }),
        thread([this] { work(); }) {}

  bool isEnding() {
    const std::lock_guard lock(mutex);
    return is_ending;
  }
  void work() {
    std::vector<scenes::Snapshot> shots;
    std::vector<device::Beep> new_beeps;
    RunSound sound(scene);
    bool is_ready = false;
    std::optional<Vec3> p_W;  // place of the last contact; parts may still ring after it
    Pose X_WL;
    for (;;) {
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [this] { return is_ending || !waiting.empty(); });
        if (is_ending) return;
        shots = std::exchange(waiting, {});
        new_beeps = std::exchange(beeps, {});
        X_WL = this->X_WL;
      }
      if (!std::exchange(is_ready, true))  // modes are computed before the first contact
        for (std::size_t i = 0; i < scene.parts.size() && !isEnding(); ++i)
          if (scene.parts[i].model) sound.prepare(i);
      for (const device::Beep beep : new_beeps) sound.beep(beep);
      for (const scenes::Snapshot& shot : shots) {
        sound.hear(shot);
        if (const std::optional<Vec3> place_W = soundPlace(shot)) p_W = place_W;
      }
      play(sound.take(), p_W ? X_WL.inverse() * *p_W : -Vec3::UnitZ());
    }
  }

  void play(RunSound::Samples heard, const Vec3& to_L) {
    for (float& x : heard.pressure_Pa) x = loudness(x);
    for (float& x : heard.beeps) x = std::clamp(kLiveBeepLevel * x, -1.0f, 1.0f);
    output.write(heard.pressure_Pa, heard.beeps, to_L);
  }
  void tell(const std::string& words) {
    const std::lock_guard lock(mutex);
    if (words != told) news = told = words;
  }
};

std::optional<Vec3> soundPlace(const scenes::Snapshot& shot) {
  Vec3 sum_W = Vec3::Zero();
  double force_N = 0;
  for (const scenes::ContactMark& mark : shot.contacts) {
    sum_W += mark.force_N * mark.p_W;
    force_N += mark.force_N;
  }
  if (!(force_N > 0)) return {};
  return Vec3(sum_W / force_N);
}

LiveSound::LiveSound(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output,
                     std::function<std::unique_ptr<SoundOutput>()> open, double wait_s)
    : impl_(std::make_unique<Impl>(scene, std::move(output), std::move(open), wait_s)) {}

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

void LiveSound::listenAt(const Pose& X_WL) {
  const std::lock_guard lock(impl_->mutex);
  impl_->X_WL = X_WL;
}

void LiveSound::beep(device::Beep beep) {
  const std::lock_guard lock(impl_->mutex);
  impl_->beeps.push_back(beep);
}

std::string LiveSound::takeNews() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->news, {});
}

LastingOutput::LastingOutput(std::unique_ptr<SoundOutput> output,
                             std::function<std::unique_ptr<SoundOutput>()> open, double wait_s,
                             std::function<void(const std::string&)> tell)
    : output_(std::move(output)), open_(std::move(open)), wait_s_(wait_s), tell_(std::move(tell)) {}

bool LastingOutput::isOpen() {
  if (output_) return true;
  const double now_s = device::monotonicSeconds();
  if (!open_ || now_s < next_s_) return false;
  next_s_ = now_s + wait_s_;
  output_ = open_();
  if (output_) tell_("the sound card is back");
  return output_ != nullptr;
}

void LastingOutput::write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) {
  if (!isOpen()) return;
  output_->write(parts, beeps, to_L);
  if (output_->isThere()) return;
  tell_("the sound card was disconnected; the run continues without sound");
  if (!open_) return;
  output_.reset();  // closed before open_() is called, since a card can be opened only once
  next_s_ = device::monotonicSeconds() + wait_s_;
}

}  // namespace vps::viewer

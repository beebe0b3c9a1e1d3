// SPDX-License-Identifier: BSD-3-Clause
#include "run/blow_sounds.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "run/hand_drag.h"
#include "sound/voices.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::viewer {

namespace {

constexpr double kLeastSpeed_m_s = 2e-3;  // assumed: slower impacts are inaudible
constexpr double kLength_s = 0.4;  // assumed: by then the sound of a part in a hand has decayed by 70 dB
constexpr std::size_t kMostWaitingBlows = 4;  // a listener cannot tell more impacts apart

std::vector<double> massesOf(const scenes::Scene& scene) {
  std::vector<double> masses_kg;
  for (const scenes::ScenePart& part : scene.parts)
    masses_kg.push_back(
        part.is_fixed ? 0 : std::abs(scenes::partMass(part).volume_m3) * part.part.material.density_kg_m3);
  return masses_kg;
}

}  // namespace

std::optional<Blow> BlowSense::hear(const scenes::Snapshot& shot) {
  const scenes::BodySnapshot* body = partInHand(shot);
  const scenes::BodySnapshot* before = last_ ? partInHand(*last_) : nullptr;
  std::optional<Blow> blow;
  const bool is_same =
      body != nullptr && before != nullptr && body->part == before->part && shot.time_s > last_->time_s;
  if (!is_same) {
    v_W_.setZero();
  } else {
    const double mass_kg = body->part < masses_kg_.size() ? masses_kg_[body->part] : 0;
    Vec3 n_W = Vec3::Zero(), p_W = Vec3::Zero();
    for (const scenes::ContactMark& mark : shot.contacts) {
      n_W += mark.n_W;
      p_W += mark.p_W / static_cast<double>(shot.contacts.size());
    }
    const Vec3 v_W = (body->X_WP.p - before->X_WP.p) / (shot.time_s - last_->time_s);
    if (last_->contacts.empty() && n_W.norm() > 0) {
      n_W.normalize();
      // The normal may point to either of the two parts.
      const double speed_m_s = std::abs(n_W.dot(v_W_)) - std::max(0.0, std::abs(n_W.dot(v_W)));
      if (speed_m_s > kLeastSpeed_m_s)
        blow = Blow{
            body->part, mass_kg * speed_m_s, body->X_WP.inverse() * p_W, body->X_WP.R.transpose() * n_W, p_W,
            0};
    }
    v_W_ = v_W;
  }
  last_ = shot;
  return blow;
}

struct BlowSounds::Impl {
  explicit Impl(const scenes::Scene& given) : scene(given), sense(massesOf(given)) {
    thread = std::thread([this] { run(); });
  }
  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      is_over = true;
    }
    wake.notify_one();
    thread.join();
  }

  void run() {
    SoundSettings settings;
    settings.rate_hz = BlowSound::kRate_hz;
    std::map<std::size_t, PartVoice> voices;
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait(lock, [this] { return is_over || !blows.empty(); });
      if (is_over) return;
      const Blow blow = blows.front();
      blows.pop_front();
      lock.unlock();
      auto voice = voices.find(blow.part);
      if (voice == voices.end())
        voice = voices.emplace(blow.part, partVoice(scene.parts[blow.part], settings)).first;
      BlowSound heard{sound(voice->second, blow), blow.p_W, blow.taken_ns};
      lock.lock();
      ready.push_back(std::move(heard));
    }
  }
  [[nodiscard]] std::vector<double> sound(PartVoice& voice, const Blow& blow) const {
    const double length_s = impactDuration_s(voice.mass_kg(), planeStrain_Pa(scene.parts[blow.part]),
                                             blow.impulse_Ns / std::max(1e-9, voice.mass_kg()));
    const Impact impact{voice.touch(blow.p_P, blow.n_P), blow.impulse_Ns, 0,
                        std::max(1.0, length_s * BlowSound::kRate_hz)};
    std::vector<double> pressure_Pa(static_cast<std::size_t>(kLength_s * BlowSound::kRate_hz));
    for (std::size_t i = 0; i < pressure_Pa.size(); ++i) {
      const auto sample = static_cast<long>(i);
      if (!impact.isOver(sample)) voice.push(impact.touch, impact.force_N(sample, BlowSound::kRate_hz));
      pressure_Pa[i] = voice.next();
    }
    return pressure_Pa;
  }

  scenes::Scene scene;
  BlowSense sense;
  std::mutex mutex;
  std::condition_variable wake;
  std::deque<Blow> blows;
  std::vector<BlowSound> ready;
  bool is_over = false;
  std::thread thread;  // declared last, since the thread uses the other members
};

BlowSounds::BlowSounds(const scenes::Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
BlowSounds::~BlowSounds() = default;

void BlowSounds::hear(const scenes::Snapshot& shot, std::int64_t taken_ns) {
  std::optional<Blow> blow = impl_->sense.hear(shot);
  if (!blow) return;
  blow->taken_ns = taken_ns;
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->blows.size() >= kMostWaitingBlows) return;
    impl_->blows.push_back(*blow);
  }
  impl_->wake.notify_one();
}

std::vector<BlowSound> BlowSounds::take() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->ready, {});
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "run/followed_session.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "run/blow_sounds.h"
#include "sound/live_sound.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"
#include "vps_scenes/fits/check_types.h"

namespace vps::viewer {

namespace {

constexpr double kFullBlow_Pa = 0.2;  // full scale, the same as for the sound of a run in live_sound.cpp
constexpr std::chrono::milliseconds kSoundPeriod{10};
/// Delay from a snapshot to its sound: synthesis, the period of the writing thread, and the card's three
/// periods. assumed from the 9 ms that `vps view --measure-latency` measures from a contact to its sample.
constexpr std::int64_t kSoundWay_ns = 9'000'000;
constexpr double kReopen_s = 2;  // time between attempts to open a card that was lost; as in LiveSound

}  // namespace

/// Plays impacts through the loudspeakers. The card plays samples as soon as it gets them, so a thread writes
/// them at a constant rate, also while the window draws a slow picture.
struct FollowedSession::Sound {
  Sound(const scenes::Scene& scene, std::unique_ptr<SoundOutput> card)
      : output(std::move(card), &Sound::open, kReopen_s, [this](const std::string& words) { tell(words); }),
        blows(scene),
        thread([this] { run(); }) {}
  ~Sound() {
    is_over = true;
    thread.join();
  }

  void hear(const scenes::Snapshot& shot) {
    const std::lock_guard lock(mutex);
    blows.hear(shot);
  }
  void listenAt(const Pose& pose) {
    const std::lock_guard lock(mutex);
    X_WL = pose;
  }
  /// A message that the sound card was lost or is back; empty: nothing changed since the last call.
  std::string takeNews() {
    const std::lock_guard lock(mutex);
    return std::exchange(news, {});
  }
  void run() {
    constexpr std::size_t kPeriod = BlowSound::kRate_hz / 100;  // samples of kSoundPeriod
    std::vector<float> ahead, silence(kPeriod);
    Vec3 to_L = -Vec3::UnitZ();
    bool was_open = true;
    for (auto next = std::chrono::steady_clock::now(); !is_over; next += kSoundPeriod) {
      {
        const std::lock_guard lock(mutex);
        for (const BlowSound& blow : blows.take()) {
          ahead.resize(std::max(ahead.size(), blow.pressure_Pa.size()));
          for (std::size_t i = 0; i < blow.pressure_Pa.size(); ++i)
            ahead[i] += static_cast<float>(std::tanh(blow.pressure_Pa[i] / kFullBlow_Pa));
          to_L = X_WL.inverse() * blow.p_W;
        }
      }
      ahead.resize(std::max(ahead.size(), kPeriod));
      for (float& x : ahead) x = std::clamp(x, -1.0f, 1.0f);
      if (!std::exchange(was_open, output.isOpen()))
        next = std::chrono::steady_clock::now();  // no samples for the time without a card
      output.write(std::span(ahead).first(kPeriod), silence, to_L);
      ahead.erase(ahead.begin(), ahead.begin() + kPeriod);
      std::this_thread::sleep_until(next + kSoundPeriod);
    }
  }

  static std::unique_ptr<SoundOutput> open() {
    std::string still_silent;
    return openSoundOutput(BlowSound::kRate_hz, still_silent);
  }
  void tell(const std::string& words) {
    const std::lock_guard lock(mutex);
    if (words != told) news = told = words;
  }

  LastingOutput output;
  std::mutex mutex;
  std::string news;  ///< next message; empty: none
  std::string told;  ///< last message
  BlowSounds blows;
  Pose X_WL;
  std::atomic<bool> is_over{false};
  std::thread thread;  // declared last, since the thread uses the other members
};

FollowedSession::FollowedSession(std::unique_ptr<scenes::SessionWatcher> watcher, const std::string& session,
                                 const scenes::SessionNetwork& network, bool has_sound)
    : watcher_(std::move(watcher)), sounds_(kPresentAfter_ns - kSoundWay_ns) {
  try {
    pointing_.emplace(session, network);
  } catch (const LoadError& refused) {  // certificates made before pointers existed
    messages_.push_back(std::string("the pointers of other people cannot be shown: ") + refused.what());
  }
  if (!has_sound) return;
  std::string why;
  if (std::unique_ptr<SoundOutput> card = openSoundOutput(BlowSound::kRate_hz, why))
    sound_ = std::make_unique<Sound>(watcher_->scene(), std::move(card));
  if (!why.empty()) messages_.push_back(why);
}

FollowedSession::~FollowedSession() = default;

void FollowedSession::poll() {
  if (sound_)
    if (const std::string news = sound_->takeNews(); !news.empty()) messages_.push_back(news);
  if (is_over_) return;
  const bool is_over = watcher_->isOver();  // asked before the news is read, so that none is missed
  while (const auto news = watcher_->takeNews()) tell(*news);
  for (const std::string& doubt : watcher_->takeDoubts()) messages_.push_back(doubt);
  if (pointing_)
    for (const scenes::SessionPointer& pointer : pointing_->take()) {
      if (pointer.p_W)
        others_[pointer.who] = *pointer.p_W;
      else
        others_.erase(pointer.who);
    }
  const std::int64_t now_ns = device::monotonicClock().now_ns();
  if (std::optional<scenes::Snapshot> shot = watcher_->takeSnapshot()) {
    const std::int64_t taken_ns = watcher_->snapshotSent_ns();
    if (sound_) sounds_.add(*shot, taken_ns, now_ns);
    pictures_.add(std::move(*shot), taken_ns, now_ns);
  }
  sounds_.take(now_ns, [this](const scenes::Snapshot& shot, std::int64_t) { sound_->hear(shot); });
  pictures_.take(now_ns, [this](scenes::Snapshot&& shot, std::int64_t) { newest_ = std::move(shot); });
  const bool has_device = watcher_->hasDevice();
  if (had_device_ && !has_device && !is_over) messages_.emplace_back("no device is in the session any more");
  had_device_ = has_device;
  if (!is_over) return;
  is_over_ = true;
  others_.clear();
  messages_.emplace_back(watcher_->hasEnded() ? "the session has ended" : "the render node is lost");
}

void FollowedSession::tell(const scenes::SessionNews& news) {
  if (news.kind == scenes::SessionNews::Kind::StepDone) steps_[news.step] = news.verdict;
  if (news.kind == scenes::SessionNews::Kind::Ended) verdict_ = news.verdict;
  messages_.push_back(news.text);
}

void FollowedSession::point(const std::optional<Vec3>& p_W) {
  if (!pointing_ || is_over_) return;
  pointing_->point(1, p_W);
  own_ = p_W;
}

void FollowedSession::listenAt(const Pose& X_WL) {
  if (sound_) sound_->listenAt(X_WL);
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Sound output by OpenAL Soft. Only this file includes OpenAL.
#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "sound/live_sound.h"
#include "sound/queue_level.h"
#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"

namespace vps::viewer {
namespace {

constexpr int kMixerPriority = 1;  // the priority that askForShortPeriods() gives to OpenAL's own thread
// Upper bound of a period; a longer period reported by a driver is replaced by this bound.
constexpr double kSlowCard_s = 0.1;

/// A source that plays a queue of short buffers. The OpenAL context must be current in all functions.
class Queue {
 public:
  /// @param period_s  time of the samples that the card takes at once
  Queue(int rate_hz, double period_s) : rate_hz_(rate_hz), level_(rate_hz, period_s) {
    alGenSources(1, &source_);
    // The source's position is only a direction from the listener; loudness is in the samples.
    alSourcei(source_, AL_SOURCE_RELATIVE, AL_TRUE);
    alSourcef(source_, AL_ROLLOFF_FACTOR, 0);
  }
  ~Queue() {
    alSourceStop(source_);
    alDeleteSources(1, &source_);  // frees its queued buffers, too
    for (const Waiting& waiting : waiting_) free_.push_back(waiting.buffer);
    alDeleteBuffers(static_cast<ALsizei>(free_.size()), free_.data());
  }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  void place(const Vec3& to_L) {
    const Eigen::Vector3f at = to_L.cast<float>();
    alSource3f(source_, AL_POSITION, at.x(), at.y(), at.z());
  }
  void write(std::span<const float> samples) {
    if (samples.empty()) return;
    ALint state = 0;
    alGetSourcei(source_, AL_SOURCE_STATE, &state);
    const bool is_playing = state == AL_PLAYING;
    const QueuePlan plan =
        level_.plan(is_playing, reclaim(), samples.size(), peakOf(samples), device::monotonicSeconds());
    if (plan.silence > 0) append(std::vector<float>(plan.silence));
    append(shortened(samples, plan.dropped));
    if (!is_playing) alSourcePlay(source_);
  }
  [[nodiscard]] std::size_t gaps() const { return level_.gaps(); }

 private:
  struct Waiting {
    ALuint buffer = 0;
    std::size_t count = 0;
  };

  static float peakOf(std::span<const float> samples) {
    float peak = 0;
    for (const float x : samples) peak = std::max(peak, std::abs(x));
    return peak;
  }
  /// Takes back the buffers that were played.
  /// @return number of samples that the card has not taken yet
  std::size_t reclaim() {
    ALint done = 0, at = 0;
    alGetSourcei(source_, AL_BUFFERS_PROCESSED, &done);
    for (; done > 0 && !waiting_.empty(); --done) {
      alSourceUnqueueBuffers(source_, 1, &waiting_.front().buffer);
      free_.push_back(waiting_.front().buffer);
      waiting_.pop_front();
    }
    std::size_t count = 0;
    for (const Waiting& waiting : waiting_) count += waiting.count;
    alGetSourcei(source_, AL_SAMPLE_OFFSET, &at);
    return count - std::min(count, static_cast<std::size_t>(std::max(at, 0)));
  }
  void append(std::span<const float> samples) {
    if (samples.empty()) return;
    if (free_.empty()) alGenBuffers(1, &free_.emplace_back());
    const ALuint buffer = free_.back();
    free_.pop_back();
    pcm_.resize(samples.size());
    std::ranges::transform(samples, pcm_.begin(),
                           [](float x) { return static_cast<std::int16_t>(std::lround(32767 * x)); });
    alBufferData(buffer, AL_FORMAT_MONO16, pcm_.data(),
                 static_cast<ALsizei>(pcm_.size() * sizeof(std::int16_t)), rate_hz_);
    alSourceQueueBuffers(source_, 1, &buffer);
    waiting_.push_back({buffer, samples.size()});
  }

  int rate_hz_;
  QueueLevel level_;
  ALuint source_ = 0;
  std::deque<Waiting> waiting_;
  std::vector<ALuint> free_;
  std::vector<std::int16_t> pcm_;
};

class OpenAlOutput final : public SoundOutput {
 public:
  OpenAlOutput(ALCdevice* device, ALCcontext* context, int rate_hz, double period_s)
      : device_(device),
        context_(context),
        parts_(std::make_unique<Queue>(rate_hz, period_s)),
        beeps_(std::make_unique<Queue>(rate_hz, period_s)) {}
  ~OpenAlOutput() override {
    alcMakeContextCurrent(context_);
    parts_.reset();
    beeps_.reset();
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(context_);
    alcCloseDevice(device_);
  }
  OpenAlOutput(const OpenAlOutput&) = delete;
  OpenAlOutput& operator=(const OpenAlOutput&) = delete;

  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) override {
    alcMakeContextCurrent(
        context_);  // sets the context of the whole process, since a process has only one context
    if (to_L.allFinite()) parts_->place(to_L);
    parts_->write(parts);
    beeps_->write(beeps);
  }
  [[nodiscard]] bool isThere() const override {
    if (alcIsExtensionPresent(device_, "ALC_EXT_disconnect") == ALC_FALSE) return true;
    ALCint is_connected = 1;
    alcGetIntegerv(device_, ALC_CONNECTED, 1, &is_connected);
    return is_connected != 0;
  }
  [[nodiscard]] std::size_t gaps() const override { return parts_->gaps(); }

 private:
  ALCdevice* device_;
  ALCcontext* context_;
  std::unique_ptr<Queue> parts_, beeps_;
};

/// The card of openSoundLoopback(): a thread that mixes a period whenever a real card would have played one.
class LoopbackCard {
 public:
  LoopbackCard(ALCdevice* device, int rate_hz, HeardPeriod heard)
      : render_(reinterpret_cast<LPALCRENDERSAMPLESSOFT>(alcGetProcAddress(device, "alcRenderSamplesSOFT"))),
        device_(device),
        rate_hz_(rate_hz),
        heard_(std::move(heard)),
        thread_([this] { play(); }) {}
  ~LoopbackCard() {
    is_ending_ = true;
    thread_.join();
  }
  LoopbackCard(const LoopbackCard&) = delete;
  LoopbackCard& operator=(const LoopbackCard&) = delete;

 private:
  void play() {
    const double period_s = static_cast<double>(kCardPeriod) / rate_hz_;
    // Time of the mixed samples that are still to be played.
    const double ahead_s = (kCardPeriods - 1) * period_s;
    std::vector<float> stereo(std::size_t{2} * kCardPeriod), mono(kCardPeriod);
    device::requestRealTime(kMixerPriority, false);  // without the permission the priority stays normal
    double due_s = device::monotonicSeconds();
    while (!is_ending_) {
      device::monotonicClock().sleepUntil(std::llround(1e9 * due_s));
      // Like a real card, this card stops when it has nothing left to play, and starts again with the next
      // samples.
      due_s = std::max(due_s, device::monotonicSeconds() - ahead_s);
      render_(device_, stereo.data(), kCardPeriod);
      for (std::size_t i = 0; i < mono.size(); ++i) mono[i] = 0.5F * (stereo[2 * i] + stereo[2 * i + 1]);
      heard_(mono, due_s + ahead_s);
      due_s += period_s;
    }
  }

  LPALCRENDERSAMPLESSOFT render_;
  ALCdevice* device_;
  int rate_hz_;
  HeardPeriod heard_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;  // declared last, since the thread uses the other members
};

/// An OpenAL output together with its simulated card.
class LoopbackOutput final : public SoundOutput {
 public:
  LoopbackOutput(ALCdevice* device, ALCcontext* context, int rate_hz, HeardPeriod heard)
      : output_(device, context, rate_hz, static_cast<double>(kCardPeriod) / rate_hz),
        card_(device, rate_hz, std::move(heard)) {}
  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) override {
    output_.write(parts, beeps, to_L);
  }
  [[nodiscard]] bool isThere() const override { return true; }
  [[nodiscard]] std::size_t gaps() const override { return output_.gaps(); }

 private:
  OpenAlOutput output_;
  LoopbackCard card_;  // destroyed before its device
};

/// Whether a sound card may exist. Without a sound card, opening one makes the ALSA library print ten lines
/// of errors.
bool mayHaveSoundCard() {
#ifdef __linux__
  for (const char* name : {"ALSOFT_CONF", "ALSOFT_DRIVERS", "PULSE_SERVER"})
    if (const char* value = std::getenv(name); value != nullptr && !isOwnSettings(value)) return true;
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  const std::filesystem::path session = folder != nullptr ? folder : "/run/user/0";
  std::error_code ignored;
  for (const std::filesystem::path& path :
       {std::filesystem::path("/dev/snd"), session / "pulse", session / "pipewire-0"})
    if (std::filesystem::exists(path, ignored)) return true;
  return false;
#else
  return true;
#endif
}

/// Creates a context with filters of a head (HRTF) for headphones, or with panning if OpenAL has no HRTF. If
/// the device refuses, closes it and returns null.
ALCcontext* contextOf(ALCdevice* device, std::vector<ALCint> wishes) {
  if (alcIsExtensionPresent(device, "ALC_SOFT_HRTF") == ALC_TRUE)
    wishes.insert(wishes.end(), {ALC_HRTF_SOFT, ALC_TRUE});
  wishes.push_back(0);
  ALCcontext* context = alcCreateContext(device, wishes.data());
  if (context != nullptr && alcMakeContextCurrent(context) == ALC_TRUE) return context;
  if (context != nullptr) alcDestroyContext(context);
  alcCloseDevice(device);
  return nullptr;
}

}  // namespace

std::unique_ptr<SoundOutput> openSoundOutput(int rate_hz, std::string& why) {
  ALCdevice* device = mayHaveSoundCard() ? alcOpenDevice(nullptr) : nullptr;
  if (device == nullptr) {
    why = "no sound card was found, so the run is silent; vps assemble --sound writes the sound to a file";
    return nullptr;
  }
  ALCcontext* context = contextOf(device, {ALC_FREQUENCY, rate_hz});
  if (context == nullptr) {
    why =
        "the sound card cannot be used, so the run is silent; vps assemble --sound writes the sound to a "
        "file";
    return nullptr;
  }
  ALCint periods_per_s = 0;  // the card's periods may differ from the requested ones
  alcGetIntegerv(device, ALC_REFRESH, 1, &periods_per_s);
  const double period_s = periods_per_s > 0 ? 1.0 / periods_per_s : kSlowCard_s;
  return std::make_unique<OpenAlOutput>(device, context, rate_hz, std::min(period_s, kSlowCard_s));
}

std::unique_ptr<SoundOutput> openSoundLoopback(int rate_hz, HeardPeriod heard, std::string& why) {
  const auto open =
      reinterpret_cast<LPALCLOOPBACKOPENDEVICESOFT>(alcGetProcAddress(nullptr, "alcLoopbackOpenDeviceSOFT"));
  ALCdevice* device = open != nullptr ? open(nullptr) : nullptr;
  ALCcontext* context =
      device != nullptr ? contextOf(device, {ALC_FORMAT_CHANNELS_SOFT, ALC_STEREO_SOFT, ALC_FORMAT_TYPE_SOFT,
                                             ALC_FLOAT_SOFT, ALC_FREQUENCY, rate_hz})
                        : nullptr;
  if (context == nullptr) {
    why = "this OpenAL has no loopback; install libopenal1 (OpenAL Soft)";
    return nullptr;
  }
  return std::make_unique<LoopbackOutput>(device, context, rate_hz, std::move(heard));
}

}  // namespace vps::viewer

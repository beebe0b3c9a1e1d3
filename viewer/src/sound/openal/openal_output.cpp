// SPDX-License-Identifier: BSD-3-Clause
// Loudspeakers by OpenAL Soft. The only file that includes OpenAL.
#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "sound/live_sound.h"

namespace vps::viewer::inline v0 {
namespace {

constexpr int kBuffers = 8;
constexpr std::size_t kAtStart = 3;  // buffers. assumed: 15 ms bridge what a desktop's threads are late
constexpr double kBuffer_s = 5e-3;   // so that at most 40 ms wait, and usually one or two buffers do

/// A source that plays a queue of short buffers. The context is current in all its functions.
class Queue {
 public:
  explicit Queue(int rate_hz) : rate_hz_(rate_hz) {
    alGenSources(1, &source_);
    alGenBuffers(kBuffers, buffers_.data());
    free_.assign(buffers_.begin(), buffers_.end());
    // Directions from the listener; the loudness is in the samples.
    alSourcei(source_, AL_SOURCE_RELATIVE, AL_TRUE);
    alSourcef(source_, AL_ROLLOFF_FACTOR, 0);
  }
  ~Queue() {
    alSourceStop(source_);
    alDeleteSources(1, &source_);
    alDeleteBuffers(kBuffers, buffers_.data());
  }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  void place(const Vec3& to_L) {
    const Eigen::Vector3f at = to_L.cast<float>();
    alSource3f(source_, AL_POSITION, at.x(), at.y(), at.z());
  }
  void write(std::span<const float> samples) {
    for (const float x : samples) pending_.push_back(static_cast<std::int16_t>(std::lround(32767 * x)));
    const auto size = static_cast<std::size_t>(kBuffer_s * rate_hz_);
    ALint state = 0;
    alGetSourcei(source_, AL_SOURCE_STATE, &state);
    reclaim();
    // A source that stopped, since nothing came in time, begins again with a few buffers, or it would stop at
    // once; and what is queued on it before counts as played.
    if (state != AL_PLAYING && pending_.size() < kAtStart * size) return;
    std::size_t at = 0;
    for (; at + size <= pending_.size() && !free_.empty(); at += size) {
      const ALuint buffer = free_.back();
      free_.pop_back();
      alBufferData(buffer, AL_FORMAT_MONO16, &pending_[at], static_cast<ALsizei>(size * sizeof(std::int16_t)),
                   rate_hz_);
      alSourceQueueBuffers(source_, 1, &buffer);
    }
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at));
    // What is late is dropped, so that sound does not lag behind the picture.
    if (pending_.size() > size)
      pending_.erase(pending_.begin(), pending_.end() - static_cast<std::ptrdiff_t>(size));
    if (state != AL_PLAYING) alSourcePlay(source_);
  }

 private:
  void reclaim() {
    ALint done = 0;
    alGetSourcei(source_, AL_BUFFERS_PROCESSED, &done);
    for (; done > 0; --done) {
      ALuint buffer = 0;
      alSourceUnqueueBuffers(source_, 1, &buffer);
      free_.push_back(buffer);
    }
  }

  int rate_hz_;
  ALuint source_ = 0;
  std::array<ALuint, kBuffers> buffers_{};
  std::vector<ALuint> free_;
  std::vector<std::int16_t> pending_;
};

class OpenAlOutput final : public SoundOutput {
 public:
  OpenAlOutput(ALCdevice* device, ALCcontext* context, int rate_hz)
      : device_(device),
        context_(context),
        parts_(std::make_unique<Queue>(rate_hz)),
        beeps_(std::make_unique<Queue>(rate_hz)) {}
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
    alcMakeContextCurrent(context_);  // of the process: this program has one
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

 private:
  ALCdevice* device_;
  ALCcontext* context_;
  std::unique_ptr<Queue> parts_, beeps_;
};

/// Whether it is worth asking: without a card ALSA's own library prints ten lines about it.
bool mayHaveSoundCard() {
#ifdef __linux__
  for (const char* name : {"ALSOFT_CONF", "ALSOFT_DRIVERS", "PULSE_SERVER"})
    if (std::getenv(name) != nullptr) return true;
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

}  // namespace

std::unique_ptr<SoundOutput> openSoundOutput(int rate_hz, std::string& why) {
  ALCdevice* device = mayHaveSoundCard() ? alcOpenDevice(nullptr) : nullptr;
  if (device == nullptr) {
    why = "no sound card answers, so the run is silent; vps assemble --sound writes a file";
    return nullptr;
  }
  // For headphones: the filters of a head (HRTF). Where OpenAL has none it pans.
  const std::array<ALCint, 3> wishes = {ALC_HRTF_SOFT, ALC_TRUE, 0};
  const bool has_hrtf = alcIsExtensionPresent(device, "ALC_SOFT_HRTF") == ALC_TRUE;
  ALCcontext* context = alcCreateContext(device, has_hrtf ? wishes.data() : nullptr);
  if (context == nullptr || alcMakeContextCurrent(context) == ALC_FALSE) {
    if (context != nullptr) alcDestroyContext(context);
    alcCloseDevice(device);
    why = "the sound card refuses, so the run is silent; vps assemble --sound writes a file";
    return nullptr;
  }
  return std::make_unique<OpenAlOutput>(device, context, rate_hz);
}

}  // namespace vps::viewer::inline v0

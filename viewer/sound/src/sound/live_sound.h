// SPDX-License-Identifier: BSD-3-Clause
// The sound of a run while it goes on, through the machine's loudspeakers, which may be unplugged meanwhile.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "vps_viewer/export.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {

/// Where samples go. All its functions are called by one thread.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  /// Samples between -1 and 1, to be heard after what was written before: of the parts, from a direction, and
  /// of the device, from everywhere. Equally many. Never waits; what does not fit is dropped.
  /// @param to_L  the place of the sound from the listener: x right, y up, z back; only its direction counts
  virtual void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) = 0;
  /// False once the sound card is gone.
  [[nodiscard]] virtual bool isThere() const = 0;
  /// Times so far that samples came too late, so that there was nothing to play.
  [[nodiscard]] virtual std::size_t gaps() const { return 0; }
};

/// The middle of the snapshot's contacts, by their forces; none where nothing touches.
VPS_VIEWER_API std::optional<Vec3> soundPlace(const scenes::Snapshot& shot);

/// The system's default output, for headphones (HRTF) where OpenAL has that. Null where there is none, and
/// `why` says so in a line.
VPS_VIEWER_API std::unique_ptr<SoundOutput> openSoundOutput(int rate_hz, std::string& why);

/// Asks OpenAL for cards with short periods, by settings of this process, where the user has none for
/// periods. Before the first openSoundOutput() and before other threads are there, since it sets an
/// environment variable.
VPS_VIEWER_API void askForShortPeriods();
/// True for the value that it gives to ALSOFT_CONF.
VPS_VIEWER_API bool isOwnSettings(const std::string& name);

/// What a card is asked for: samples of a period, and periods. While one is mixed, two are still to be
/// played, so that the mixer may be as late as with two periods of 128 samples, and takes less at once.
inline constexpr int kCardPeriod = 64, kCardPeriods = 3;

/// A period of a sound card in the program, mono, and the time at which its first sample is played, by
/// device::monotonicSeconds().
using HeardPeriod = std::function<void(std::span<const float> samples, double time_s)>;
/// A sound card that exists only in the program, mixed by OpenAL as a real one: kCardPeriods of kCardPeriod
/// samples, by the clock. Null in a build without OpenAL, and `why` says so.
/// @param heard  called on the card's thread
VPS_VIEWER_API std::unique_ptr<SoundOutput> openSoundLoopback(int rate_hz, HeardPeriod heard,
                                                              std::string& why);

/// Synthesises on a thread of its own. hear() and beep() only hand over, so that physics does not wait for
/// modes.
class VPS_VIEWER_API LiveSound {
 public:
  /// The scene outlives it; its models are complete before the first hear().
  /// @param open    opens the output again once it is gone, or gives null; empty: it stays silent then
  /// @param wait_s  between attempts
  LiveSound(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output,
            std::function<std::unique_ptr<SoundOutput>()> open = {}, double wait_s = 2);
  ~LiveSound();
  LiveSound(const LiveSound&) = delete;
  LiveSound& operator=(const LiveSound&) = delete;

  void hear(const scenes::Snapshot& shot);
  /// From now on: the listener's pose in W, x right, y up, z back; as of a camera.
  void listenAt(const Pose& X_WL);
  void beep(device::Beep beep);
  /// Once, if the sound card is gone, or is back: a line that says so.
  [[nodiscard]] std::string takeNews();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes to an output for as long as it is there, and opens it again. Used by one thread.
class LastingOutput {
 public:
  /// @param open    opens the output again once it is gone, or gives null; empty: it stays silent then
  /// @param wait_s  between attempts
  /// @param tell    called when the card is gone, and when it is back, with a line that says so
  LastingOutput(std::unique_ptr<SoundOutput> output, std::function<std::unique_ptr<SoundOutput>()> open,
                double wait_s, std::function<void(const std::string&)> tell);

  /// As SoundOutput::write(); nothing while there is no card. Never throws.
  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L);
  /// False while the card is gone. Tries to open it again where its time has come.
  bool isOpen();

 private:
  std::unique_ptr<SoundOutput> output_;  ///< null: gone
  std::function<std::unique_ptr<SoundOutput>()> open_;
  double wait_s_, next_s_ = 0;  ///< to the next attempt; and when that is, by device::monotonicSeconds()
  std::function<void(const std::string&)> tell_;
};

}  // namespace vps::viewer

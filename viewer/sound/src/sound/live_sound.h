// SPDX-License-Identifier: BSD-3-Clause
// The sound of a live run through the machine's sound card, which may be unplugged and return.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "vps_viewer/export.h"
#include "vps_viewer/sound/sound.h"

namespace vps::viewer {

/// A sink of samples, such as a sound card. All functions are called by one thread.
class SoundOutput {
 public:
  virtual ~SoundOutput() = default;
  /// Appends samples between -1 and 1 to those written before. Never waits; samples that do not fit are
  /// dropped.
  /// @param parts  sound of the parts, heard from the direction to_L
  /// @param beeps  beeps of the device, heard from everywhere; as many samples as `parts`
  /// @param to_L   direction of the sound in the listener's frame: x right, y up, z back; any length
  virtual void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) = 0;
  /// Whether the sound card is still connected.
  [[nodiscard]] virtual bool isThere() const = 0;
  /// Number of gaps so far, in which there was nothing to play because samples came too late.
  [[nodiscard]] virtual std::size_t gaps() const { return 0; }
};

/// Mean position of the snapshot's contacts, weighted by their forces; none without contact.
VPS_VIEWER_API std::optional<Vec3> soundPlace(const scenes::Snapshot& shot);

/// Opens the system's default output, for headphones (HRTF) if OpenAL supports it. If there is no output,
/// returns null and sets `why` to a line of text.
VPS_VIEWER_API std::unique_ptr<SoundOutput> openSoundOutput(int rate_hz, std::string& why);

/// Configures OpenAL in this process to open cards with short periods, unless the user's settings set
/// periods. Call askForShortPeriods() before the first openSoundOutput() and before other threads start,
/// since the call sets an environment variable.
VPS_VIEWER_API void askForShortPeriods();
/// Whether `name` is the value that askForShortPeriods() gives to ALSOFT_CONF.
VPS_VIEWER_API bool isOwnSettings(const std::string& name);

/// Requested samples per period and number of periods of a card. While one period is mixed, two are still to
/// be played. So the mixer may be as late as with two periods of 128 samples, and takes fewer samples at a
/// time.
inline constexpr int kCardPeriod = 64, kCardPeriods = 3;

/// Receives a period of a simulated sound card, in mono, and the time at which its first sample is played, by
/// device::monotonicSeconds().
using HeardPeriod = std::function<void(std::span<const float> samples, double time_s)>;
/// Opens a simulated sound card with kCardPeriods periods of kCardPeriod samples, mixed by OpenAL in real
/// time like a real card. In a build without OpenAL, returns null and sets `why`.
/// @param heard  called on the card's thread
VPS_VIEWER_API std::unique_ptr<SoundOutput> openSoundLoopback(int rate_hz, HeardPeriod heard,
                                                              std::string& why);

/// Synthesises and plays the sound of a run on a thread of its own. hear() and beep() only pass data to this
/// thread, so that physics does not wait.
class VPS_VIEWER_API LiveSound {
 public:
  /// The scene must outlive the LiveSound, and its models must be complete before the first hear().
  /// @param open    opens the output again after it was lost, or returns null; empty: it is not opened again
  /// @param wait_s  time between attempts to open the output again
  LiveSound(const scenes::Scene& scene, std::unique_ptr<SoundOutput> output,
            std::function<std::unique_ptr<SoundOutput>()> open = {}, double wait_s = 2);
  ~LiveSound();
  LiveSound(const LiveSound&) = delete;
  LiveSound& operator=(const LiveSound&) = delete;

  /// Adds the sound up to the snapshot's time.
  void hear(const scenes::Snapshot& shot);
  /// Sets the listener's pose in W: x right, y up, z back, as a camera's pose.
  void listenAt(const Pose& X_WL);
  void beep(device::Beep beep);
  /// A message that the sound card was lost or is back; empty: nothing changed since the last call.
  [[nodiscard]] std::string takeNews();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// An output that is opened again after its sound card was lost. Used by one thread.
class LastingOutput {
 public:
  /// @param open    opens the output again after it was lost, or returns null; empty: it is not opened again
  /// @param wait_s  time between attempts to open the output again
  /// @param tell    called with a message when the card is lost, and when it is back
  LastingOutput(std::unique_ptr<SoundOutput> output, std::function<std::unique_ptr<SoundOutput>()> open,
                double wait_s, std::function<void(const std::string&)> tell);

  /// Writes as SoundOutput::write() does; does nothing while there is no card. Never throws.
  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L);
  /// Whether the output is open. Tries to open a lost output again, at most once every wait_s.
  bool isOpen();

 private:
  std::unique_ptr<SoundOutput> output_;  ///< null: lost
  std::function<std::unique_ptr<SoundOutput>()> open_;
  double wait_s_, next_s_ = 0;  ///< next_s_: time of the next attempt, by device::monotonicSeconds()
  std::function<void(const std::string&)> tell_;
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// A procedure that runs on a thread of its own while a window watches it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "sound/live_sound.h"
#include "vps_scenes/run/assemble.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct LiveSettings {
  std::string record;           ///< file to record the run in; empty: none
  bool is_paused = false;       ///< begins paused
  double speed = 1;             ///< of simulated time by the clock; 0: as fast as it goes
  scenes::ModelOptions models;  ///< progress is replaced
  std::string hand;             ///< kind of device that moves the part; empty: the scene's. See isByPerson()
  std::shared_ptr<device::HandleWish> wish;  ///< of the mouse
  bool has_sound = true;                     ///< where there is a sound card
  bool snaps = false;                        ///< begins with axis snap
  /// A device of one's own that moves the part, in place of `hand` (scenes::AssembleOptions::device).
  std::function<std::unique_ptr<device::Device>()> device;
  /// Where the sound goes; empty: openSoundOutput().
  std::function<std::unique_ptr<SoundOutput>(int rate_hz, std::string& why)> open_sound;
  /// Gets the snapshot of each physics step, on its thread. May be empty.
  std::function<void(const scenes::Snapshot& shot)> watch;
};

/// Whether a person moves this kind of device. Such a run goes by the clock, cannot be paused, and its steps
/// take scenes::kPersonTimeout_s at least.
[[nodiscard]] VPS_VIEWER_API bool isByPerson(const std::string& kind);

/// What is known of a run, for those who watch.
struct LiveStatus {
  std::string doing;      ///< "building models", in words
  double share = 0;       ///< of that, 0 to 1
  double time_s = 0;      ///< simulated
  std::size_t steps = 0;  ///< physics steps so far
  bool is_over = false;
  std::string error;  ///< why it could not go on; empty: nothing
  /// So far; complete when is_over. `finished` shows the parts as the last step left them.
  scenes::AssembleResult result;
};

/// With a virtual operator it runs in simulated time, so that pausing, single steps, its speed, and being
/// watched change no bit of it. With a person it runs by the clock.
class VPS_VIEWER_API LiveRun {
 public:
  /// @param scene    a copy of its own, whose models it builds
  /// @param on_news  called on the run's threads where something new can be asked for
  LiveRun(scenes::Scene scene, const LiveSettings& settings, std::function<void()> on_news);
  /// Stops the run. Waits for the physics step, or for the models, that are being computed.
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  void pause(bool is_paused);
  [[nodiscard]] bool isPaused() const;
  [[nodiscard]] bool isByClock() const { return is_by_clock_; }
  /// Of a paused run: one physics step.
  void oneStep();
  /// Axis snap on or off (scenes::AssembleOptions::snaps).
  void snap(bool snaps) { snaps_ = snaps; }
  /// The listener, as of a camera: see LiveSound.
  void listenAt(const Pose& X_WL) {
    if (sound_) sound_->listenAt(X_WL);
  }
  /// Asks for a snapshot at the end of the next physics step.
  void ask();
  /// What the device and the sound card reported since the last call, in words.
  [[nodiscard]] std::vector<std::string> takeMessages();
  /// The newest snapshot, once.
  [[nodiscard]] std::optional<scenes::Snapshot> take();
  [[nodiscard]] LiveStatus status() const;

 private:
  void run(const LiveSettings& settings);
  void report(const device::DeviceEvent& event);
  /// On the run's thread, after each physics step: waits while paused, or ahead of the clock.
  void keepTime(double time_s);

  scenes::Scene scene_;
  std::function<void()> on_news_;
  std::atomic<bool> stop_{false}, snaps_{false};
  scenes::SnapshotTap tap_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<scenes::Snapshot> newest_;
  std::vector<std::string> messages_;
  std::unique_ptr<LiveSound> sound_;  ///< null: silent
  std::function<void(const scenes::Snapshot&)> watch_;
  /// A snapshot, by the window; with sound or `watch_` the run gives one each step.
  std::atomic<bool> is_asked_{false};
  LiveStatus status_;
  double speed_;
  bool is_paused_;
  bool is_by_clock_ = false;
  int steps_allowed_ = 0;                  ///< while paused
  double clock_s_ = 0, clock_time_s_ = 0;  ///< wall and simulated time when it went on last
  bool is_clock_set_ = false;
  std::thread thread_;  // last, since it uses the others
};

}  // namespace vps::viewer

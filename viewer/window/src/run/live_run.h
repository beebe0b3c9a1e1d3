// SPDX-License-Identifier: BSD-3-Clause
// A run of a procedure on a thread of its own, watched by a window.
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
  bool is_paused = false;       ///< the run begins paused
  double speed = 1;             ///< simulated seconds per real second; 0: as fast as possible
  scenes::ModelOptions models;  ///< `models.progress` is replaced
  std::string hand;  ///< kind of device that moves the part; empty: the scene's kind. See isByPerson()
  std::shared_ptr<device::HandleWish> wish;  ///< pose that the mouse device reads
  bool has_sound = true;                     ///< plays sound, if there is a sound card
  bool snaps = false;                        ///< the run begins with axis snap
  /// Makes the device that moves the part, in place of `hand` (scenes::AssembleOptions::device). May be
  /// empty.
  std::function<std::unique_ptr<device::Device>()> device;
  /// Opens the sound output; empty: openSoundOutput().
  std::function<std::unique_ptr<SoundOutput>(int rate_hz, std::string& why)> open_sound;
  /// Called with the snapshot of each physics step, on the physics thread. May be empty.
  std::function<void(const scenes::Snapshot& shot)> watch;
};

/// Whether a person moves this kind of device. A run with such a device is in real time and cannot be paused,
/// and its steps have a timeout of at least scenes::kPersonTimeout_s.
[[nodiscard]] VPS_VIEWER_API bool isByPerson(const std::string& kind);

/// State of a run, for its watchers.
struct LiveStatus {
  std::string doing;      ///< current work, for example "building models"
  double share = 0;       ///< finished share of that work, 0 to 1
  double time_s = 0;      ///< simulated time
  std::size_t steps = 0;  ///< physics steps so far
  bool is_over = false;
  std::string error;  ///< why the run failed; empty: it did not
  /// Result so far; complete when is_over. `finished` shows the parts as the last step left them.
  scenes::AssembleResult result;
};

/// A run with a virtual operator is in simulated time, so that pauses, single steps, speed and watching
/// change no bit of its results. A run with a person is in real time.
class VPS_VIEWER_API LiveRun {
 public:
  /// @param scene    the run builds the models of this copy
  /// @param on_news  called on the run's threads when there is a new snapshot or status
  LiveRun(scenes::Scene scene, const LiveSettings& settings, std::function<void()> on_news);
  /// Stops the run. Waits until the current physics step, or the models under construction, are done.
  ~LiveRun();
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  void pause(bool is_paused);
  [[nodiscard]] bool isPaused() const;
  [[nodiscard]] bool isByClock() const { return is_by_clock_; }
  /// Lets a paused run make one physics step.
  void oneStep();
  /// Switches axis snap on or off (scenes::AssembleOptions::snaps).
  void snap(bool snaps) { snaps_ = snaps; }
  /// Sets the listener's pose, with the axes of a camera; see LiveSound.
  void listenAt(const Pose& X_WL) {
    if (sound_) sound_->listenAt(X_WL);
  }
  /// Asks for a snapshot at the end of the next physics step.
  void ask();
  /// Messages of the device and of the sound card since the last call.
  [[nodiscard]] std::vector<std::string> takeMessages();
  /// The newest snapshot; empty if it was taken already.
  [[nodiscard]] std::optional<scenes::Snapshot> take();
  [[nodiscard]] LiveStatus status() const;

 private:
  void run(const LiveSettings& settings);
  void report(const device::DeviceEvent& event);
  /// Called on the run's thread after each physics step: waits while the run is paused or ahead of its speed.
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
  /// The window has asked for a snapshot. With sound or `watch_` the run makes a snapshot in each step
  /// anyway.
  std::atomic<bool> is_asked_{false};
  LiveStatus status_;
  double speed_;
  bool is_paused_;
  bool is_by_clock_ = false;
  int steps_allowed_ = 0;                  ///< physics steps that a paused run may still make
  double clock_s_ = 0, clock_time_s_ = 0;  ///< wall and simulated time when the run last resumed
  bool is_clock_set_ = false;
  std::thread thread_;  // declared last, since the thread uses the other members
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// What the page shows: a session of other nodes, a run of this process, or a recording.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/hand_drag.h"
#include "vps_device/recording.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/network/session_pointers.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/web/web.h"

namespace vps::viewer {

struct WatchedShot {
  scenes::Snapshot snapshot;
  std::int64_t taken_ns = 0;  ///< by the monotonic clock of this machine
};

struct WatchedNews {
  double time_s = 0;  ///< simulated
  std::string text;
  std::optional<scenes::Verdict> verdict;  ///< of the whole run: it has ended
};

/// Of a recording, which browsers play.
struct Playback {
  double begin_s = 0, end_s = 0;
  bool is_playing = false;
  bool operator==(const Playback&) const = default;
};

/// Used by one thread. Nothing of it waits.
class WatchedRun {
 public:
  virtual ~WatchedRun() = default;

  /// Looks for what is new. Call it before the others.
  virtual void poll() = 0;
  /// Null: there is none yet. It stays while number() does.
  [[nodiscard]] virtual const scenes::Scene* scene() const = 0;
  /// Counts the scenes so far.
  [[nodiscard]] virtual int number() const = 0;
  /// What it waits for or works on, in words; empty: it runs.
  [[nodiscard]] virtual std::string doing() const = 0;
  /// The newest snapshot, once.
  virtual std::optional<WatchedShot> takeShot() = 0;
  /// Each once.
  virtual std::vector<WatchedNews> takeNews() = 0;
  /// By which the page moves the part in hand; null: it may not. It stays while number() does.
  [[nodiscard]] virtual HandDrag* drag() = 0;

  /// A person of the page points at a place in W, or no longer: for those who watch elsewhere.
  virtual void point(int, const std::optional<Vec3>&) {}
  /// What those elsewhere point at, each change once.
  virtual std::vector<scenes::SessionPointer> takePointers() { return {}; }

  /// Empty: a run that goes on by itself.
  [[nodiscard]] virtual std::optional<Playback> playback() const { return {}; }
  virtual void play(bool) {}
  /// Times outside are the nearest inside.
  virtual void seek(double) {}
};

/// Follows the session, and the next one when it has ended. With the right to the hand this process is the
/// session's device.
std::unique_ptr<WatchedRun> watchedSession(const WebOptions& options);
/// Runs the scene's procedure in this process, again and again if there is nobody's hand to wait for.
std::unique_ptr<WatchedRun> watchedScene(const scenes::Scene& scene, const WebOptions& options);
/// Plays from its begin. Throws LoadError where nothing of a run is in it.
std::unique_ptr<WatchedRun> watchedRecording(const device::RecordedRun& run);

}  // namespace vps::viewer

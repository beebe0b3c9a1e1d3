// SPDX-License-Identifier: BSD-3-Clause
// The run that the page shows: a session of other nodes, a run of this process, or a recording.
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
  std::int64_t taken_ns = 0;  ///< time of the snapshot by this machine's monotonic clock
};

struct WatchedNews {
  double time_s = 0;  ///< simulated time
  std::string text;
  std::optional<scenes::Verdict> verdict;  ///< verdict on the whole run, which has ended
};

/// State of playback of a recording.
struct Playback {
  double begin_s = 0, end_s = 0;
  bool is_playing = false;
  bool operator==(const Playback&) const = default;
};

/// Used by one thread. No function waits.
class WatchedRun {
 public:
  virtual ~WatchedRun() = default;

  /// Receives what the run has reported since the last call. Call poll() before the functions below.
  virtual void poll() = 0;
  /// The scene; null: there is none yet. The pointer stays valid until number() changes.
  [[nodiscard]] virtual const scenes::Scene* scene() const = 0;
  /// Number of scenes so far.
  [[nodiscard]] virtual int number() const = 0;
  /// Text that tells what the run waits for or works on; empty: it runs.
  [[nodiscard]] virtual std::string doing() const = 0;
  /// The newest snapshot; empty if it was taken already.
  virtual std::optional<WatchedShot> takeShot() = 0;
  /// The messages and verdicts since the last call.
  virtual std::vector<WatchedNews> takeNews() = 0;
  /// Moves the part in hand; null: the page may not move it. The pointer stays valid until number() changes.
  [[nodiscard]] virtual HandDrag* drag() = 0;

  /// Tells watchers elsewhere that a person of the page points at a place in W, or at none.
  virtual void point(int, const std::optional<Vec3>&) {}
  /// Changes of the pointers of watchers elsewhere since the last call.
  virtual std::vector<scenes::SessionPointer> takePointers() { return {}; }

  /// State of playback; empty: the run is not a recording.
  [[nodiscard]] virtual std::optional<Playback> playback() const { return {}; }
  virtual void play(bool) {}
  /// Shows another time of a recording; the time is clamped to its range.
  virtual void seek(double) {}
};

/// Follows the session; after its end, the next session with the same name. If options.allows_hand, this
/// process is the session's device.
std::unique_ptr<WatchedRun> watchedSession(const WebOptions& options);
/// Runs the scene's procedure in this process, repeatedly unless a person moves the part.
std::unique_ptr<WatchedRun> watchedScene(const scenes::Scene& scene, const WebOptions& options);
/// Plays a recording from its beginning. Throws LoadError if the recording has no recorded step.
std::unique_ptr<WatchedRun> watchedRecording(const device::RecordedRun& run);

}  // namespace vps::viewer

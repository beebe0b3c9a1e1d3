// SPDX-License-Identifier: BSD-3-Clause
// A session of vps render that a window follows: its snapshots, messages, sound, and people's pointers.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/presentation.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/network/session_pointers.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Used by one thread. No function waits.
class VPS_VIEWER_API FollowedSession {
 public:
  /// @param watcher    watcher of the session with the name `session`
  /// @param has_sound  plays impacts, if there is a sound card
  FollowedSession(std::unique_ptr<scenes::SessionWatcher> watcher, const std::string& session,
                  const scenes::SessionNetwork& network, bool has_sound);
  ~FollowedSession();
  FollowedSession(const FollowedSession&) = delete;
  FollowedSession& operator=(const FollowedSession&) = delete;

  [[nodiscard]] const scenes::Scene& scene() const { return watcher_->scene(); }
  /// Reads the session's new snapshots and messages. Call it several times a second, before the functions
  /// below.
  void poll();
  /// The newest snapshot that is due (see presentation.h); empty if it was taken already.
  std::optional<scenes::Snapshot> take() { return std::exchange(newest_, std::nullopt); }
  /// The messages for the user since the last call.
  std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }
  /// Verdicts of the finished steps, by step.
  [[nodiscard]] const std::map<int, scenes::Verdict>& steps() const { return steps_; }
  /// Verdict of the run; empty: the run has not ended.
  [[nodiscard]] std::optional<scenes::Verdict> verdict() const { return verdict_; }
  /// Whether the session has ended or its render node is lost.
  [[nodiscard]] bool isOver() const { return is_over_; }

  /// The places that other people point at, by person.
  [[nodiscard]] const std::map<int, Vec3>& pointers() const { return others_; }
  /// Shows all other people the place that the person at this window points at; none: removes the mark.
  void point(const std::optional<Vec3>& p_W);
  [[nodiscard]] const std::optional<Vec3>& pointing() const { return own_; }

  /// Sets the listener's pose, with the axes of a camera.
  void listenAt(const Pose& X_WL);

 private:
  struct Sound;
  void tell(const scenes::SessionNews& news);

  std::unique_ptr<scenes::SessionWatcher> watcher_;
  std::optional<scenes::SessionPointers> pointing_;
  std::unique_ptr<Sound> sound_;  ///< null: silent
  Presentation pictures_, sounds_;
  std::optional<scenes::Snapshot> newest_;
  std::vector<std::string> messages_;
  std::map<int, scenes::Verdict> steps_;
  std::optional<scenes::Verdict> verdict_;
  std::map<int, Vec3> others_;
  std::optional<Vec3> own_;
  bool is_over_ = false, had_device_ = true;
};

}  // namespace vps::viewer

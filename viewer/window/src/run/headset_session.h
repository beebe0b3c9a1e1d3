// SPDX-License-Identifier: BSD-3-Clause
// A headset of this machine that shows the scene on a table in front of its wearer, by OpenXR.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// State of a controller of the headset. Controller 0 is the left one, 1 the right one.
struct HeadsetHand {
  bool is_tracked = false, is_taking = false;  ///< is_taking: the trigger is held
  Pose X_WH;                                   ///< pose in the scene; the controller points along its -z
};

/// Draws on a thread of its own, with an OpenGL context of its own, so that neither the window nor a run
/// waits.
class VPS_VIEWER_API HeadsetSession {
 public:
  /// Connects to the headset; null if that is not possible.
  /// @param scene    its meshes must outlive the session
  /// @param box_W    bounds of the scene that is placed on the table
  /// @param on_news  called on the session's thread when hands() or the messages have changed
  /// @param why_not  receives the reason if the result is null: no runtime, no headset, no X display
  static std::unique_ptr<HeadsetSession> begin(const RenderScene& scene, const Box& box_W,
                                               std::function<void()> on_news, std::string& why_not);
  ~HeadsetSession();
  HeadsetSession(const HeadsetSession&) = delete;
  HeadsetSession& operator=(const HeadsetSession&) = delete;

  /// Sets the snapshot that the headset shows from the next frame on.
  void show(const scenes::Snapshot& snapshot, const DrawOptions& options);
  [[nodiscard]] std::array<HeadsetHand, 2> hands() const;
  /// Vibrates a controller for a moment.
  /// @param share  strength, as a share of the greatest amplitude
  void tremble(std::size_t hand, double share);
  /// Messages for the user since the last call: the session has begun or has ended.
  [[nodiscard]] std::vector<std::string> takeMessages();

  struct Work;

 private:
  explicit HeadsetSession(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace vps::viewer

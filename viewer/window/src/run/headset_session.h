// SPDX-License-Identifier: BSD-3-Clause
// A headset of this machine that shows the scene on a table before its wearer, by OpenXR.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vps_viewer/draw/render_scene.h"

namespace vps::viewer {

/// A controller of the headset: 0 the left one, 1 the right one.
struct HeadsetHand {
  bool is_tracked = false, is_taking = false;  ///< taking: its trigger is held
  Pose X_WH;                                   ///< in the scene; it points along its -z
};

/// Draws on a thread of its own, with an OpenGL context of its own: no other picture waits for it, nor a run.
class VPS_VIEWER_API HeadsetSession {
 public:
  /// @param scene    its meshes outlive the session
  /// @param box_W    what is to stand on the table
  /// @param on_news  called on the session's thread when hands() or the messages have changed
  /// @param why_not  in words, where the result is null: no runtime, no headset, no X display
  static std::unique_ptr<HeadsetSession> begin(const RenderScene& scene, const Box& box_W,
                                               std::function<void()> on_news, std::string& why_not);
  ~HeadsetSession();
  HeadsetSession(const HeadsetSession&) = delete;
  HeadsetSession& operator=(const HeadsetSession&) = delete;

  /// What is shown from the next frame on.
  void show(const scenes::Snapshot& snapshot, const DrawOptions& options);
  [[nodiscard]] std::array<HeadsetHand, 2> hands() const;
  /// Lets a controller tremble as strongly as that share of its most, for a moment.
  void tremble(std::size_t hand, double share);
  /// What happened since the last call, in words: the headset was put on, or its session has ended.
  [[nodiscard]] std::vector<std::string> takeMessages();

  struct Work;

 private:
  explicit HeadsetSession(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace vps::viewer

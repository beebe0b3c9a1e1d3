// SPDX-License-Identifier: BSD-3-Clause
// A display for moving viewers: the eye points follow the tracked heads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/scene/display.h"

namespace vps::scenes {

/// Time that a program waits for the first pose of a head from the network [s]. Assumed: discovery takes less
/// than one second.
inline constexpr double kHeadWait_s = 3;

/// A display with its viewers' heads. Used by one thread.
class VPS_SCENES_API TrackedHeads {
 public:
  /// Subscribes to the topics of the viewers. Throws LoadError as HeadTopic.
  explicit TrackedHeads(Display display);
  ~TrackedHeads();
  TrackedHeads(TrackedHeads&&) noexcept;
  TrackedHeads& operator=(TrackedHeads&&) noexcept;

  /// The display with the current pose of each head: a constant pose as the file states, a recorded pose at
  /// `time_s`, or the newest pose from the network. A head keeps its last pose if the new pose is behind a
  /// screen or unknown.
  const Display& at(double time_s);
  [[nodiscard]] const Display& display() const;
  /// Waits until each head without a pose in the file has a pose from the network. Throws LoadError with the
  /// topic's name after the time limit.
  void waitForAll(double limit_s);
  /// Whether a head follows a network topic, so that the display changes over time.
  [[nodiscard]] bool isLive() const;
  /// Messages since the last call about heads that moved behind a screen or whose poses no longer arrive.
  [[nodiscard]] std::vector<std::string> takeNews();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

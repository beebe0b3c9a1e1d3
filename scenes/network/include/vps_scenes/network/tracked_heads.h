// SPDX-License-Identifier: BSD-3-Clause
// A display whose viewers move: their heads follow their streams.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/scene/display.h"

namespace vps::scenes {

/// How long a program waits for a head that only the network knows. assumed: discovery takes less than one
inline constexpr double kHeadWait_s = 3;

/// Used by one thread.
class VPS_SCENES_API TrackedHeads {
 public:
  /// Listens to the topics of its viewers. Throws LoadError as HeadTopic.
  explicit TrackedHeads(Display display);
  ~TrackedHeads();
  TrackedHeads(TrackedHeads&&) noexcept;
  TrackedHeads& operator=(TrackedHeads&&) noexcept;

  /// The display with each head where its stream has it: a constant one where the file says, a recorded one
  /// at that time, one from the network where it is now. A head that its stream has behind a screen, or that
  /// the stream does not know, stays where it was last.
  const Display& at(double time_s);
  [[nodiscard]] const Display& display() const;
  /// Returns when each head that the file does not place has come from the network. Throws LoadError, which
  /// names the topic, after that time.
  void waitForAll(double limit_s);
  /// Whether a head is where the network says, so that the display changes by itself.
  [[nodiscard]] bool isLive() const;
  /// What happened since the last call, in words, each once: a head that went behind a screen or is not heard
  /// any more.
  [[nodiscard]] std::vector<std::string> takeNews();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

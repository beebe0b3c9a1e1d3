// SPDX-License-Identifier: BSD-3-Clause
// A sound card that may go and come back.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sound/live_sound.h"

namespace vps::viewer {

/// Writes to an output for as long as it is there, and opens it again. Used by one thread.
class LastingOutput {
 public:
  /// @param open    opens the output again once it is gone, or gives null; empty: it stays silent then
  /// @param wait_s  between attempts
  /// @param tell    called when the card is gone, and when it is back, with a line that says so
  LastingOutput(std::unique_ptr<SoundOutput> output, std::function<std::unique_ptr<SoundOutput>()> open,
                double wait_s, std::function<void(const std::string&)> tell);

  /// As SoundOutput::write(); nothing while there is no card. Never throws.
  void write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L);
  /// False while the card is gone. Tries to open it again where its time has come.
  bool isOpen();

 private:
  std::unique_ptr<SoundOutput> output_;  ///< null: gone
  std::function<std::unique_ptr<SoundOutput>()> open_;
  double wait_s_, next_s_ = 0;  ///< to the next attempt; and when that is, by device::monotonicSeconds()
  std::function<void(const std::string&)> tell_;
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Has the run of a session recorded where it is computed, and brings the recording here.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "vps_scenes/export.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

struct SessionRecordingOptions {
  std::string session = "default";
  SessionNetwork network;
  std::string file;  ///< for the recording, here
  std::string name;  ///< of the file that the render node keeps; empty: that of `file`
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< may be empty; called by a thread of its own
};

/// Works on a thread of its own from the constructor on. The run that waits for its device is recorded; one
/// that has begun is only if it is recorded anyway, otherwise the next one.
class VPS_SCENES_API SessionRecording {
 public:
  explicit SessionRecording(SessionRecordingOptions options);
  /// Gives up what has not come.
  ~SessionRecording();
  SessionRecording(const SessionRecording&) = delete;
  SessionRecording& operator=(const SessionRecording&) = delete;

  /// Until the render node has answered the wish, at most so long. Returns why it has not granted it; empty:
  /// it has.
  std::string waitUntilAsked(double most_s);
  /// Once the run is over: until the file is here. Returns why it is not; empty: it is.
  std::string finish();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

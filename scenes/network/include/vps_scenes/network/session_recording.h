// SPDX-License-Identifier: BSD-3-Clause
// Requests a recording of a session's run at the render node, and fetches the file.
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
  std::string file;  ///< local file for the recording
  std::string name;  ///< name of the file at the render node; empty: the name of `file`
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< messages for the user; may be empty; called on a separate thread
};

/// Runs a separate thread from the constructor on. A run that waits for its device is recorded. If a run has
/// begun and is being recorded, that recording is fetched; otherwise the next run is recorded.
class VPS_SCENES_API SessionRecording {
 public:
  explicit SessionRecording(SessionRecordingOptions options);
  /// Cancels a recording that has not arrived.
  ~SessionRecording();
  SessionRecording(const SessionRecording&) = delete;
  SessionRecording& operator=(const SessionRecording&) = delete;

  /// Waits until the render node has answered the request, at most `most_s`. Returns the reason of a refusal;
  /// empty: granted.
  std::string waitUntilAsked(double most_s);
  /// Call finish() when the run is over; the call waits until the file has arrived. Returns the reason of a
  /// failure; empty: the file has arrived.
  std::string finish();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

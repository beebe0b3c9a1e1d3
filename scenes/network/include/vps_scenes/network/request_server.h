// SPDX-License-Identifier: BSD-3-Clause
// Answers requests to a running render node: status, take, release, re-arm, gains, another scene, a
// recording. Each request gets a reply in words.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "vps_scenes/export.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

enum class RequestRights {
  Look,  ///< status only
  All,   ///< all requests
};

struct RequestServerOptions {
  std::string session = "default";
  SessionNetwork network;
  RequestRights rights = RequestRights::All;
  /// True: each part is taken only on request. False: the procedure continues by itself.
  bool waits = false;
  std::string scenes;      ///< folder of received scenes, stored by hash; empty: they are not stored
  std::string recordings;  ///< folder of the requested recordings
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< messages for the user; may be empty
};

/// One server per process serves all its runs. Within a machine, processes of the same user connect through a
/// socket without a name in the file system, and other users are refused. Over a network, each node that may
/// write the request topic is served. A separate thread answers.
class VPS_SCENES_API RequestServer {
 public:
  /// Throws LoadError if the session already has a server, or if its name or network cannot be used.
  explicit RequestServer(const RequestServerOptions& options);
  ~RequestServer();
  RequestServer(const RequestServer&) = delete;
  RequestServer& operator=(const RequestServer&) = delete;

  /// Becomes true when the run has to end, because another run was requested or the user stops. Pass the
  /// result as AssembleOptions::stop.
  [[nodiscard]] const std::atomic<bool>* endsRun() const;
  /// The scene of the requested run; empty: no run was requested. Clears endsRun(), unless the user stops.
  std::optional<Scene> takeNext();
  /// Waits for the scene of the next run. The result is empty if the user stops the program.
  std::optional<Scene> waitForNext();
  /// The file of the next run's recording, which does not exist yet; empty: no recording was requested.
  [[nodiscard]] std::string recording() const;

  /// Waits until each node that requested a recording has its file or was silent for 5 s, or the user stops.
  void waitForFetchers() const;

  struct Work;
  /// Internal state, for renderNode().
  [[nodiscard]] Work& work() { return *work_; }

 private:
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

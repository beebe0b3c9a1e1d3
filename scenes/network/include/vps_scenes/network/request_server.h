// SPDX-License-Identifier: BSD-3-Clause
// Where a render node is asked for something while it runs: who is there, take, release, re-arm, gains,
// another scene, a recording. Each request has a reply, in words.
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
  Look,  ///< who is there
  All,
};

struct RequestServerOptions {
  std::string session = "default";
  SessionNetwork network;
  RequestRights rights = RequestRights::All;
  /// Each part is taken when somebody asks for it. Otherwise the procedure goes on by itself.
  bool waits = false;
  std::string scenes;      ///< folder of scenes that were sent, by their hash; empty: they are not kept
  std::string recordings;  ///< folder of the recordings that are asked for
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< may be empty
};

/// One for a process, over all its runs. Within a machine, processes of the same user ask through a socket
/// without a name in the file system, and others are refused; over a network, whoever may write its topic.
/// Answers from a thread of its own.
class VPS_SCENES_API RequestServer {
 public:
  /// Throws LoadError where the session has a server, or its name or network cannot be used.
  explicit RequestServer(const RequestServerOptions& options);
  ~RequestServer();
  RequestServer(const RequestServer&) = delete;
  RequestServer& operator=(const RequestServer&) = delete;

  /// The run has to end, since another is asked for or the user stops. For AssembleOptions::stop.
  [[nodiscard]] const std::atomic<bool>* endsRun() const;
  /// The scene of the run that was asked for; empty: none was. Clears endsRun(), unless the user stops.
  std::optional<Scene> takeNext();
  /// Waits for it. Empty: the user stops.
  std::optional<Scene> waitForNext();
  /// The file of the next run's recording, which does not exist yet; empty: none is asked for.
  [[nodiscard]] std::string recording() const;

  /// Until those who asked for a recording have its file, or are silent for 5 s, or the user stops.
  void waitForFetchers() const;

  struct Work;
  /// For renderNode().
  [[nodiscard]] Work& work() { return *work_; }

 private:
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The request server of a process, with its thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "requests/request_channel.h"
#include "requests/request_handler.h"
#include "vps_scenes/network/request_server.h"

namespace vps::scenes {

struct RequestServer::Work {
  explicit Work(const RequestServerOptions& given);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  void serve();
  /// Waits a few milliseconds for a request and handles it.
  void serveOne();

  RequestServerOptions options;
  RunRequests requests;
  ServedRun run;
  std::unique_ptr<ServerChannel> channel;  ///< channel and handler are used by the server's thread only
  RequestHandler handler;
  std::mutex mutex;  ///< guards the next two members
  std::optional<Scene> next;
  std::string recording;
  std::atomic<bool> ends_run{false}, is_closing{false}, is_fetched{false};
  std::thread thread;
};

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The server of requests of a process, with its thread.
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
  /// Waits for a request for some milliseconds.
  void serveOne();

  RequestServerOptions options;
  RunRequests requests;
  ServedRun run;
  std::unique_ptr<ServerChannel> channel;  ///< of the thread, as is the handler
  RequestHandler handler;
  std::mutex mutex;  ///< of the next two
  std::optional<Scene> next;
  std::string recording;
  std::atomic<bool> ends_run{false}, is_closing{false}, is_fetched{false};
  std::thread thread;
};

}  // namespace vps::scenes

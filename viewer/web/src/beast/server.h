// SPDX-License-Identifier: BSD-3-Clause
// The web server: HTTP for the page and the parts, and a WebSocket for each browser.
#pragma once

#include <cstdint>
#include <memory>

#include "vps_viewer/web/web.h"
#include "web/watched_run.h"

namespace vps::viewer {

/// Used by one thread.
class VPS_VIEWER_API WebServer {
 public:
  /// Begins to listen. Throws LoadError as serveSession() does.
  WebServer(WatchedRun& run, const WebOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// The address that a user opens.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] std::uint16_t port() const;
  /// Serves until options.stop is set.
  void serve();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// One browser's connections: requests for files, and the WebSocket that one of them becomes.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstddef>

#include "web/access.h"
#include "web/hub.h"
#include "web/web_files.h"

namespace vps::viewer {

/// What all connections share; it outlives them.
struct WebShared {
  WebHub& hub;
  const WebPage& page;
  const WebAccess& access;
  std::size_t most_browsers;
  boost::asio::ssl::context* tls = nullptr;  ///< null: without encryption
  std::size_t connections = 0;
  bool is_over = false;  ///< the server is being destroyed, and nobody is told anything any more
};

/// Serves until the browser leaves, is silent for too long, or sends too much.
void serveConnection(boost::asio::ip::tcp::socket socket, WebShared& shared);

/// The monotonic clock, for rates.
double webClock_s();

}  // namespace vps::viewer

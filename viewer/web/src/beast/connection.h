// SPDX-License-Identifier: BSD-3-Clause
// Connections of browsers: requests for files, one of which becomes a WebSocket.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstddef>

#include "web/access.h"
#include "web/hub.h"
#include "web/web_files.h"

namespace vps::viewer {

/// Data that all connections share. The data outlive the connections.
struct WebShared {
  WebHub& hub;
  const WebPage& page;
  const WebAccess& access;
  std::size_t most_browsers;
  boost::asio::ssl::context* tls = nullptr;  ///< null: without encryption
  std::size_t connections = 0;
  bool is_over = false;  ///< the server is being destroyed, so nothing is sent any more
};

/// Serves a connection until the browser closes it, is silent for too long, or sends too much.
void serveConnection(boost::asio::ip::tcp::socket socket, WebShared& shared);

/// Time of the monotonic clock, for rate limits.
double webClock_s();

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The way of requests and their answers, as the two ends see it.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// Longest request or answer.
inline constexpr std::size_t kLongestAsk = 40 * 1024;

struct IncomingRequest {
  std::uint64_t from = 0;  ///< whom the answer goes to
  std::string bytes;
  bool is_stranger = false;  ///< of another user of this machine, who may be told only that
};

/// Of the render node. Used by one thread.
class ServerChannel {
 public:
  virtual ~ServerChannel() = default;
  ServerChannel(const ServerChannel&) = delete;
  ServerChannel& operator=(const ServerChannel&) = delete;
  /// The next request, for which it waits so long.
  virtual std::optional<IncomingRequest> receive(std::chrono::milliseconds limit) = 0;
  virtual void answer(std::uint64_t to, std::string_view bytes) = 0;

 protected:
  ServerChannel() = default;
};

/// Of who asks. Used by one thread.
class ClientChannel {
 public:
  virtual ~ClientChannel() = default;
  ClientChannel(const ClientChannel&) = delete;
  ClientChannel& operator=(const ClientChannel&) = delete;
  virtual void send(std::string_view bytes) = 0;
  /// The next answer to anybody; empty: none within that time.
  virtual std::string receive(std::chrono::milliseconds limit) = 0;
  /// The render node is gone.
  [[nodiscard]] virtual bool isOver() const { return false; }

 protected:
  ClientChannel() = default;
};

/// Within a machine. Throws LoadError where the session has a server.
std::unique_ptr<ServerChannel> makeLocalServer(const std::string& session);
/// Null: there is none.
/// @param user  whose session it is
std::unique_ptr<ClientChannel> findLocalServer(const std::string& session, uid_t user = getuid());

/// Over UDP; in dds/. Throw LoadError as joinSession() over a network.
std::unique_ptr<ServerChannel> makeNetworkServer(const std::string& session, const SessionNetwork& network);
std::unique_ptr<ClientChannel> findNetworkServer(const std::string& session, const SessionNetwork& network);

}  // namespace vps::scenes

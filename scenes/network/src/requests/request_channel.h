// SPDX-License-Identifier: BSD-3-Clause
// Transport of requests and answers, for both ends.
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

/// Length limit of a request or an answer [bytes].
inline constexpr std::size_t kLongestAsk = 40 * 1024;

struct IncomingRequest {
  std::uint64_t from = 0;  ///< identifies the requester for the answer
  std::string bytes;
  bool is_stranger = false;  ///< from another user of this machine, who only gets a refusal
};

/// The render node's end. Used by one thread.
class ServerChannel {
 public:
  virtual ~ServerChannel() = default;
  ServerChannel(const ServerChannel&) = delete;
  ServerChannel& operator=(const ServerChannel&) = delete;
  /// The next request; waits at most `limit`.
  virtual std::optional<IncomingRequest> receive(std::chrono::milliseconds limit) = 0;
  virtual void answer(std::uint64_t to, std::string_view bytes) = 0;

 protected:
  ServerChannel() = default;
};

/// The requester's end. Used by one thread.
class ClientChannel {
 public:
  virtual ~ClientChannel() = default;
  ClientChannel(const ClientChannel&) = delete;
  ClientChannel& operator=(const ClientChannel&) = delete;
  virtual void send(std::string_view bytes) = 0;
  /// The next answer to any requester; empty: no answer came within `limit`.
  virtual std::string receive(std::chrono::milliseconds limit) = 0;
  /// Whether the render node has ended.
  [[nodiscard]] virtual bool isOver() const { return false; }

 protected:
  ClientChannel() = default;
};

/// Creates the server of a session within a machine. Throws LoadError if the session already has a server.
std::unique_ptr<ServerChannel> makeLocalServer(const std::string& session);
/// Connects to the server of a session within a machine. Returns null if there is no server.
/// @param user  owner of the session
std::unique_ptr<ClientChannel> findLocalServer(const std::string& session, uid_t user = getuid());

/// Server and client over UDP; implemented in dds/. Both functions throw LoadError as joinSession() over a
/// network.
std::unique_ptr<ServerChannel> makeNetworkServer(const std::string& session, const SessionNetwork& network);
std::unique_ptr<ClientChannel> findNetworkServer(const std::string& session, const SessionNetwork& network);

/// Whether a name is allowed for a recording: a file name without a folder (the requester must not choose the
/// location on this machine) with letters, digits, -, _ and dots, and the extension .mcap.
bool isRecordingName(const std::string& name);
/// Name under which the render node stores a recording for a file elsewhere: the same name if it is allowed.
std::string recordingName(const std::string& file);

}  // namespace vps::scenes

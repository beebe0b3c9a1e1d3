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

namespace vps::scenes::inline v0 {

/// Longest request or answer.
inline constexpr std::size_t kLongestAsk = 40 * 1024;

struct IncomingAsk {
  std::uint64_t from = 0;  ///< whom the answer goes to
  std::string bytes;
  bool is_stranger = false;  ///< of another user of this machine, who may be told only that
};

/// Of the render node. Used by one thread.
class DeskChannel {
 public:
  virtual ~DeskChannel() = default;
  DeskChannel(const DeskChannel&) = delete;
  DeskChannel& operator=(const DeskChannel&) = delete;
  /// The next request, for which it waits so long.
  virtual std::optional<IncomingAsk> receive(std::chrono::milliseconds limit) = 0;
  virtual void answer(std::uint64_t to, std::string_view bytes) = 0;

 protected:
  DeskChannel() = default;
};

/// Of who asks. Used by one thread.
class AskChannel {
 public:
  virtual ~AskChannel() = default;
  AskChannel(const AskChannel&) = delete;
  AskChannel& operator=(const AskChannel&) = delete;
  virtual void send(std::string_view bytes) = 0;
  /// The next answer to anybody; empty: none within that time.
  virtual std::string receive(std::chrono::milliseconds limit) = 0;
  /// The render node is gone.
  [[nodiscard]] virtual bool isOver() const { return false; }

 protected:
  AskChannel() = default;
};

/// Within a machine. Throws LoadError where the session has a desk.
std::unique_ptr<DeskChannel> makeLocalDesk(const std::string& session);
/// Null: there is none.
/// @param user  whose session it is
std::unique_ptr<AskChannel> findLocalDesk(const std::string& session, uid_t user = getuid());

/// Over UDP; in dds/. Throw LoadError as joinSession() over a network.
std::unique_ptr<DeskChannel> makeNetworkDesk(const std::string& session, const SessionNetwork& network);
std::unique_ptr<AskChannel> findNetworkDesk(const std::string& session, const SessionNetwork& network);

}  // namespace vps::scenes::inline v0

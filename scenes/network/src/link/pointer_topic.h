// SPDX-License-Identifier: BSD-3-Clause
// Transport of pointers between nodes over UDP.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// Sends the pointers of one watcher to all watchers of a session; best effort. Used by one thread.
class PointerTopic {
 public:
  virtual ~PointerTopic() = default;
  PointerTopic(const PointerTopic&) = delete;
  PointerTopic& operator=(const PointerTopic&) = delete;

  virtual void send(std::string_view message) = 0;
  /// Messages received since the last call, including the own ones; in a flood, the newest.
  virtual std::vector<std::string> take() = 0;

 protected:
  PointerTopic() = default;
};

/// Implemented in dds/. Throws LoadError as joinSession() over a network.
std::unique_ptr<PointerTopic> makePointerTopic(const std::string& session, const SessionNetwork& network);

}  // namespace vps::scenes

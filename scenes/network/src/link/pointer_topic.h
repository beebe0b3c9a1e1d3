// SPDX-License-Identifier: BSD-3-Clause
// The way of pointers between nodes over UDP.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// What each who watches a session sends to all who do; best effort. Used by one thread.
class PointerTopic {
 public:
  virtual ~PointerTopic() = default;
  PointerTopic(const PointerTopic&) = delete;
  PointerTopic& operator=(const PointerTopic&) = delete;

  virtual void send(std::string_view message) = 0;
  /// Those that came since the last call, one's own too; of a flood the newest.
  virtual std::vector<std::string> take() = 0;

 protected:
  PointerTopic() = default;
};

/// In dds/. Throws LoadError as joinSession() over a network.
std::unique_ptr<PointerTopic> makePointerTopic(const std::string& session, const SessionNetwork& network);

}  // namespace vps::scenes

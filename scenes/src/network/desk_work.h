// SPDX-License-Identifier: BSD-3-Clause
// The desk of a process, with its thread.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "network/desk.h"
#include "network/desk_channel.h"
#include "vps_scenes/network/session_desk.h"

namespace vps::scenes::inline v0 {

struct SessionDesk::Work {
  explicit Work(const DeskOptions& given);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  void serve();

  DeskOptions options;
  RunRequests requests;
  DeskRun run;
  std::unique_ptr<DeskChannel> channel;  ///< of the thread, as is the clerk
  DeskClerk clerk;
  std::mutex mutex;  ///< of the next two
  std::optional<Scene> next;
  std::string recording;
  std::atomic<bool> ends_run{false}, is_closing{false};
  std::thread thread;
};

}  // namespace vps::scenes::inline v0

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/session_desk.h"

#include <chrono>
#include <exception>
#include <utility>

#include "network/desk_work.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr std::chrono::milliseconds kPoll{20};  // until a stop by the user is passed on

}  // namespace

SessionDesk::Work::Work(const DeskOptions& given)
    : options(given),
      channel(given.network.empty() ? makeLocalDesk(given.session)
                                    : makeNetworkDesk(given.session, given.network)),
      clerk(options, requests, run) {
  requests.setWaiting(given.waits);
  thread = std::thread([this] { serve(); });
}

SessionDesk::Work::~Work() {
  is_closing = true;
  thread.join();
}

void SessionDesk::Work::serve() {
  while (!is_closing) {
    if (options.stop != nullptr && options.stop->load()) ends_run = true;
    const std::optional<IncomingAsk> ask = channel->receive(kPoll);
    if (!ask) continue;
    const std::string_view answer = clerk.answer(*ask);
    if (!answer.empty()) channel->answer(ask->from, answer);
    const std::lock_guard lock(mutex);
    recording = clerk.recording();
    if (std::optional<Scene> scene = clerk.takeNext()) {
      next = std::move(scene);
      ends_run = true;
    }
  }
}

SessionDesk::SessionDesk(const DeskOptions& options) : work_(std::make_unique<Work>(options)) {}
SessionDesk::~SessionDesk() = default;

const std::atomic<bool>* SessionDesk::endsRun() const {
  return &work_->ends_run;
}

std::optional<Scene> SessionDesk::takeNext() {
  const std::lock_guard lock(work_->mutex);
  const bool is_stopped = work_->options.stop != nullptr && work_->options.stop->load();
  std::optional<Scene> next = std::exchange(work_->next, std::nullopt);
  if (!is_stopped) work_->ends_run = false;
  return is_stopped ? std::nullopt : std::move(next);
}

std::optional<Scene> SessionDesk::waitForNext() {
  for (;;) {
    if (std::optional<Scene> next = takeNext()) return next;
    if (work_->options.stop != nullptr && work_->options.stop->load()) return {};
    std::this_thread::sleep_for(kPoll);
  }
}

std::string SessionDesk::recording() const {
  const std::lock_guard lock(work_->mutex);
  return work_->recording;
}

}  // namespace vps::scenes::inline v0

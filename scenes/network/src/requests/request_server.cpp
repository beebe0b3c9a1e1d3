// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/request_server.h"

#include <chrono>
#include <exception>
#include <utility>

#include "requests/request_server_work.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kPoll{20};  // interval of checks for a stop by the user

}  // namespace

RequestServer::Work::Work(const RequestServerOptions& given)
    : options(given),
      channel(given.network.empty() ? makeLocalServer(given.session)
                                    : makeNetworkServer(given.session, given.network)),
      handler(options, requests, run) {
  requests.setWaiting(given.waits);
  thread = std::thread([this] { serve(); });
}

RequestServer::Work::~Work() {
  is_closing = true;
  thread.join();
}

void RequestServer::Work::serve() {
  while (!is_closing) {
    if (options.stop != nullptr && options.stop->load()) ends_run = true;
    try {
      serveOne();
    } catch (const std::exception& failed) {  // a failure such as a lack of memory; the run continues
      if (options.say) options.say(std::string("a request was not carried out: ") + failed.what());
    }
  }
}

void RequestServer::Work::serveOne() {
  const std::optional<IncomingRequest> ask = channel->receive(kPoll);
  const double now_s = device::monotonicSeconds();
  handler.dropLostTransfer(now_s);
  is_fetched = handler.isFetched(now_s);
  if (!ask) return;
  const std::string_view answer = handler.answer(*ask);
  {
    const std::lock_guard lock(mutex);
    recording = handler.recording();
    is_fetched = handler.isFetched(now_s);
    if (std::optional<Scene> scene = handler.takeNext()) {
      next = std::move(scene);
      ends_run = true;
    }
  }
  if (!answer.empty()) channel->answer(ask->from, answer);
}

RequestServer::RequestServer(const RequestServerOptions& options) : work_(std::make_unique<Work>(options)) {}
RequestServer::~RequestServer() = default;

const std::atomic<bool>* RequestServer::endsRun() const {
  return &work_->ends_run;
}

std::optional<Scene> RequestServer::takeNext() {
  const std::lock_guard lock(work_->mutex);
  const bool is_stopped = work_->options.stop != nullptr && work_->options.stop->load();
  std::optional<Scene> next = std::exchange(work_->next, std::nullopt);
  if (!is_stopped) work_->ends_run = false;
  return is_stopped ? std::nullopt : std::move(next);
}

std::optional<Scene> RequestServer::waitForNext() {
  for (;;) {
    if (std::optional<Scene> next = takeNext()) return next;
    if (work_->options.stop != nullptr && work_->options.stop->load()) return {};
    std::this_thread::sleep_for(kPoll);
  }
}

void RequestServer::waitForFetchers() const {
  const auto is_stopped = [this] { return work_->options.stop != nullptr && work_->options.stop->load(); };
  do std::this_thread::sleep_for(2 * kPoll);  // a request that arrives during this pause is waited for, too
  while (work_->is_fetched && !is_stopped());
}

std::string RequestServer::recording() const {
  const std::lock_guard lock(work_->mutex);
  return work_->recording.empty() ? "" : unusedFile(work_->recording);
}

}  // namespace vps::scenes

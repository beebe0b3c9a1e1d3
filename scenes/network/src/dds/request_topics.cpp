// SPDX-License-Identifier: BSD-3-Clause
// Requests over UDP: one topic for requests, and one for answers, which contain the asker's identity.
#include <condition_variable>
#include <deque>
#include <mutex>

#include "dds/topics.h"
#include "requests/request_channel.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostWaiting = 64;  // in a flood, the newest messages are kept

/// Messages received by a thread of DDS.
class Inbox {
 public:
  void put(std::string_view bytes) {
    if (bytes.size() > kLongestAsk) return;
    {
      const std::lock_guard lock(mutex_);
      if (waiting_.size() >= kMostWaiting) waiting_.pop_front();
      waiting_.emplace_back(bytes);
    }
    changed_.notify_one();
  }
  std::string take(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, limit, [this] { return !waiting_.empty(); });
    if (waiting_.empty()) return {};
    std::string bytes = std::move(waiting_.front());
    waiting_.pop_front();
    return bytes;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> waiting_;
};

/// A topic to write and a topic to read.
class Exchange {
 public:
  Exchange(const std::string& session, const SessionNetwork& network, const char* out, const char* in)
      : participant_(network),
        out_(participant_, topicName(session, out), Delivery::Reliable, nullptr),
        in_(participant_, topicName(session, in), Delivery::Reliable,
            [this](std::string_view bytes) { inbox_.put(bytes); }) {}

  void send(std::string_view bytes) { out_.write(bytes); }
  std::string receive(std::chrono::milliseconds limit) { return inbox_.take(limit); }

 private:
  Inbox inbox_;
  DdsParticipant participant_;
  DdsTopic out_, in_;  // declared after all members that threads of DDS use
};

class NetworkServer final : public ServerChannel {
 public:
  NetworkServer(const std::string& session, const SessionNetwork& network)
      : topics_(session, network, "answer", "ask") {}

  std::optional<IncomingRequest> receive(std::chrono::milliseconds limit) override {
    std::string bytes = topics_.receive(limit);
    if (bytes.empty()) return {};
    return IncomingRequest{0, std::move(bytes), false};
  }
  void answer(std::uint64_t, std::string_view bytes) override { topics_.send(bytes); }

 private:
  Exchange topics_;
};

class NetworkClient final : public ClientChannel {
 public:
  NetworkClient(const std::string& session, const SessionNetwork& network)
      : topics_(session, network, "ask", "answer") {}

  void send(std::string_view bytes) override { topics_.send(bytes); }
  std::string receive(std::chrono::milliseconds limit) override { return topics_.receive(limit); }

 private:
  Exchange topics_;
};

}  // namespace

std::unique_ptr<ServerChannel> makeNetworkServer(const std::string& session, const SessionNetwork& network) {
  return std::make_unique<NetworkServer>(session, network);
}

std::unique_ptr<ClientChannel> findNetworkServer(const std::string& session, const SessionNetwork& network) {
  return std::make_unique<NetworkClient>(session, network);
}

}  // namespace vps::scenes

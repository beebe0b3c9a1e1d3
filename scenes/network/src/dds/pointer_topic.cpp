// SPDX-License-Identifier: BSD-3-Clause
#include "link/link.h"

#include <deque>
#include <iterator>
#include <mutex>

#include "dds/topics.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostPointers =
    256;  // 8 processes that point 30 times a second send as many in a second

class DdsPointerTopic final : public PointerTopic {
 public:
  DdsPointerTopic(const std::string& session, const SessionNetwork& network)
      : participant_(network),
        out_(participant_, topicName(session, "pointer"), Delivery::Newest, nullptr),
        in_(participant_, topicName(session, "pointer"), Delivery::Newest,
            [this](std::string_view bytes) { hear(bytes); }) {}

  void send(std::string_view message) override { out_.write(message); }
  std::vector<std::string> take() override {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> all(std::make_move_iterator(waiting_.begin()),
                                 std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    return all;
  }

 private:
  void hear(std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostPointers) waiting_.pop_front();
    waiting_.emplace_back(bytes);
  }

  std::mutex mutex_;
  std::deque<std::string> waiting_;
  DdsParticipant participant_;
  DdsTopic out_, in_;  // declared after all members that threads of DDS use
};

}  // namespace

std::unique_ptr<PointerTopic> makePointerTopic(const std::string& session, const SessionNetwork& network) {
  return std::make_unique<DdsPointerTopic>(session, network);
}

}  // namespace vps::scenes

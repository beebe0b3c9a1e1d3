// SPDX-License-Identifier: BSD-3-Clause
// A client that sends requests to the render node of a session, and waits for each answer.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "messages/messages.h"
#include "requests/request_channel.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"

namespace vps::scenes {

/// Sends requests and waits for answers. Used by one thread. All requests of an object have the same sender.
class Asking {
 public:
  static constexpr double kLimit_s = 5;

  /// Throws LoadError if no render node of the session accepts requests.
  Asking(const std::string& session, const SessionNetwork& network)
      : session_(session),
        channel_(network.empty() ? findLocalServer(session) : findNetworkServer(session, network)),
        writer_(newSender()),
        remedy_(network.empty() ? "the session's vps render is stopped or too busy"
                                : "check that the session's vps render uses this --network, and that the "
                                  "certificates are of the same authority and allow requests") {
    if (channel_ == nullptr)
      throw LoadError("", "",
                      sessionWords(session) + ": no vps render that accepts requests runs this session");
  }

  /// Sends a message and returns the answer. Throws LoadError if no answer comes in time, if the session has
  /// ended, or if it has another version.
  template <typename Message>
  AnswerMessage ask(const Message& message, double limit_s = kLimit_s) {
    AnswerMessage read;
    MessageReader().read(askFor(message, limit_s), read);
    return read;
  }
  /// Sends a message and returns the bytes of an AnswerMessage or a FetchedMessage.
  template <typename Message>
  std::string askFor(const Message& message, double limit_s = kLimit_s) {
    const std::string bytes(writer_.write(message));
    const std::uint64_t number = writer_.number(kindOf(bytes));
    const double until_s = device::monotonicSeconds() + limit_s;
    channel_->send(bytes);
    double again_s = device::monotonicSeconds() + kAgain_s;
    while (device::monotonicSeconds() < until_s) {
      std::string answer = channel_->receive(kAgain);
      if (channel_->isOver()) throw LoadError("", "", sessionWords(session_) + " has ended");
      if (!answer.empty() && isAnswerTo(answer, number)) return answer;
      if (device::monotonicSeconds() < again_s) continue;
      again_s = device::monotonicSeconds() + kAgain_s;
      channel_->send(bytes);
    }
    throw LoadError("", "", sessionWords(session_) + ": no answer; " + remedy_);
  }

 private:
  static constexpr std::chrono::milliseconds kAgain{
      300};  // interval of repetitions, needed over a network until the other end is discovered
  static constexpr double kAgain_s = 0.3;

  template <typename Message>
  bool isAnswerTo(const std::string& bytes, std::uint64_t number, Message&& message) const {
    const Reading reading = MessageReader().read(bytes, message);
    if (reading == Reading::BadVersion)
      throw LoadError("", "",
                      sessionWords(session_) +
                          " is run by another version of vps render; use the same version for both programs");
    return reading == Reading::Good && message.asker == writer_.sender() && message.number == number;
  }
  [[nodiscard]] bool isAnswerTo(const std::string& bytes, std::uint64_t number) const {
    if (kindOf(bytes) != MessageKind::Fetched) return isAnswerTo(bytes, number, AnswerMessage());
    const auto fetched = std::make_unique<FetchedMessage>();  // too large for the stack
    return isAnswerTo(bytes, number, *fetched);
  }

  std::string session_;
  std::unique_ptr<ClientChannel> channel_;
  MessageWriter writer_;
  const char* remedy_;  ///< remedy in the message if no answer comes
};

}  // namespace vps::scenes

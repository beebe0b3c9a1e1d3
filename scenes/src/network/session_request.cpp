// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/session_request.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <utility>

#include "network/messages.h"
#include "network/request_channel.h"
#include "record/scene_archive.h"
#include "vps/load_error.h"
#include "vps_device/metronome.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr std::chrono::milliseconds kAgain{300};  // over a network: until the other end is found
constexpr double kLimit_s = 5;
constexpr double kLoadLimit_s = 120;  // assumed: a scene of 1 GB is read and checked within that

/// One program that asks.
class Asking {
 public:
  Asking(const std::string& session, const SessionNetwork& network)
      : session_(session),
        channel_(network.empty() ? findLocalServer(session) : findNetworkServer(session, network)),
        writer_(newSender()),
        remedy_(network.empty() ? "its vps render is stopped, or too busy"
                                : "check that vps render runs it at this --network, and that the "
                                  "certificates are of its authority and allow requests") {
    if (channel_ == nullptr)
      throw LoadError("", "", sessionWords(session) + ": no vps render runs it that takes requests");
  }

  template <typename Message>
  AnswerMessage ask(const Message& message, double limit_s = kLimit_s) {
    const std::string bytes(writer_.write(message));
    const std::uint64_t number = writer_.number(kindOf(bytes));
    const double until_s = device::monotonicSeconds() + limit_s;
    channel_->send(bytes);
    double again_s = device::monotonicSeconds() + seconds(kAgain);
    while (device::monotonicSeconds() < until_s) {
      const std::string answer = channel_->receive(kAgain);
      if (channel_->isOver()) throw LoadError("", "", sessionWords(session_) + " has ended");
      AnswerMessage read;
      MessageReader reader;
      const Reading reading = answer.empty() ? Reading::BadSize : reader.read(answer, read);
      if (reading == Reading::BadVersion)
        throw LoadError("", "",
                        sessionWords(session_) +
                            " is run by another version of vps render; use the same version for both");
      if (reading == Reading::Good && read.asker == writer_.sender() && read.number == number) return read;
      if (device::monotonicSeconds() < again_s) continue;
      again_s = device::monotonicSeconds() + seconds(kAgain);
      channel_->send(bytes);
    }
    throw LoadError("", "", sessionWords(session_) + ": nothing answers; " + remedy_);
  }

 private:
  static double seconds(std::chrono::milliseconds duration) {
    return 1e-3 * static_cast<double>(duration.count());
  }

  std::string session_;
  std::unique_ptr<ClientChannel> channel_;
  MessageWriter writer_;
  const char* remedy_;  ///< where nothing answers
};

AskMessage messageOf(AskKind kind, const std::string& text = "") {
  AskMessage message;
  message.kind = kind;
  if (text.size() >= message.text.size())
    throw LoadError("", "", "'" + text + "' is too long a name for a request");
  std::memcpy(message.text.data(), text.data(), text.size());
  return message;
}

SessionAnswer answerOf(const AnswerMessage& message) {
  return {message.is_done, message.text.data()};
}

}  // namespace

bool isSceneHash(const std::string& text) {
  constexpr std::size_t kDigits = 32;  // of contentHash()
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

SessionRequest::SessionRequest(std::string session, SessionNetwork network)
    : session_(std::move(session)), network_(std::move(network)) {
  requireSessionName(session_);
}

SessionAnswer SessionRequest::who() const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Who)));
}
SessionAnswer SessionRequest::take(const std::string& part) const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Take, part)));
}
SessionAnswer SessionRequest::release() const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Release)));
}
SessionAnswer SessionRequest::rearm() const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Rearm)));
}
SessionAnswer SessionRequest::setGains(double k_N_per_m, double k_Nm_per_rad) const {
  AskMessage message = messageOf(AskKind::Gains);
  message.k_N_per_m = k_N_per_m;
  message.k_Nm_per_rad = k_Nm_per_rad;
  return answerOf(Asking(session_, network_).ask(message));
}
SessionAnswer SessionRequest::load(const std::string& hash) const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Load, hash), kLoadLimit_s));
}
SessionAnswer SessionRequest::again() const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Again), kLoadLimit_s));
}
SessionAnswer SessionRequest::record(const std::string& name) const {
  return answerOf(Asking(session_, network_).ask(messageOf(AskKind::Record, name)));
}

SessionAnswer SessionRequest::load(const Scene& scene, const std::function<void(double)>& progress) const {
  const std::string bytes = sceneToBytes(scene), hash = contentHash(bytes);
  Asking asking(session_, network_);
  AnswerMessage answer = asking.ask(messageOf(AskKind::Load, hash), kLoadLimit_s);
  PieceMessage piece;
  std::memcpy(piece.hash.data(), hash.data(), hash.size());
  piece.total = bytes.size();
  while (answer.wants_scene && piece.offset < piece.total) {
    piece.size =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(PieceMessage::kMost, piece.total - piece.offset));
    std::memcpy(piece.bytes.data(), bytes.data() + piece.offset, piece.size);
    const bool is_last = piece.offset + piece.size == piece.total;
    answer = asking.ask(piece, is_last ? kLoadLimit_s : kLimit_s);
    piece.offset += piece.size;
    if (progress) progress(static_cast<double>(piece.offset) / static_cast<double>(piece.total));
  }
  return answerOf(answer);
}

}  // namespace vps::scenes::inline v0

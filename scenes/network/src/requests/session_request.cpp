// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/session_request.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "messages/messages.h"
#include "record/scene_archive.h"
#include "requests/asking.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

constexpr double kLoadLimit_s = 120;  // assumed: a scene of 1 GB is read and checked within this time

AskMessage messageOf(AskKind kind, const std::string& text = "") {
  AskMessage message;
  message.kind = kind;
  if (text.size() >= message.text.size()) throw LoadError("", "", "'" + text + "' is too long for a request");
  std::memcpy(message.text.data(), text.data(), text.size());
  return message;
}

SessionAnswer answerOf(const AnswerMessage& message) {
  return {message.is_done, message.text.data()};
}

}  // namespace

bool isSceneHash(const std::string& text) {
  constexpr std::size_t kDigits = 32;  // length of contentHash()
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
    answer = asking.ask(piece, is_last ? kLoadLimit_s : Asking::kLimit_s);
    piece.offset += piece.size;
    if (progress) progress(static_cast<double>(piece.offset) / static_cast<double>(piece.total));
  }
  return answerOf(answer);
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Decides which messages of one sender and kind are new, by their numbers and sending times.
//
// A number that is higher than the sender can have reached since the last message is refused, so that one
// damaged number does not make all later messages look old. A damaged number that was accepted nevertheless,
// such as the first one received, is corrected as soon as kRunUntilTrusted messages in a row continue each
// other and were sent later than the accepted one. A replayed message has an earlier sending time. Source of
// the idea: RFC 3550, appendix A.1 (sequence numbers of RTP).
#pragma once

#include <cstdint>

namespace vps::scenes {

class MessageOrder {
 public:
  enum class Place : std::uint8_t { Next, Old, TooFarAhead };

  /// Assumed: a loop of 4 kHz sends three log entries per tick.
  static constexpr double kMostPerSecond = 20'000;
  /// Assumed number of messages that may arrive at once after a network delay.
  static constexpr std::uint64_t kMostAtOnce = 1024;
  static constexpr int kRunUntilTrusted = 3;

  /// @param number   number of the message, starting at 1
  /// @param sent_ns  sending time by the sender's clock
  /// @param now_ns   current time by our clock
  Place place(std::uint64_t number, std::int64_t sent_ns, std::int64_t now_ns) noexcept;

 private:
  struct Heard {
    std::uint64_t number = 0;
    std::int64_t sent_ns = 0, at_ns = 0;
  };
  /// Counts messages that look old but continue each other. Returns true once these messages are to be
  /// trusted.
  bool continuesRun(const Heard& message) noexcept;

  Heard last_;  ///< last accepted message; number 0: none yet
  Heard run_;   ///< last message of the current run
  int run_length_ = 0;
};

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Which messages of one sender and kind are new, by their numbers and times of sending.
//
// A number that jumps farther than the sender can have counted since the last message is refused, so that one
// damaged number does not make all later messages old. A damaged number that was accepted all the same, such
// as the first one heard, is corrected as soon as kRunUntilTrusted messages in a row continue each other and
// were sent later than the accepted one. Messages that somebody kept and sends again were sent earlier.
// Source of the idea: RFC 3550, appendix A.1 (sequence numbers of RTP).
#pragma once

#include <cstdint>

namespace vps::scenes {

class MessageOrder {
 public:
  enum class Place : std::uint8_t { Next, Old, TooFarAhead };

  /// assumed: a loop of 4 kHz sends three entries of a log in each tick
  static constexpr double kMostPerSecond = 20'000;
  /// assumed: as many messages as may come at once after a delay of the network
  static constexpr std::uint64_t kMostAtOnce = 1024;
  static constexpr int kRunUntilTrusted = 3;

  /// @param number   of the message, from 1
  /// @param sent_ns  by the sender's clock
  /// @param now_ns   by the clock here
  Place place(std::uint64_t number, std::int64_t sent_ns, std::int64_t now_ns) noexcept;

 private:
  struct Heard {
    std::uint64_t number = 0;
    std::int64_t sent_ns = 0, at_ns = 0;
  };
  /// Counts messages that look old but continue each other. True: they are the ones to trust.
  bool continuesRun(const Heard& message) noexcept;

  Heard last_;  ///< accepted; number 0: none yet
  Heard run_;   ///< the last one of the run
  int run_length_ = 0;
};

}  // namespace vps::scenes

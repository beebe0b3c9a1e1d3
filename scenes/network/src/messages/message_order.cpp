// SPDX-License-Identifier: BSD-3-Clause
#include "messages/message_order.h"

namespace vps::scenes {

namespace {

constexpr double kClocksDiffer_s =
    1;  // assumed: far above the drift of two clocks during a pause of the link

// Computed with doubles, since a peer may send arbitrary times.
double elapsed_s(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * (static_cast<double>(to_ns) - static_cast<double>(from_ns));
}

}  // namespace

MessageOrder::Place MessageOrder::place(std::uint64_t number, std::int64_t sent_ns,
                                        std::int64_t now_ns) noexcept {
  const Heard message{number, sent_ns, now_ns};
  const auto accept = [&] {
    last_ = message;
    run_length_ = 0;
    return Place::Next;
  };
  if (last_.number == 0) return number == 0 ? Place::Old : accept();
  if (number <= last_.number) return continuesRun(message) ? accept() : Place::Old;
  const double most =
      static_cast<double>(kMostAtOnce) + kMostPerSecond * elapsed_s(last_.at_ns, message.at_ns);
  return static_cast<double>(number - last_.number) <= most ? accept() : Place::TooFarAhead;
}

bool MessageOrder::continuesRun(const Heard& message) noexcept {
  const double later_s = elapsed_s(last_.sent_ns, message.sent_ns);
  const bool is_later = later_s > 0 && later_s < elapsed_s(last_.at_ns, message.at_ns) + kClocksDiffer_s;
  if (!is_later || message.number == 0) return false;
  if (run_length_ > 0 && message.number == run_.number) return false;  // a repeated message
  const bool continues = run_length_ > 0 && message.number > run_.number &&
                         message.number - run_.number <= kMostAtOnce && message.sent_ns >= run_.sent_ns;
  run_length_ = continues ? run_length_ + 1 : 1;
  run_ = message;
  return run_length_ >= kRunUntilTrusted;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Offset and drift of another machine's clock, from messages that are sent there and back.
//
//   here   t0 ----------------------- t3      offset = ((t1 - t0) + (t2 - t3)) / 2
//               \                   /         error  <= half of the round trip (t3 - t0) - (t2 - t1)
//   there        t1 ----------- t2
//
// The error is greatest if one direction took the whole round trip, so exchanges with a short round trip are
// the most accurate. Of each quarter of a second only the exchange with the shortest round trip is kept
// (source: [Mills 1991], clock filter), and a line is fitted to the kept exchanges of the last 16 s. An
// exchange has less weight the more its round trip exceeds the shortest one. The estimate therefore survives
// a machine that is busy for seconds and has no short round trip in this time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vps::scenes {

/// The four times of an exchange [ns]: t0 and t3 by our clock, t1 and t2 by the other clock.
struct ClockExchange {
  std::int64_t t0_ns = 0, t1_ns = 0, t2_ns = 0, t3_ns = 0;

  [[nodiscard]] double roundTrip_s() const noexcept {
    return 1e-9 * static_cast<double>((t3_ns - t0_ns) - (t2_ns - t1_ns));
  }
  [[nodiscard]] double offset_s() const noexcept {
    return 0.5e-9 * static_cast<double>((t1_ns - t0_ns) + (t2_ns - t3_ns));
  }
};

/// Estimates another clock's offset. Used by one thread. Never allocates.
class ClockEstimate {
 public:
  /// Adds an exchange; exchanges come in order of t3. An exchange with a negative round trip, or an offset
  /// that no drift explains, is only counted as a contradiction.
  void add(const ClockExchange& exchange) noexcept;

  [[nodiscard]] bool isKnown() const noexcept { return kept_ > 0; }
  /// Offset of the other clock relative to ours at a time of our clock; positive: the other clock is ahead.
  [[nodiscard]] double offset_s(std::int64_t here_ns) const noexcept;
  /// Error bound of offset_s() at the last exchange, provided that the other clock is honest and keeps its
  /// rate.
  [[nodiscard]] double error_s() const noexcept;
  /// Rate of the other clock relative to ours, minus 1.
  [[nodiscard]] double drift() const noexcept;
  /// Number of exchanges that contradict earlier ones.
  [[nodiscard]] std::uint64_t contradictions() const noexcept { return contradictions_; }

 private:
  struct Point {
    std::int64_t here_ns = 0;
    double offset_s = 0, round_trip_s = 0;
  };
  static constexpr std::size_t kPoints = 64;  ///< covers 16 s

  /// The fitted line, stored as the weights of the kept points.
  struct Line {
    double weights = 0, t_mean_s = 0, square = 0;
    std::array<double, kPoints> weight{};
    /// Share of a point's offset in the line's value at time t_s, measured from the newest point.
    [[nodiscard]] double share(std::size_t i, double point_s, double t_s) const noexcept {
      const double slope = square > 0 ? (t_s - t_mean_s) * (point_s - t_mean_s) / square : 0;
      return weight[i] * (1 / weights + slope);
    }
  };
  [[nodiscard]] Line line() const noexcept;
  /// Time of a point by our clock, relative to the newest point.
  [[nodiscard]] double time_s(std::size_t i) const noexcept {
    return 1e-9 * static_cast<double>(point(i).here_ns - point(0).here_ns);
  }

  [[nodiscard]] const Point& point(std::size_t age) const noexcept {
    return points_[(newest_ + kPoints - age) % kPoints];
  }

  std::array<Point, kPoints> points_{};
  std::size_t newest_ = 0, kept_ = 0;
  std::uint64_t contradictions_ = 0;
  int contradictions_in_a_row_ = 0;
};

/// Sending time of a message by our clock; never later than now. Also accepts times of which only the lower
/// 32 bits of the microseconds were sent, as in compact messages; the result is then within 36 minutes before
/// now.
/// @param sent_ns   sending time by the other clock
/// @param offset_s  offset of the other clock; positive: it is ahead
std::int64_t sentByClockHere_ns(std::int64_t sent_ns, double offset_s, std::int64_t now_ns) noexcept;

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Offset and drift of another machine's clock, from messages that go there and back.
//
//   here   t0 ----------------------- t3      offset = ((t1 - t0) + (t2 - t3)) / 2
//               \                   /         error  <= half of the round trip (t3 - t0) - (t2 - t1)
//   there        t1 ----------- t2
//
// The error is greatest where one way took all of the time, so exchanges with a short round trip are worth
// most: of each quarter of a second only the shortest is kept (source: [Mills 1991], clock filter), and a
// line is laid through those of the last 16 s, each of which weighs the less the more its round trip is above
// the shortest. So a machine that is busy for seconds, with no short round trip meanwhile, does no harm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vps::scenes {

/// The four times of an exchange [ns], t0 and t3 by the clock here, t1 and t2 by the one there.
struct ClockExchange {
  std::int64_t t0_ns = 0, t1_ns = 0, t2_ns = 0, t3_ns = 0;

  [[nodiscard]] double roundTrip_s() const noexcept {
    return 1e-9 * static_cast<double>((t3_ns - t0_ns) - (t2_ns - t1_ns));
  }
  [[nodiscard]] double offset_s() const noexcept {
    return 0.5e-9 * static_cast<double>((t1_ns - t0_ns) + (t2_ns - t3_ns));
  }
};

/// Used by one thread. Never allocates.
class ClockEstimate {
 public:
  /// Takes an exchange in order of its t3. One whose round trip is negative, or whose clock is farther off
  /// than any drift explains, is not used but counted.
  void add(const ClockExchange& exchange) noexcept;

  [[nodiscard]] bool isKnown() const noexcept { return kept_ > 0; }
  /// What the clock there is ahead at that time by the clock here.
  [[nodiscard]] double offset_s(std::int64_t here_ns) const noexcept;
  /// Bound of its error at the last exchange, if the clock there does not lie and its rate stays.
  [[nodiscard]] double error_s() const noexcept;
  /// Rate of the clock there against the one here, less 1.
  [[nodiscard]] double drift() const noexcept;
  /// Exchanges that contradict the ones before.
  [[nodiscard]] std::uint64_t contradictions() const noexcept { return contradictions_; }

 private:
  struct Point {
    std::int64_t here_ns = 0;
    double offset_s = 0, round_trip_s = 0;
  };
  static constexpr std::size_t kPoints = 64;  ///< 16 s

  /// The line, as what each kept point counts in its value at a time.
  struct Line {
    double weights = 0, t_mean_s = 0, square = 0;
    std::array<double, kPoints> weight{};
    /// Of the point's offset in the line's value at that time from the newest point on.
    [[nodiscard]] double share(std::size_t i, double point_s, double t_s) const noexcept {
      const double slope = square > 0 ? (t_s - t_mean_s) * (point_s - t_mean_s) / square : 0;
      return weight[i] * (1 / weights + slope);
    }
  };
  [[nodiscard]] Line line() const noexcept;
  /// By the clock here, from the newest point on.
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

/// When a message was sent, by the clock here; never later than now. Takes times of which only the lower 32
/// bits of the microseconds came, too, as those of compact messages: so the result is within 36 minutes
/// before now.
/// @param sent_ns   by the clock there
/// @param offset_s  what that clock is ahead
std::int64_t sentByClockHere_ns(std::int64_t sent_ns, double offset_s, std::int64_t now_ns) noexcept;

}  // namespace vps::scenes

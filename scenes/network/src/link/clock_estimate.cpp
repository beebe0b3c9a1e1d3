// SPDX-License-Identifier: BSD-3-Clause
#include "link/clock_estimate.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

namespace {

constexpr std::int64_t kSpan_ns =
    250'000'000;  // of the exchanges in such a span, only that with the shortest round trip is kept
constexpr double kMostDrift = 1e-3;  // assumed: ten times the drift of a bad quartz clock
constexpr int kStep = 20;  // number of contradictions in a row after which the other clock was presumably
                           // set; the estimate restarts

double between_s(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

}  // namespace

void ClockEstimate::add(const ClockExchange& exchange) noexcept {
  const Point now{exchange.t3_ns, exchange.offset_s(), exchange.roundTrip_s()};
  bool contradicts = !(now.round_trip_s >= 0);
  if (kept_ > 0 && !contradicts) {
    const Point& last = point(0);
    const double may_differ_s = 0.5 * (now.round_trip_s + last.round_trip_s) +
                                kMostDrift * std::abs(between_s(last.here_ns, now.here_ns));
    contradicts = std::abs(now.offset_s - last.offset_s) > may_differ_s;
  }
  if (contradicts) {
    ++contradictions_;
    if (++contradictions_in_a_row_ >= kStep) kept_ = 0;
    return;
  }
  contradictions_in_a_row_ = 0;
  const bool is_same_span = kept_ > 0 && point(0).here_ns / kSpan_ns == now.here_ns / kSpan_ns;
  if (is_same_span) {
    if (now.round_trip_s <= point(0).round_trip_s) points_[newest_] = now;
    return;
  }
  newest_ = (newest_ + 1) % kPoints;
  points_[newest_] = now;
  kept_ = std::min(kept_ + 1, kPoints);
}

ClockEstimate::Line ClockEstimate::line() const noexcept {
  constexpr double kShare = 0.25, kLeast_s = 5e-6;  // assumed: spread of round trips on an idle machine
  double shortest_s = point(0).round_trip_s;
  for (std::size_t i = 0; i < kept_; ++i) shortest_s = std::min(shortest_s, point(i).round_trip_s);
  Line line;
  for (std::size_t i = 0; i < kept_; ++i) {
    const double off_s = point(i).round_trip_s - (1 - kShare) * shortest_s + kLeast_s;
    line.weight[i] = (kLeast_s / off_s) * (kLeast_s / off_s);
    line.weights += line.weight[i];
    line.t_mean_s += line.weight[i] * time_s(i);
  }
  line.t_mean_s /= line.weights;
  for (std::size_t i = 0; i < kept_; ++i) {
    const double t_s = time_s(i) - line.t_mean_s;
    line.square += line.weight[i] * t_s * t_s;
  }
  return line;
}

// With a single point the drift is unknown and taken as zero.
double ClockEstimate::drift() const noexcept {
  if (kept_ < 2) return 0;
  const Line line = this->line();
  double rate = 0;
  for (std::size_t i = 0; i < kept_ && line.square > 0; ++i)
    rate += line.weight[i] * (time_s(i) - line.t_mean_s) * (point(i).offset_s - point(0).offset_s);
  return line.square > 0 ? std::clamp(rate / line.square, -kMostDrift, kMostDrift) : 0;
}

double ClockEstimate::offset_s(std::int64_t here_ns) const noexcept {
  if (kept_ == 0) return 0;
  const Line line = this->line();
  double mean_s = 0;
  for (std::size_t i = 0; i < kept_; ++i)
    mean_s += line.weight[i] * (point(i).offset_s - point(0).offset_s) / line.weights;
  return point(0).offset_s + mean_s + drift() * (between_s(point(0).here_ns, here_ns) - line.t_mean_s);
}

// Each point's offset is off by at most half of its round trip, weighted by its share in the line.
double ClockEstimate::error_s() const noexcept {
  if (kept_ == 0) return 0;
  const Line line = this->line();
  double error_s = 0;
  for (std::size_t i = 0; i < kept_; ++i)
    error_s += std::abs(line.share(i, time_s(i), 0)) * 0.5 * point(i).round_trip_s;
  return error_s;
}

std::int64_t sentByClockHere_ns(std::int64_t sent_ns, double offset_s, std::int64_t now_ns) noexcept {
  constexpr std::int64_t kWrap_ns = (std::int64_t{1} << 32U) * 1000;
  // The offset is reduced modulo kWrap_ns, so that no value sent by a peer can overflow.
  const std::int64_t offset_ns =
      static_cast<std::int64_t>(std::fmod(1e9 * offset_s, static_cast<double>(kWrap_ns)));
  std::int64_t ago_ns = (now_ns % kWrap_ns - sent_ns % kWrap_ns + offset_ns) % kWrap_ns;
  if (ago_ns > kWrap_ns / 2) ago_ns -= kWrap_ns;
  if (ago_ns < -kWrap_ns / 2) ago_ns += kWrap_ns;
  return now_ns - std::max<std::int64_t>(0, ago_ns);
}

}  // namespace vps::scenes

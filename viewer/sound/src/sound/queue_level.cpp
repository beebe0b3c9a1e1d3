// SPDX-License-Identifier: BSD-3-Clause
#include "sound/queue_level.h"

#include <algorithm>
#include <cmath>

namespace vps::viewer {
namespace {

// Reserve for a thread that is later than in the last seconds. The reserve grows by kGrow_s with each gap,
// and shrinks by half of its growth after kCalm_s without gaps.
constexpr double kSpare_s = 1.25e-3, kGrow_s = 1.25e-3, kMostSpare_s = 10e-3, kCalm_s = 3;
constexpr double kLongPause_s = 0.05;  // assumed: after a longer time the writer was paused, not late
constexpr double kSettle_s =
    1;  // gaps during this time after the start do not count, since their causes do not recur
constexpr double kHalf_s = 1;           // half of the time window of Least
constexpr double kLongBlock_s = 10e-3;  // a longer block was written late
// Least time to drop from quiet and from loud samples.
constexpr double kWorthQuiet_s = 0.25e-3, kWorthLoud_s = 0.5e-3;
constexpr float kQuiet = 1e-3F;  // share of full scale (80 dB): 20 dB, less than a quiet room

}  // namespace

void QueueLevel::Least::turn() {
  has_before_ = now_ != kNone;
  before_ = now_;
  now_ = kNone;
}

void QueueLevel::Least::lower(std::size_t by) {
  for (std::size_t* value : {&now_, &before_})
    if (*value != kNone) *value -= std::min(by, *value);
}

void QueueLevel::Least::clear() {
  *this = {};
}

QueueLevel::QueueLevel(int rate_hz, double period_s)
    : rate_hz_(rate_hz), period_s_(period_s), spare_s_(kSpare_s) {}

std::size_t QueueLevel::samples(double time_s) const {
  return static_cast<std::size_t>(std::ceil(time_s * rate_hz_ - 1e-6));
}

void QueueLevel::lookBack(double now_s) {
  if (now_s - turned_s_ >= kHalf_s) {
    left_.turn();
    block_.turn();
    turned_s_ = now_s;
  }
  if (now_s - calm_since_s_ < kCalm_s) return;
  calm_since_s_ = now_s;
  spare_s_ = kSpare_s + 0.5 * (spare_s_ - kSpare_s);
}

QueuePlan QueueLevel::plan(bool is_playing, std::size_t waiting, std::size_t count, float peak,
                           double now_s) {
  const double since_s = now_s - written_s_;
  written_s_ = now_s;
  block_.add(std::min(count, samples(kLongBlock_s)));
  if (!is_playing) {
    if (has_begun_ && since_s < kLongPause_s) {
      ++gaps_;
      if (now_s - begun_s_ > kSettle_s) spare_s_ = std::min(spare_s_ + kGrow_s, kMostSpare_s);
    } else {
      begun_s_ = now_s;
    }
    has_begun_ = true;
    left_.clear();
    turned_s_ = calm_since_s_ = now_s;
  } else {
    left_.add(waiting);
    lookBack(now_s);
  }
  const std::size_t spare = samples(spare_s_), period = samples(period_s_), block = block_.get();
  // A block that is written late is longer by the delay, so the limits are for the queue after the write.
  const std::size_t usual = spare + period + block, most = usual + period + block;
  QueuePlan plan;
  if (!is_playing) plan.silence = usual - std::min(waiting + count, usual);
  const std::size_t after = waiting + plan.silence + count;
  if (after > most && count > 2 * block) {  // after a pause, old samples are dropped
    plan.dropped = std::min(count, after - usual);
    return plan;
  }
  std::size_t too_many = after > most ? after - most : 0;
  if (is_playing && left_.isKnown() &&
      left_.get() >= spare + samples(peak < kQuiet ? kWorthQuiet_s : kWorthLoud_s))
    too_many = std::max(too_many, left_.get() - spare);
  plan.dropped = std::min(too_many, peak < kQuiet ? count : count / 2);
  // If the card takes no samples for a long time, also loud samples are dropped, so that the delay stays
  // bounded.
  const std::size_t limit = most + samples(kMostSpare_s);
  if (after > limit) plan.dropped = std::max(plan.dropped, std::min(count, after - limit));
  left_.lower(plan.dropped);
  return plan;
}

/// The kept samples fade into the samples after the cut, so that the cut does not click.
std::vector<float> shortened(std::span<const float> samples, std::size_t dropped) {
  const std::size_t count = samples.size() - std::min(dropped, samples.size());
  std::vector<float> rest(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count));
  if (dropped == 0) return rest;
  for (std::size_t i = 0; i < count; ++i) {
    const float share = static_cast<float>(i + 1) / static_cast<float>(count);
    rest[i] += share * (samples[i + dropped] - rest[i]);
  }
  return rest;
}

}  // namespace vps::viewer

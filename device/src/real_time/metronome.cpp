// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/metronome.h"

namespace vps::device {

void Metronome::start() noexcept {
  due_ns_ = seen_ns_ = clock_->now_ns();
}

Beat Metronome::wait() noexcept {
  Beat beat;
  const std::int64_t now_ns = clock_->now_ns();
  if (now_ns < seen_ns_) {
    beat.has_clock_gone_back = true;
    due_ns_ = now_ns;
  }
  const std::int64_t over_ns = now_ns - (due_ns_ + period_ns_) - most_late_ns_;
  if (over_ns > 0) beat.missed_before = (over_ns + period_ns_ - 1) / period_ns_;
  due_ns_ += (1 + beat.missed_before) * period_ns_;

  if (due_ns_ > now_ns || most_late_ns_ == 0) clock_->sleepUntil(due_ns_);
  seen_ns_ = beat.woke_ns = clock_->now_ns();
  if (beat.woke_ns < now_ns) {  // the clock went back during the sleep
    beat.has_clock_gone_back = true;
    due_ns_ = beat.woke_ns;
  }
  if (beat.woke_ns - due_ns_ > most_late_ns_)
    beat.missed_asleep = (beat.woke_ns - due_ns_ - most_late_ns_) / period_ns_;
  due_ns_ += beat.missed_asleep * period_ns_;
  beat.due_ns = due_ns_;
  beat.periods = 1 + beat.missed_before + beat.missed_asleep;
  return beat;
}

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
#include "sound/beeper.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vps::viewer {
namespace {

constexpr double kBeep_s = 0.09, kPause_s = 0.06, kRamp_s = 0.005;
constexpr std::size_t kMost = 6;

}  // namespace

void Beeper::add(device::Beep beep) {
  if (std::find(pitches_hz_.begin(), pitches_hz_.end(), beep.pitch_hz) != pitches_hz_.end()) return;
  for (int i = 0; i < beep.count && pitches_hz_.size() < kMost; ++i) pitches_hz_.push_back(beep.pitch_hz);
}

double Beeper::next() {
  if (pitches_hz_.empty()) return 0;
  const double t_s = static_cast<double>(at_++) / rate_hz_, pitch_hz = pitches_hz_.front();
  if (t_s >= kBeep_s + kPause_s) {
    pitches_hz_.pop_front();
    at_ = 0;
    return 0;
  }
  if (t_s >= kBeep_s) return 0;
  const double ramp = std::clamp(std::min(t_s, kBeep_s - t_s) / kRamp_s, 0.0, 1.0);  // or it would click
  return ramp * std::sin(2 * std::numbers::pi * pitch_hz * t_s);
}

}  // namespace vps::viewer

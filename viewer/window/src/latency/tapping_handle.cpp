// SPDX-License-Identifier: BSD-3-Clause
#include "latency/tapping_handle.h"

#include <algorithm>
#include <cmath>

#include "vps_device/metronome.h"
#include "vps_device/pulled_handle.h"

namespace vps::viewer {
namespace {

constexpr double kRest_s = 1;             // assumed: by then the part is in hand
constexpr double kAside_s = 0.5;          // assumed: slow enough for the safety guard
constexpr double kMean_s = 0.05;          // averaging time of the force without contact
constexpr double kLongestPause_s = 0.02;  // a longer pause of the thread counts as this time

}  // namespace

TappingHandle::TappingHandle(const TapPlan& plan, std::size_t ticks) : plan_(plan) {
  ticks_.reserve(ticks);
}

device::DeviceLimits TappingHandle::limits() const noexcept {
  return device::PulledHandle().limits();  // the limits of the mouse's handle, which this handle replaces
}

double TappingHandle::now_s() noexcept {
  return device::monotonicSeconds();
}

device::DeviceSample TappingHandle::readAt(double time_s) noexcept {
  const double dt_s = has_time_ ? std::clamp(time_s - sample_.time_s, 0.0, kLongestPause_s) : 0;
  has_time_ = true;
  sample_.time_s = time_s;
  const Vec3 before_D = sample_.X_DH.p;
  move(dt_s);
  sample_.V_DH.v = dt_s > 0 ? Vec3((sample_.X_DH.p - before_D) / dt_s) : Vec3::Zero();
  if (ticks_.size() < ticks_.capacity()) ticks_.push_back({time_s, time_s, Vec3::Zero()});
  return sample_;
}

void TappingHandle::writeAt(const Wrench& F_Ho_D, double time_s) noexcept {
  f_D_ = F_Ho_D.f;
  if (!ticks_.empty() && ticks_.back().read_s == sample_.time_s) {
    ticks_.back().written_s = time_s;
    ticks_.back().f_Ho_D = f_D_;
  }
}

void TappingHandle::enter(Phase phase) noexcept {
  phase_ = phase;
  in_phase_s_ = 0;
  if (phase == Phase::Away) away_s_ = plan_.least_s + random_.uniform() * (plan_.most_s - plan_.least_s);
}

void TappingHandle::move(double dt_s) noexcept {
  in_phase_s_ += dt_s;
  const Vec3 felt_D = f_D_ - f_free_D_;
  if (phase_ != Phase::Hold && felt_D.norm() < 0.5 * plan_.press_N)
    f_free_D_ += std::min(1.0, dt_s / kMean_s) * felt_D;
  switch (phase_) {
    case Phase::Rest:
      f_free_D_ = f_D_;
      if (in_phase_s_ >= kRest_s) enter(Phase::Aside);
      break;
    case Phase::Aside:
      if (in_phase_s_ >= kAside_s) enter(Phase::Towards);
      break;
    case Phase::Towards:
      along_m_ += plan_.speed_m_s * dt_s;
      if (along_m_ > plan_.reach_m) has_found_nothing_ = true;
      if (felt_D.norm() >= plan_.press_N) {
        ++taps_;
        enter(Phase::Hold);
      }
      break;
    case Phase::Hold:
      if (in_phase_s_ >= plan_.hold_s) enter(Phase::Away);
      break;
    case Phase::Away:
      along_m_ -= plan_.speed_m_s * dt_s;
      if (in_phase_s_ >= away_s_) enter(Phase::Towards);
      break;
  }
  const double aside = phase_ == Phase::Rest    ? 0
                       : phase_ == Phase::Aside ? std::min(1.0, in_phase_s_ / kAside_s)
                                                : 1;
  sample_.X_DH.p = aside * aside * (3 - 2 * aside) * plan_.aside_D + along_m_ * plan_.d_D;
}

}  // namespace vps::viewer

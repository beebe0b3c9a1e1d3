// SPDX-License-Identifier: BSD-3-Clause
// A handle that taps by itself, so that how late picture, sound and force are can be measured without a
// person.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "vps_device/device.h"
#include "vps_device/random.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A motion of the handle in D: first aside, then towards the contact, and to and fro there.
struct TapPlan {
  Vec3 aside_D = Vec3::Zero();  ///< [m]
  Vec3 d_D = -Vec3::UnitZ();    ///< unit vector of the taps
  double reach_m = 0.1;         ///< farther along d_D there is no contact
  double speed_m_s = 0.05;      ///< assumed: as a person taps
  double press_N = 2;           ///< the tap goes on until the hand feels this
  double hold_s = 0.1;          ///< and stays there. Longer than a slow picture takes, so that none is missed
  double least_s = 0.1, most_s = 0.2;  ///< away, drawn at random, so that no other rhythm agrees with it
};

/// What the device's side of a loop did in one tick, by device::monotonicSeconds().
struct DeviceTick {
  double read_s = 0, written_s = 0;
  Vec3 f_Ho_D = Vec3::Zero();
};

/// One thread calls read() and write(). Its samples' time is device::monotonicSeconds().
class VPS_VIEWER_API TappingHandle final : public device::Device {
 public:
  /// @param ticks   as many are kept; later ones are not
  TappingHandle(const TapPlan& plan, std::size_t ticks);

  device::DeviceSample read() noexcept override { return readAt(now_s()); }
  void write(const Wrench& F_Ho_D) noexcept override { writeAt(F_Ho_D, now_s()); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "tapping_handle"; }

  /// read() and write() at a given time.
  device::DeviceSample readAt(double time_s) noexcept;
  void writeAt(const Wrench& F_Ho_D, double time_s) noexcept;

  /// Any thread: taps so far, and whether the whole reach was without contact.
  [[nodiscard]] std::size_t taps() const noexcept { return taps_.load(); }
  [[nodiscard]] bool hasFoundNothing() const noexcept { return has_found_nothing_.load(); }
  /// Once no thread calls read() any more.
  [[nodiscard]] const std::vector<DeviceTick>& ticks() const noexcept { return ticks_; }

 private:
  enum class Phase { Rest, Aside, Towards, Hold, Away };
  void enter(Phase phase) noexcept;
  void move(double dt_s) noexcept;
  [[nodiscard]] static double now_s() noexcept;

  TapPlan plan_;
  device::Random random_;
  device::DeviceSample sample_;
  Phase phase_ = Phase::Rest;
  double in_phase_s_ = 0, away_s_ = 0;
  double along_m_ = 0;
  Vec3 f_D_ = Vec3::Zero(), f_free_D_ = Vec3::Zero();  ///< as written last, and its mean without contact
  bool has_time_ = false;
  std::vector<DeviceTick> ticks_;
  std::atomic<std::size_t> taps_{0};
  std::atomic<bool> has_found_nothing_{false};
};

}  // namespace vps::viewer

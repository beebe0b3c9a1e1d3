// SPDX-License-Identifier: BSD-3-Clause
// A simulated handle that taps by itself, so that the latency of picture, sound and force can be measured
// without a person.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include "vps_device/device.h"
#include "vps_device/random.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Motion of the handle in D: first sideways, then towards the contact, then repeated taps.
struct TapPlan {
  Vec3 aside_D = Vec3::Zero();  ///< first motion [m]
  Vec3 d_D = -Vec3::UnitZ();    ///< direction of the taps, a unit vector
  double reach_m = 0.1;         ///< greatest distance along d_D at which contact is sought
  double speed_m_s = 0.05;      ///< assumed: the speed of a person's tap
  double press_N = 2;           ///< force on the hand that ends a tap
  /// Contact time of a tap, longer than a slow picture takes, so that a picture shows it.
  double hold_s = 0.1;
  /// Bounds of the random pause between taps, so that they do not follow another period.
  double least_s = 0.1, most_s = 0.2;
};

/// Times of one tick of the device, by device::monotonicSeconds(), and the force written.
struct DeviceTick {
  double read_s = 0, written_s = 0;
  Vec3 f_Ho_D = Vec3::Zero();
};

/// A device that follows a TapPlan. One thread calls read() and write(); time_s of its samples is
/// device::monotonicSeconds().
class VPS_VIEWER_API TappingHandle final : public device::Device {
 public:
  /// @param ticks  number of ticks to store; later ticks are not stored
  TappingHandle(const TapPlan& plan, std::size_t ticks);

  device::DeviceSample read() noexcept override { return readAt(now_s()); }
  void write(const Wrench& F_Ho_D) noexcept override { writeAt(F_Ho_D, now_s()); }
  [[nodiscard]] device::DeviceLimits limits() const noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "tapping_handle"; }

  /// Read and write as read() and write() do, but at a given time.
  device::DeviceSample readAt(double time_s) noexcept;
  void writeAt(const Wrench& F_Ho_D, double time_s) noexcept;

  /// Number of taps so far. May be called by any thread.
  [[nodiscard]] std::size_t taps() const noexcept { return taps_.load(); }
  /// Whether the handle moved over the whole reach without contact. May be called by any thread.
  [[nodiscard]] bool hasFoundNothing() const noexcept { return has_found_nothing_.load(); }
  /// The stored ticks. Call it after the last read().
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
  Vec3 f_D_ = Vec3::Zero(), f_free_D_ = Vec3::Zero();  ///< force written last, and mean force without contact
  bool has_time_ = false;
  std::vector<DeviceTick> ticks_;
  std::atomic<std::size_t> taps_{0};
  std::atomic<bool> has_found_nothing_{false};
};

}  // namespace vps::viewer

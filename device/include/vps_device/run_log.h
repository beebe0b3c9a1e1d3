// SPDX-License-Identifier: BSD-3-Clause
// What happens in a run, entry by entry, in the order in which it happens: what a recording holds, and what a
// replay is compared with.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// A wrench that was written to the device, after safety: on the hand about H's origin, in D.
struct WrittenWrench {
  double time_s = 0;  ///< of the sample that it answers
  Wrench F_Ho_D;
};

enum class RunEventKind : std::uint8_t {
  Take,   ///< the hand takes the part of a step
  Phase,  ///< what the hand is about: an OperatorPhase
  LetGo,  ///< the hand opens
  Note,   ///< anything else, in words
};

struct VPS_DEVICE_API RunEvent {
  double time_s = 0;
  std::int32_t step = -1;
  RunEventKind kind = RunEventKind::Note;
  std::uint8_t phase = 0;
  std::array<char, 96> text{};  ///< ends with a zero

  /// Longer words are cut.
  void say(std::string_view words) noexcept;
  [[nodiscard]] std::string_view words() const noexcept;
};

/// The run as a graph shows it, now and then.
struct RunTrace {
  double time_s = 0;
  Pose X_WP;       ///< part in hand
  Pose X_W_Proxy;  ///< where the handle is, in the scene
  Wrench F_hand_W;
  double depth_m = 0;
  std::int32_t step = -1;
  std::int32_t contacts = 0;
  std::uint8_t phase = 0;  ///< 0 reach, 1 insert, 2 press, 3 rest
};

/// Where loop and physics meet in a run by the clock: what each knew of the other. In lockstep there is none.
enum class SyncEventKind : std::uint8_t {
  Tick,     ///< the loop ticks, with that snapshot of physics
  Step,     ///< physics steps, with the proxy of that tick
  Settled,  ///< what was done beside the run is ready
  Paused,   ///< the loop has stopped
  Begin,    ///< physics asked for it, and the loop's thread did it
  GoBack,   ///< from here on as Begin
  Recentre,
  GoOn,
  HandOver,
  OpenClutch,
  CloseClutch,
  LetGo,
  Rearm,
};

struct SyncEvent {
  double time_s = 0;          ///< of the loop's last sample
  std::int32_t tick = 0;      ///< ticks so far, this one too
  std::int32_t periods = 1;   ///< of the loop since its last tick
  std::int32_t snapshot = 0;  ///< how many physics had published
  SyncEventKind kind = SyncEventKind::Tick;
};

using LogEntry = std::variant<DeviceSample, WrittenWrench, RunEvent, RunTrace, SyncEvent>;

VPS_DEVICE_API double timeOf(const LogEntry& entry) noexcept;

/// Where entries go. add() is called on the haptic path: it neither throws, allocates, locks nor waits,
/// unless an implementation that is for lockstep alone says so. One thread calls it.
class VPS_DEVICE_API RunLog {
 public:
  virtual ~RunLog() = default;
  virtual void add(const LogEntry& entry) noexcept = 0;
  /// So many entries were lost before they came here.
  virtual void lose(std::uint64_t) noexcept {}

 protected:
  RunLog() = default;
  RunLog(const RunLog&) = default;
  RunLog& operator=(const RunLog&) = default;
};

/// A device whose samples and wrenches are logged on their way. Both outlive it.
class VPS_DEVICE_API TappedDevice final : public Device {
 public:
  TappedDevice(Device& inner, RunLog& log) : inner_(inner), log_(log) {}
  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override;
  [[nodiscard]] DeviceLimits limits() const noexcept override { return inner_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return inner_.name(); }
  void rearm() noexcept override { inner_.rearm(); }

 private:
  Device& inner_;
  RunLog& log_;
  double time_s_ = 0;
};

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
// The log of a run, in the order of its events: a recording holds it, and a replay is compared with it.
#pragma once

#include <string.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

#include "vps_device/device.h"
#include "vps_device/export.h"

namespace vps::device {

/// A wrench that was written to the device, after safety: on the hand about H's origin, in D.
struct WrittenWrench {
  double time_s = 0;  ///< time of the sample from which the wrench was computed
  Wrench F_Ho_D;
};

enum class RunEventKind : std::uint8_t {
  Take,   ///< the hand grasps the part of a step
  Phase,  ///< the hand enters an OperatorPhase, or changes its strategy
  LetGo,  ///< the hand releases the part
  Note,   ///< any other event, as text
};

struct RunEvent {
  double time_s = 0;
  std::int32_t step = -1;
  RunEventKind kind = RunEventKind::Note;
  std::uint8_t phase = 0;       ///< for Phase: toByte(OperatorState)
  std::array<char, 96> text{};  ///< zero-terminated

  /// Sets the event's text; a longer text is truncated.
  void setWords(std::string_view words) noexcept {
    text.fill(0);
    std::copy_n(words.begin(), std::min(words.size(), text.size() - 1), text.begin());
  }
  [[nodiscard]] std::string_view words() const noexcept {
    return {text.data(), ::strnlen(text.data(), text.size())};
  }
};

/// A sample of the run for graphs, at a lower rate.
struct RunTrace {
  double time_s = 0;
  Pose X_WP;       ///< pose of the part in the hand
  Pose X_W_Proxy;  ///< pose of the handle in the scene
  Wrench F_hand_W;
  double depth_m = 0;
  std::int32_t step = -1;
  std::int32_t contacts = 0;
  std::uint8_t phase = 0;  ///< 0 reach, 1 insert, 2 press, 3 rest
};

/// Order in which haptic and physics threads exchanged state in a real-time run. Runs in lockstep have no
/// such events.
enum class SyncEventKind : std::uint8_t {
  Tick,     ///< a tick of the loop, with physics state `snapshot`
  Step,     ///< a physics step, with the proxy of tick `tick`
  Settled,  ///< background work has finished
  Paused,   ///< the loop has stopped
  // Commands of the physics thread that the loop's thread has carried out:
  Begin,
  GoBack,
  Recentre,
  GoOn,
  HandOver,
  OpenClutch,
  CloseClutch,
  LetGo,
  Rearm,
  // Others:
  SnapOn,  ///< axis snap acts from the present physics step on
  SnapOff,
  GiveUp,  ///< the part is released on request, after the present physics step
  Silent,  ///< physics in another process does not answer, which is a fault in the next tick
};

struct SyncEvent {
  double time_s = 0;          ///< time of the loop's last sample
  std::int32_t tick = 0;      ///< ticks so far, including this one
  std::int32_t periods = 1;   ///< periods of the loop since its last tick
  std::int32_t snapshot = 0;  ///< PhysicsState::step of the state that the tick used
  SyncEventKind kind = SyncEventKind::Tick;
};

using LogEntry = std::variant<DeviceSample, WrittenWrench, RunEvent, RunTrace, SyncEvent>;

inline double timeOf(const LogEntry& entry) noexcept {
  return std::visit([](const auto& e) { return e.time_s; }, entry);
}

/// Receives entries. add() is called on the haptic path: it neither throws, allocates, locks nor waits,
/// unless an implementation is stated to be for lockstep only. One thread calls it.
class VPS_DEVICE_API RunLog {
 public:
  virtual ~RunLog() = default;
  virtual void add(const LogEntry& entry) noexcept = 0;
  /// Reports that this many entries were lost before they could be added.
  virtual void lose(std::uint64_t) noexcept {}

 protected:
  RunLog() = default;
  RunLog(const RunLog&) = default;
  RunLog& operator=(const RunLog&) = default;
};

/// Forwards to a device and logs its samples and wrenches. Device and log must outlive this object.
class VPS_DEVICE_API TappedDevice final : public Device {
 public:
  TappedDevice(Device& inner, RunLog& log) : inner_(inner), log_(log) {}
  DeviceSample read() noexcept override {
    const DeviceSample sample = inner_.read();
    time_s_ = sample.time_s;
    log_.add(sample);
    return sample;
  }
  void write(const Wrench& F_Ho_D) noexcept override {
    inner_.write(F_Ho_D);
    log_.add(WrittenWrench{time_s_, F_Ho_D});
  }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return inner_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return inner_.name(); }
  void rearm() noexcept override { inner_.rearm(); }
  [[nodiscard]] DeviceEventQueue* ownEvents() noexcept override { return inner_.ownEvents(); }

 private:
  Device& inner_;
  RunLog& log_;
  double time_s_ = 0;
};

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
// The source of the handle's motion during a run: a simulated device with a virtual operator, a person at a
// live device, or a recording of any device.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptics/sync_events.h"
#include "vps_device/loop.h"
#include "vps_device/operator.h"
#include "vps_device/pulled_handle.h"
#include "vps_device/recording.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

class HapticDriver;

/// Receives a description of each safety fault.
using ReportFault = std::function<void(const std::string&)>;

/// A device together with the hand that moves it.
class Hand {
 public:
  virtual ~Hand() = default;
  /// The driver that reaches the haptic loop in another process; null if the loop runs in this process.
  /// The arguments are those of makeRealTimeDriver().
  virtual std::unique_ptr<HapticDriver> makeDriver(const device::LoopSettings& settings, double physics_s,
                                                   const ReportFault& report, device::RunLog* log);
  virtual device::Device& device() = 0;
  /// Plans a step that starts at time now_s. The task has only the way points of the scene's step that the
  /// part has not yet passed. May allocate; may run concurrently with step(), on another thread.
  virtual void prepare(const device::OperatorTask& task, std::size_t step, double now_s) = 0;
  /// The hand starts the step that prepare() planned. Never allocates.
  virtual void begin() = 0;
  /// The empty hand returns to the start of step `next` in kHandReturn_s; after the last step, to the middle
  /// of the workspace. Never allocates.
  virtual void goBack(std::size_t next) = 0;
  /// In OperatorPhase::Regrasp, with the clutch open, the hand moves to the start of the next segment in
  /// kHandReturn_s and stays there until goOn(). recentre() and goOn() never allocate.
  virtual void recentre() = 0;
  /// The hand continues the step after the clutch has closed again.
  virtual void goOn() = 0;
  /// Advances the hand by one tick, after the tick of the loop.
  virtual void step(const device::HeldPart& part, const device::HapticLoop& loop, double dt_s) = 0;
  [[nodiscard]] virtual device::OperatorPhase phase() const = 0;
  /// The operator's strategy; None if a person moves the hand.
  [[nodiscard]] virtual device::OperatorStrategy strategy() const { return device::OperatorStrategy::None; }
  [[nodiscard]] device::OperatorState state() const { return {phase(), strategy()}; }
  /// The recorded events of a real-time run that is replayed; empty otherwise.
  [[nodiscard]] virtual std::vector<RecordedEvent> events() const { return {}; }
  /// Whether the hand can move for at least `ticks` more ticks; the hand of a recording ends with the
  /// recording.
  [[nodiscard]] virtual bool canGoOn(int ticks) const = 0;
};

inline constexpr double kHandReturn_s = 1.5;  ///< time that the hand takes to return to the next part

/// The hand for the scene's [device] kind. Throws LoadError for an unknown kind, a path that a simulated
/// device cannot reach, and a device that a person moves where the run is not in real time or the device does
/// not answer within 3 s.
/// @param wish  handle pose that the mouse asks for; null: there is no mouse
std::unique_ptr<Hand> makeHand(const Scene& scene, bool is_real_time,
                               std::shared_ptr<device::HandleWish> wish = nullptr);

/// A simulated device and the virtual operator. Throws LoadError as makeHand().
std::unique_ptr<Hand> simulatedHand(const Scene& scene);

/// A person at a device. A step is done once the part has been within its tolerance, and the handle at rest,
/// for half a second: the person releases the cap or stick. The step fails at its timeout.
std::unique_ptr<Hand> personHand(std::unique_ptr<device::Device> device);

/// The hand of a recording of any device. `recording` must outlive the hand.
std::unique_ptr<Hand> recordedHand(device::Recording& recording);

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Record of a run: trace rows, samples for the judge, snapshots for pictures, and entries of the run's log.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "judge/overlap_record.h"
#include "vps_device/run_log.h"
#include "vps_scenes/run/result.h"
#include "world/assembly_world.h"
#include "world/step_rows.h"

namespace vps::scenes {

class RunTrace {
 public:
  /// @param log  may be null; receives events, and trace rows at scene.record.csv_rate_hz
  RunTrace(const Scene& scene, device::RunLog* log);

  /// Call beginStep() after the step's part was taken.
  void beginStep(const AssemblyWorld& world);
  /// Records the last physics step, and updates the peaks in the step's result.
  void add(const AssemblyWorld& world, TracePhase phase, StepResult& result);
  /// Call endStep() before the step's part is released.
  void endStep(const AssemblyWorld& world);
  /// The rows of the current step.
  [[nodiscard]] std::span<const TraceRow> stepRows() const { return rows_.rows(); }
  /// Hands over the samples of the current step.
  [[nodiscard]] std::vector<OverlapSample> takeSamples() { return rows_.takeSamples(); }

  /// Logs an event of the run. After the end of the hand's recording nothing is logged.
  void logEvent(const AssemblyWorld& world, device::RunEventKind kind, const std::string& text) const;
  /// Logs the operator's phase and strategy if they have changed.
  void logPhase(const AssemblyWorld& world);
  /// logPhase() then logs the next phase even if it is the same.
  void forgetPhase() { logged_state_.reset(); }

  /// Moves rows and pictures into the result.
  void moveTo(AssembleResult& result);

 private:
  device::RunLog* log_;
  long log_stride_;  ///< number of physics steps from one logged row to the next row
  StepRows rows_;
  long added_ = 0;                               ///< physics steps so far
  std::vector<Snapshot> start_, contact_, end_;  ///< one snapshot for each step
  double peak_contact_N_ = 0;                    ///< greatest contact force of the current step
  Vec3 axis_W_ = Vec3::Zero();                   ///< insertion axis
  double guide_N_ = 0;                           ///< force across the axis, averaged over kGuide_s
  std::optional<device::OperatorState> logged_state_;
};

/// The state of this instant for viewers.
Snapshot snapshotOf(const AssemblyWorld& world);

}  // namespace vps::scenes

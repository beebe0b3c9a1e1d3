// SPDX-License-Identifier: BSD-3-Clause
// A run of a procedure on its way into a recording.
#pragma once

#include <functional>
#include <string>

#include "vps/coupling_law.h"
#include "vps_device/recorder.h"
#include "vps_scenes/assemble.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// The names of a recording's attachments.
inline constexpr const char* kSceneAttachment = "scene.vps";

/// In simulated time a run waits where the recorder's ring is full. By the clock it does not: the recording
/// then says that it ends there.
class RunRecord final : public device::RunLog {
 public:
  /// The head says which program, scene, seeds, fidelity and choices. The scene in it wishes for the gains
  /// that were chosen, so that a replay does not choose again. Throws as Recorder.
  RunRecord(const std::string& file, const Scene& scene, const device::Device& device,
            const CouplingGains& gains, const AssembleOptions& options);
  /// Without finish(): says by options.warn where the unfinished recording is.
  ~RunRecord() override;

  void add(const device::LogEntry& entry) noexcept override;
  void lose(std::uint64_t count) noexcept override { recorder_.lose(count); }
  void finish();

 private:
  device::Recorder recorder_;
  std::function<void(const std::string&)> warn_;
  bool waits_, has_read_ = false, is_finished_ = false;
};

/// "0.1.0, GCC 12.2.0, double": what a recording was made with, and what this program is.
std::string programVersion();

}  // namespace vps::scenes

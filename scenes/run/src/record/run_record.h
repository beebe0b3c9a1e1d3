// SPDX-License-Identifier: BSD-3-Clause
// Writes a run of a procedure to a recording.
#pragma once

#include <functional>
#include <string>

#include "vps_device/loop.h"
#include "vps_device/recording.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Name of the attachment that holds the scene.
inline constexpr const char* kSceneAttachment = "scene.vps";
/// Of the head: device::LoopSettings::physics_limit_s, where it was not the default of a run by the clock.
inline constexpr const char* kPhysicsLimit = "physics_limit_s";

/// When the recorder's ring is full, a run in simulated time waits. A run in real time does not: the
/// recording then states that it ends there.
class RunRecord final : public device::RunLog {
 public:
  /// The head states program, scene, seeds, fidelity and choices. Its scene prescribes the coupling gains
  /// that were chosen, so that a replay does not choose again. Throws as Recorder.
  RunRecord(const std::string& file, const Scene& scene, const device::Device& device,
            const device::LoopSettings& settings, const AssembleOptions& options);
  /// Without finish(): reports through options.warn where the unfinished recording is.
  ~RunRecord() override;

  void add(const device::LogEntry& entry) noexcept override;
  void lose(std::uint64_t count) noexcept override { recorder_.lose(count); }
  void finish();

 private:
  device::Recorder recorder_;
  std::function<void(const std::string&)> warn_;
  bool waits_, has_read_ = false, is_finished_ = false;
};

/// Version, compiler and precision of this program: "0.1.0, compiler 12.2.0, Bullet double". Recordings hold
/// it.
std::string programVersion();

}  // namespace vps::scenes

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
/// Key in the recording's head for device::LoopSettings::physics_limit_s, present if it was not the default
/// of a run in real time.
inline constexpr const char* kPhysicsLimit = "physics_limit_s";

/// When the recorder's ring is full, a run in simulated time waits. A run in real time does not wait: the
/// recording then ends there and says so.
class RunRecord final : public device::RunLog {
 public:
  /// The head of the recording states program, scene, seeds, fidelity and chosen settings. The recorded scene
  /// states the coupling gains that the run used, so that a replay uses the same gains. Throws as Recorder.
  RunRecord(const std::string& file, const Scene& scene, const device::Device& device,
            const device::LoopSettings& settings, const AssembleOptions& options);
  /// If finish() was not called, reports through options.warn where the unfinished recording is.
  ~RunRecord() override;

  void add(const device::LogEntry& entry) noexcept override;
  void lose(std::uint64_t count) noexcept override { recorder_.lose(count); }
  void finish();

 private:
  device::Recorder recorder_;
  std::function<void(const std::string&)> warn_;
  bool waits_, has_read_ = false, is_finished_ = false;
};

/// Version, compiler and precision of this program: "0.1.0, compiler 12.2.0, Bullet double". Recordings
/// contain it.
std::string programVersion();

}  // namespace vps::scenes

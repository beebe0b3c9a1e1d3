// SPDX-License-Identifier: BSD-3-Clause
// Writes a run to a file while it happens, off the haptic path.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/mcap.h"
#include "vps_device/run_log.h"

namespace vps::device {

/// What stands at the head of a recording.
struct RecordingHead {
  std::map<std::string, std::string> about;  ///< version, scene, seed, rates, choices: for people and tools
  std::string device;
  DeviceLimits limits;  ///< a recording stands in for its device, so gains follow as they did
  std::vector<McapAttachment> attachments;
};

/// A recording in the making. Entries pass through a ring without locks to a thread that writes them. Until
/// finish() the file has another name beside its own, so that what stood there stays; a run that crashes
/// leaves that other file, which replays up to about the last quarter second.
class VPS_DEVICE_API Recorder final : public RunLog {
 public:
  /// Makes the file and writes the head. Throws LoadError where it cannot be made, or where something stands
  /// that is no recording of ours.
  Recorder(const std::string& file, const RecordingHead& head, std::size_t ring_entries = 8192);
  /// Without finish(): leaves the unfinished file if a device was read, and removes it otherwise.
  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Never waits: a full ring drops the entry and counts it.
  void add(const LogEntry& entry) noexcept override;

  /// Counts entries that were lost before they came here: the recording says that it ends there. By the
  /// thread that adds.
  void lose(std::uint64_t count) noexcept;

  /// For lockstep, where nobody is late: returns once half of the ring is free. Never on a haptic path.
  void waitForRoom() const;

  /// Writes what is left and the index, and gives the file its name. Throws std::runtime_error in words: disk
  /// full, say; the unfinished file then stays.
  void finish();

  [[nodiscard]] std::uint64_t dropped() const noexcept;
  /// Where the recording is until finish().
  [[nodiscard]] const std::string& unfinished() const noexcept;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::device

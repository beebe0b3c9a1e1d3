// SPDX-License-Identifier: BSD-3-Clause
// Writes the log of a run to a file while it runs, off the haptic path.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vps_device/detail/mcap.h"
#include "vps_device/export.h"
#include "vps_device/run_log.h"

namespace vps::device {

/// The head of a recording.
struct RecordingHead {
  std::map<std::string, std::string> about;  ///< version, scene, seed, rates, choices: for users and tools
  std::string device;
  DeviceLimits limits;  ///< a replay derives the same gains from them
  std::vector<McapAttachment> attachments;
};

/// A recording being written. Entries pass through a lock-free ring to a thread that writes them. Until
/// finish() the file has a temporary name in the same folder, so that an existing file stays; a run that
/// crashes leaves the temporary file, which replays up to about the last quarter second.
class VPS_DEVICE_API Recorder final : public RunLog {
 public:
  /// Creates the file and writes the head. Throws LoadError if it cannot be created, or if the name belongs
  /// to a file that is not a recording of this program.
  Recorder(const std::string& file, const RecordingHead& head, std::size_t ring_entries = 8192);
  /// Without finish(): keeps the unfinished file if a device was read, and removes it otherwise.
  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Never waits: a full ring drops the entry and counts it.
  void add(const LogEntry& entry) noexcept override;

  /// Counts entries that were lost before they could be added: the recording then ends there. Called by the
  /// thread that adds.
  void lose(std::uint64_t count) noexcept override;

  /// For lockstep, where waiting is allowed: returns once half of the ring is free. Never on a haptic path.
  void waitForRoom() const;

  /// Writes the remaining entries and the index, and renames the file. Throws std::runtime_error with the
  /// reason (disk full, say); the unfinished file then stays.
  void finish();

  [[nodiscard]] std::uint64_t dropped() const noexcept;
  /// Name of the file until finish().
  [[nodiscard]] const std::string& unfinished() const noexcept;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
// Writes the log of a run to a file while it runs, and reads it back: as data, as a device, and as the
// reference of a replay.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps_device/detail/mcap.h"
#include "vps_device/export.h"
#include "vps_device/run_log.h"

namespace vps::device {

/// The head of a recording.
struct RecordingHead {
  std::map<std::string, std::string> about;  ///< version, scene, seed, rates, choices, for users and tools
  std::string device;
  DeviceLimits limits;  ///< a replay derives the same gains from these limits
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
  /// If finish() was not called, keeps the unfinished file if a device was read, and removes it otherwise.
  ~Recorder() override;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Never waits: a full ring drops the entry and counts it.
  void add(const LogEntry& entry) noexcept override;

  /// Counts entries that were lost before they could be added: the recording then ends there. Only the thread
  /// that adds entries calls this function.
  void lose(std::uint64_t count) noexcept override;

  /// Waits until half of the ring is free. For lockstep only, never on a haptic path.
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

struct VPS_DEVICE_API RecordedRun {
  std::string file;
  RecordingHead head;
  std::vector<LogEntry> entries;
  std::string damage;  ///< empty if the file is complete; else a text with the damage, its place, and the
                       ///< entries kept

  [[nodiscard]] const McapAttachment* attachment(std::string_view name) const;
  [[nodiscard]] std::size_t reads() const;
};

/// Throws LoadError if the file is no recording or lacks a head. A truncated or damaged recording is kept up
/// to the damage, which RecordedRun::damage describes.
VPS_DEVICE_API RecordedRun loadRecording(const std::string& file);
/// Reads a recording from bytes; `file` is its name in messages.
VPS_DEVICE_API RecordedRun recordingFrom(std::string_view bytes, const std::string& file);

/// One CSV table for each kind of entry: its name without folder or ending, and its text.
VPS_DEVICE_API std::vector<std::pair<std::string, std::string>> csvTables(const RecordedRun& run);

/// A device that repeats a recording: each read() returns the next sample, whatever is written. After the
/// last sample the device is lost (Status::Fault).
class VPS_DEVICE_API Recording final : public Device {
 public:
  /// Takes ownership of the run.
  explicit Recording(RecordedRun run);
  explicit Recording(const std::string& file) : Recording(loadRecording(file)) {}

  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override {}
  [[nodiscard]] DeviceLimits limits() const noexcept override { return run_.head.limits; }
  [[nodiscard]] std::string_view name() const noexcept override { return run_.head.device; }

  [[nodiscard]] const RecordedRun& run() const noexcept { return run_; }
  /// Number of samples not yet read.
  [[nodiscard]] std::size_t left() const noexcept { return reads_.size() - next_; }
  /// The last phase that was logged before the next read; empty before the first phase.
  [[nodiscard]] std::optional<std::uint8_t> phase() const noexcept;

 private:
  RecordedRun run_;
  std::vector<std::size_t> reads_;  ///< indices into run_.entries
  /// Phases logged before each read, and after the last read.
  std::vector<std::optional<std::uint8_t>> phases_;
  std::size_t next_ = 0;
};

/// Compares a run with a recording, entry by entry and bit for bit. For lockstep only, since add() allocates.
class VPS_DEVICE_API ReplayCheck final : public RunLog {
 public:
  explicit ReplayCheck(const RecordedRun& run) : run_(run) {}
  void add(const LogEntry& entry) noexcept override;

  /// The first difference: tick, time, channel and field; empty while all entries are equal.
  [[nodiscard]] const std::string& departure() const noexcept { return departure_; }
  /// Number of equal entries.
  [[nodiscard]] std::size_t equal() const noexcept { return equal_; }
  /// Recorded entries that the run has not reached.
  [[nodiscard]] std::size_t left() const noexcept { return run_.entries.size() - next_; }

 private:
  const RecordedRun& run_;
  std::size_t next_ = 0, equal_ = 0, ticks_ = 0;
  std::string departure_;
};

}  // namespace vps::device

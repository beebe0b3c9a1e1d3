// SPDX-License-Identifier: BSD-3-Clause
// Reads a recorded run back, as data, as a device, and as the reference of a replay.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/recorder.h"

namespace vps::device {

struct VPS_DEVICE_API RecordedRun {
  std::string file;
  RecordingHead head;
  std::vector<LogEntry> entries;
  std::string
      damage;  ///< empty: the file is complete. Else, in words, what is wrong, where, and what was kept

  [[nodiscard]] const McapAttachment* attachment(std::string_view name) const;
  [[nodiscard]] std::size_t reads() const;
};

/// Throws LoadError if the file is no recording or lacks a head. A truncated or damaged recording is kept up
/// to the damage, which RecordedRun::damage describes.
VPS_DEVICE_API RecordedRun loadRecording(const std::string& file);
/// The same from bytes; `file` is for messages.
VPS_DEVICE_API RecordedRun recordingFrom(std::string_view bytes, const std::string& file);

/// One CSV table of the entries of each kind: name without folder or ending, and its text.
VPS_DEVICE_API std::vector<std::pair<std::string, std::string>> csvTables(const RecordedRun& run);

/// A device that repeats a recording: each read() returns the next sample, whatever is written. After the
/// last sample it is lost (Status::Fault).
class VPS_DEVICE_API Recording final : public Device {
 public:
  /// Keeps the run.
  explicit Recording(RecordedRun run);
  explicit Recording(const std::string& file) : Recording(loadRecording(file)) {}

  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override {}
  [[nodiscard]] DeviceLimits limits() const noexcept override { return run_.head.limits; }
  [[nodiscard]] std::string_view name() const noexcept override { return run_.head.device; }

  [[nodiscard]] const RecordedRun& run() const noexcept { return run_; }
  /// Samples not yet read.
  [[nodiscard]] std::size_t left() const noexcept { return reads_.size() - next_; }
  /// The last phase logged before the next read; empty at first.
  [[nodiscard]] std::optional<std::uint8_t> phase() const noexcept;

 private:
  RecordedRun run_;
  std::vector<std::size_t> reads_;                   ///< indices into run_.entries
  std::vector<std::optional<std::uint8_t>> phases_;  ///< before each read, and after the last
  std::size_t next_ = 0;
};

/// Compares a run with a recorded one, entry by entry, bit for bit. For lockstep only: it allocates.
class VPS_DEVICE_API ReplayCheck final : public RunLog {
 public:
  explicit ReplayCheck(const RecordedRun& run) : run_(run) {}
  void add(const LogEntry& entry) noexcept override;

  /// In words, the first difference: tick, time, channel and field; empty while all entries are equal.
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

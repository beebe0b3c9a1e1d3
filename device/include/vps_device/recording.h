// SPDX-License-Identifier: BSD-3-Clause
// A recorded run: read back, driven by, compared with.
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
  std::string damage;  ///< empty: whole. Else in words: what was found where, and what was kept

  [[nodiscard]] const McapAttachment* attachment(std::string_view name) const;
  [[nodiscard]] std::size_t reads() const;
};

/// Throws LoadError where there is no recording, or not even a head of one; a cut or damaged one is kept up
/// to the damage, which it tells.
VPS_DEVICE_API RecordedRun loadRecording(const std::string& file);
/// The same from bytes; `file` is for messages.
VPS_DEVICE_API RecordedRun recordingFrom(std::string_view bytes, const std::string& file);

/// One CSV table of the entries of each kind: name without folder or ending, and its text.
VPS_DEVICE_API std::vector<std::pair<std::string, std::string>> csvTables(const RecordedRun& run);

/// A recorded device: each read() gives the next recorded sample, whatever is written. After the last one it
/// is lost (Status::Fault).
class VPS_DEVICE_API Recording final : public Device {
 public:
  /// As loadRecording(); the run is kept.
  explicit Recording(RecordedRun run);
  explicit Recording(const std::string& file) : Recording(loadRecording(file)) {}

  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override {}
  [[nodiscard]] DeviceLimits limits() const noexcept override { return run_.head.limits; }
  [[nodiscard]] std::string_view name() const noexcept override { return run_.head.device; }

  [[nodiscard]] const RecordedRun& run() const noexcept { return run_; }
  /// Samples not yet read.
  [[nodiscard]] std::size_t left() const noexcept { return reads_.size() - next_; }
  /// The last phase noted before the next read; empty at first.
  [[nodiscard]] std::optional<std::uint8_t> phase() const noexcept;

 private:
  RecordedRun run_;
  std::vector<std::size_t> reads_;                   ///< places in run_.entries
  std::vector<std::optional<std::uint8_t>> phases_;  ///< before each read, and after the last
  std::size_t next_ = 0;
};

/// Compares a run with a recorded one, entry by entry, to the bit. For lockstep: it allocates.
class VPS_DEVICE_API ReplayCheck final : public RunLog {
 public:
  explicit ReplayCheck(const RecordedRun& run) : run_(run) {}
  void add(const LogEntry& entry) noexcept override;

  /// In words: at which tick, when, on which channel, what; empty as long as all is equal to the bit.
  [[nodiscard]] const std::string& departure() const noexcept { return departure_; }
  /// Entries found equal.
  [[nodiscard]] std::size_t equal() const noexcept { return equal_; }
  /// Recorded entries that the run has not come to.
  [[nodiscard]] std::size_t left() const noexcept { return run_.entries.size() - next_; }

 private:
  const RecordedRun& run_;
  std::size_t next_ = 0, equal_ = 0, ticks_ = 0;
  std::string departure_;
};

}  // namespace vps::device

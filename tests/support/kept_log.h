// SPDX-License-Identifier: BSD-3-Clause
// A log that keeps what came, and counts what was said to be lost.
#pragma once

#include <vector>

#include "vps_device/run_log.h"

namespace vps::test {

class KeptLog final : public device::RunLog {
 public:
  void add(const device::LogEntry& entry) noexcept override { entries.push_back(entry); }
  void lose(std::uint64_t count) noexcept override { lost += count; }
  std::vector<device::LogEntry> entries;
  std::uint64_t lost = 0;
};

}  // namespace vps::test

// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/haptic_log.h"

namespace vps::scenes {

void HapticLog::add(const device::LogEntry& entry) noexcept {
  if (log_ != nullptr)
    ring_.push(number_++, entry);  // an entry that finds no room leaves a gap in the numbers
}

}  // namespace vps::scenes

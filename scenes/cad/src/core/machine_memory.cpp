// SPDX-License-Identifier: BSD-3-Clause
#include "core/machine_memory.h"

#include <unistd.h>

namespace vps::scenes {

double machineMemoryBytes() noexcept {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0 ? static_cast<double>(pages) * static_cast<double>(page_bytes) : 0;
}

}  // namespace vps::scenes

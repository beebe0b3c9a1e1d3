// SPDX-License-Identifier: BSD-3-Clause
// What a running process uses, as the system counts it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace vps::bench {

/// What a process uses.
struct Usage {
  double memory_MB = 0;
  long files = 0, threads = 0;
};

inline Usage usageOf(pid_t id) {
  const std::string folder = "/proc/" + std::to_string(id);
  Usage usage;
  std::ifstream status(folder + "/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> usage.memory_MB;
    if (word == "Threads:") status >> usage.threads;
  }
  usage.memory_MB /= 1024;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/fd", gone)) {
    (void)entry;
    ++usage.files;
  }
  return usage;
}

}  // namespace vps::bench

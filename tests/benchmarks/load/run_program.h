// SPDX-License-Identifier: BSD-3-Clause
// Runs a program and measures it from outside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vps::bench {

struct ProgramRun {
  int status = -1;        ///< exit status; -1: a signal ended it
  bool is_ended = false;  ///< false: it was killed at the limit
  double wall_s = 0, cpu_s = 0;
  double peak_bytes = 0;  ///< resident
};

/// @param output  gets what it prints
ProgramRun runProgram(const std::vector<std::string>& words, const std::filesystem::path& output,
                      double limit_s);

}  // namespace vps::bench

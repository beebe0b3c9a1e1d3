// SPDX-License-Identifier: BSD-3-Clause
// The runs of a study on the workers of a Dask scheduler.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace vps::viewer {

/// A word of a POSIX shell.
inline std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// The Python script that shares tasks among workers: study_on_dask.py.
extern const char* const kStudyOnDaskScript;

/// First and last number of runs.
using RunRange = std::pair<std::size_t, std::size_t>;

/// Shares the numbers, which ascend, in ranges of about equal length without gaps.
std::vector<RunRange> rangesOf(const std::vector<std::size_t>& numbers, std::size_t tasks);

/// Makes runs and appends them to the log. Tasks that were made are in the log whatever happens to the
/// others. Throws LoadError where not all of them were made; the script has said why by then.
/// @param command  words of the command of which a task is made by --first, --last and --log
void makeOnDask(const std::string& address, const std::string& log, const std::vector<std::string>& command,
                const std::vector<RunRange>& ranges);

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The runs of a study on the workers of a Dask scheduler.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace vps::viewer {

/// The word in single quotes, for a POSIX shell.
inline std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// The Python script that shares tasks among workers: study_on_dask.py.
extern const char* const kStudyOnDaskScript;

/// Numbers of the first and the last run of a range.
using RunRange = std::pair<std::size_t, std::size_t>;

/// Divides the numbers, which must ascend, into ranges of about equal length without gaps.
std::vector<RunRange> rangesOf(const std::vector<std::size_t>& numbers, std::size_t tasks);

/// Makes runs on the workers and appends them to the log. Finished tasks are in the log even if others fail.
/// Throws LoadError if runs are missing, after the script has printed the reason.
/// @param command  words of the command; each task appends --first, --last and --log
void makeOnDask(const std::string& address, const std::string& log, const std::vector<std::string>& command,
                const std::vector<RunRange>& ranges);

}  // namespace vps::viewer

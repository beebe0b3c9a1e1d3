// SPDX-License-Identifier: BSD-3-Clause
#include "work/study_on_dask.h"

#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "output/json_fields.h"
#include "output/terminal.h"
#include "vps/errors.h"

namespace vps::viewer {

std::vector<RunRange> rangesOf(const std::vector<std::size_t>& numbers, std::size_t tasks) {
  std::vector<RunRange> ranges;
  const std::size_t most = (numbers.size() + tasks - 1) / tasks;
  for (const std::size_t number : numbers) {
    const bool goes_on =
        !ranges.empty() && ranges.back().second + 1 == number && number - ranges.back().first < most;
    if (goes_on)
      ranges.back().second = number;
    else
      ranges.emplace_back(number, number);
  }
  return ranges;
}

void makeOnDask(const std::string& address, const std::string& log, const std::vector<std::string>& command,
                const std::vector<RunRange>& ranges) {
  std::string tasks;
  for (const auto& [first, last] : ranges) {
    Json words = command;
    for (const std::string& word :
         {std::string("--first"), std::to_string(first), std::string("--last"), std::to_string(last)})
      words.push_back(word);
    tasks += words.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
  }
  // If the script ends early, writing to its pipe would raise SIGPIPE.
  auto* const before = std::signal(SIGPIPE, SIG_IGN);
  // Debian's package of Dask is not visible to another python3 that comes first on the PATH.
  const std::string line =
      "python=/usr/bin/python3; python3 -c 'import distributed' >/dev/null 2>&1 </dev/null && "
      "python=python3; "
      "exec $python -c " +
      quoted(kStudyOnDaskScript) + " " + quoted(address) + " " + quoted(log);
  std::FILE* script = ::popen(line.c_str(), "w");
  int status = -1;
  if (script != nullptr) {
    std::fwrite(tasks.data(), 1, tasks.size(), script);
    status = ::pclose(script);
  }
  std::signal(SIGPIPE, before);
  throwIfStopped();
  if (status == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw LoadError("", "", "--dask needs python3 with Dask (Debian: python3-distributed)");
  throw LoadError(log, "", "does not contain all runs; the same command makes the missing ones");
}

}  // namespace vps::viewer

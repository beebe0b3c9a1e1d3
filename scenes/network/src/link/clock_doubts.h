// SPDX-License-Identifier: BSD-3-Clause
// Reports each node whose clock contradicts itself, once.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "link/link.h"

namespace vps::scenes {

/// Used by one thread, which may block on the link's other threads.
class ClockDoubts {
 public:
  /// A message for each node whose clock became inconsistent since the last call.
  std::vector<std::string> takeNew(const Link& link);
  /// Final summary of all inconsistent nodes with their counts. Empty: none.
  [[nodiscard]] static std::string summary(const Link& link);

 private:
  std::set<std::uint64_t> said_;
};

}  // namespace vps::scenes

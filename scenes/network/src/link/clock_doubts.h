// SPDX-License-Identifier: BSD-3-Clause
// Says once of each other node that its clock contradicts itself.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "link/link.h"

namespace vps::scenes {

/// Used by one thread, which may wait for the link's other threads.
class ClockDoubts {
 public:
  /// A sentence for each node that has come into doubt since the last call.
  std::vector<std::string> takeNew(const Link& link);
  /// At the end: all of them with their counts. Empty: none.
  [[nodiscard]] static std::string summary(const Link& link);

 private:
  std::set<std::uint64_t> said_;
};

}  // namespace vps::scenes

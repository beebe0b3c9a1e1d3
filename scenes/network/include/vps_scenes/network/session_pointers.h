// SPDX-License-Identifier: BSD-3-Clause
// Where those who watch a session point, for all others who watch it. The render node and the device have no
// part in it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

struct SessionPointer {
  int who = 0;                ///< of all persons at this session, 1000 and above
  std::optional<Vec3> p_W{};  ///< none: no longer
};

/// Processes of one user on one machine, or those of a network, find each other by the session's name. At
/// most kMostPointing of them point at one time, and the pointers of others are not seen. Used by one thread;
/// nothing waits.
class VPS_SCENES_API SessionPointers {
 public:
  static constexpr int kMostPointing = 8, kMostPersons = 999;

  /// Throws LoadError for a name that cannot be a session's, and as SessionWatcher::join() for a network.
  explicit SessionPointers(const std::string& session, const SessionNetwork& network = {});
  ~SessionPointers();

  /// A person of this process points at a place, or no longer.
  /// @param person  1 to kMostPersons; others are not passed on
  void point(int person, const std::optional<Vec3>& p_W);
  /// What persons of other processes point at, each change once; those of a process that ended point no
  /// longer. Call it several times a second: it also repeats what this process points at, for those who come
  /// later.
  std::vector<SessionPointer> take();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

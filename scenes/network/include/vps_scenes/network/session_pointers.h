// Shares the places that watchers point at with the other watchers of a session. The render node and the
// device node are not involved.
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
  int who = 0;                ///< number of the person, 1000 or above, unique in the session
  std::optional<Vec3> p_W{};  ///< the place; none: the person no longer points
};

/// Processes of one user on one machine, or nodes of a network, find each other by the session's name. At
/// most kMostPointing processes can point at the same time; pointers of further processes are not shown. Used
/// by one thread; no call waits.
class VPS_SCENES_API SessionPointers {
 public:
  static constexpr int kMostPointing = 8, kMostPersons = 999;

  /// Throws LoadError for an invalid session name, and as SessionWatcher::join() for a network.
  explicit SessionPointers(const std::string& session, const SessionNetwork& network = {});
  ~SessionPointers();

  /// Sets or clears the place that a person of this process points at.
  /// @param person  1 to kMostPersons; other numbers are ignored
  void point(int person, const std::optional<Vec3>& p_W);
  /// Changes of the pointers of other processes, each change once; when a process ends, its pointers are
  /// cleared. Call take() several times a second, since take() also repeats the pointers of this process, for
  /// watchers that join later.
  std::vector<SessionPointer> take();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

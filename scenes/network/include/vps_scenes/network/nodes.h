// SPDX-License-Identifier: BSD-3-Clause
// The three nodes of one system, each in a process of its own: the render node computes physics and contact,
// the device's node drives the device and the haptic loop, and any number of watchers look on. Nodes meet
// by the name of a session, in shared memory that their user alone can read, or over UDP.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/run/assemble_options.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/run/snapshot.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Words for the user. May be called by any thread of a node, one at a time.
using Say = std::function<void(const std::string&)>;

class RequestServer;

/// `requests` is the server's, where there is one.
struct RenderOptions : AssembleOptions {
  std::string session = "default";
  SessionNetwork network;
  Say say;                          ///< may be empty
  RequestServer* server = nullptr;  ///< where others ask for something; null: they cannot
  double picture_rate_hz = 60;      ///< snapshots for the watchers, in simulated time
  /// Gets the file in which the run is recorded, before it begins; may be empty.
  std::function<void(const std::string&)> on_recording = nullptr;
};

/// Runs the procedure by the clock, with the hand in a device's node. Builds what the scene requires when the
/// device has joined, for which it waits; a device that is lost is waited for, too, while physics stands
/// still. `file`: to record the run in, empty: none; a run in which the device was lost cannot be replayed
/// beyond that. With `server`, others may ask for a recording until the run begins. Throws as assemble(), and
/// LoadError where another process runs the session.
VPS_SCENES_API AssembleResult renderNode(Scene& scene, const RenderOptions& options,
                                         const std::string& file = "");

struct DeviceNodeOptions {
  std::string session = "default";
  SessionNetwork network;
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< may be empty
  /// After the render node was lost and is back, force returns by itself. Otherwise a device that a person
  /// holds is re-armed at the next step; a simulated one always re-arms.
  bool rearms = false;
  bool stays = false;                                  ///< waits for the next session when one has ended
  std::string kind = {};                               ///< of the device; empty: the scene's
  std::shared_ptr<device::HandleWish> wish = nullptr;  ///< as in AssembleOptions
  std::function<void()> before_hello = nullptr;        ///< a session was joined; its run has not begun
};

struct DeviceNodeResult {
  int sessions = 0;  ///< joined
  int lost = 0;      ///< of these, how many render nodes were lost
  std::uint64_t ticks = 0, missed = 0, faults = 0;
  std::uint64_t refused = 0;  ///< messages; not requests that came twice, which get their reply again
  std::uint64_t refused_requests = 0;  ///< of render nodes, for what cannot be; the first one is said
};

/// Joins the session, drives the device that its scene names, and returns when the session has ended or
/// `stop` is set. Without news of the part for 20 ms the force on the hand is zero. The device's own limits
/// of force hold whatever comes. Throws LoadError where the session is of another version, has a device
/// already, or names a device that this machine does not have.
VPS_SCENES_API DeviceNodeResult deviceNode(const DeviceNodeOptions& options);

/// What the render node tells those who watch.
struct SessionNews {
  enum class Kind { Note, StepDone, Ended } kind = Kind::Note;
  int step = -1;
  Verdict verdict = Verdict::NotShown;
  double time_s = 0;  ///< simulated
  std::string text;
};

/// What the haptic loop does, for those who watch.
struct SessionForce {
  double time_s = 0;         ///< of the device
  std::int64_t sent_ns = 0;  ///< by the monotonic clock of the device's machine
  Wrench F_hand_W;
  bool is_holding = false;
  bool is_faulted = false;
};

/// A watcher: reads, and can change nothing. Used by one thread.
class VPS_SCENES_API SessionWatcher {
 public:
  /// Null: there is no such session now. Throws LoadError where it cannot be watched.
  static std::unique_ptr<SessionWatcher> join(const std::string& session, const SessionNetwork& network = {});
  ~SessionWatcher();

  [[nodiscard]] const Scene& scene() const;
  /// The newest snapshot, once.
  std::optional<Snapshot> takeSnapshot();
  /// When the last one was sent, by the monotonic clock of this machine. Over a network it is right to half
  /// of a round trip; the time of this call, until the other clock is known after some 0.3 s.
  [[nodiscard]] std::int64_t snapshotSent_ns() const;
  /// The next news, each once.
  std::optional<SessionNews> takeNews();
  std::optional<SessionForce> takeForce();
  /// The session has ended, or its render node is lost.
  [[nodiscard]] bool isOver() const;
  [[nodiscard]] bool hasEnded() const;
  [[nodiscard]] bool hasDevice() const;
  [[nodiscard]] std::uint64_t refused() const;
  /// Of other nodes whose clocks contradict themselves, in words; each once.
  std::vector<std::string> takeDoubts();

 private:
  struct Work;
  explicit SessionWatcher(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

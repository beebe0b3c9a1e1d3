// SPDX-License-Identifier: BSD-3-Clause
// The three kinds of nodes of a distributed run, each in its own process: the render node computes physics
// and contact, the device node drives the device and the haptic loop, and any number of watchers observe.
// Nodes find each other by the name of a session, in shared memory that only their user can read, or over
// UDP.
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

/// Receives messages for the user. Any thread of a node may call it, one at a time.
using Say = std::function<void(const std::string&)>;

class RequestServer;

/// Settings of a render node. `requests` of AssembleOptions is set by the server, if there is one.
struct RenderOptions : AssembleOptions {
  std::string session = "default";
  SessionNetwork network;
  Say say;                          ///< messages for the user; may be empty
  RequestServer* server = nullptr;  ///< server for requests to this node; null: no requests are accepted
  double picture_rate_hz = 60;      ///< rate of snapshots for the watchers, in simulated time
  /// Called with the name of the recording's file before the run begins; may be empty.
  std::function<void(const std::string&)> on_recording = nullptr;
};

/// Runs the procedure in real time, with the hand in a device node. Waits for a device and then builds the
/// models that the scene requires. If the device is lost, physics stops until a device has joined again. With
/// `server`, other programs may request a recording until the run begins. Throws as assemble(), and LoadError
/// if another process runs the session.
/// @param file  file of the recording; empty: the run is not recorded. A run in which the device was lost can
/// be replayed up to the loss only.
VPS_SCENES_API AssembleResult renderNode(Scene& scene, const RenderOptions& options,
                                         const std::string& file = "");

struct DeviceNodeOptions {
  std::string session = "default";
  SessionNetwork network;
  const std::atomic<bool>* stop = nullptr;
  Say say;  ///< messages for the user; may be empty
  /// True: force returns automatically when the render node is back after a loss. False: a device that is
  /// held by a person is re-armed at the next step; a simulated device always re-arms.
  bool rearms = false;
  bool stays = false;     ///< true: waits for the next session when a session has ended
  std::string kind = {};  ///< kind of device; empty: as the scene states
  std::shared_ptr<device::HandleWish> wish = nullptr;  ///< as AssembleOptions::wish
  std::function<void()> before_hello =
      nullptr;  ///< called when a session was joined and its run has not begun
};

struct DeviceNodeResult {
  int sessions = 0;  ///< number of sessions joined
  int lost = 0;      ///< number of sessions in which the render node was lost
  std::uint64_t ticks = 0, missed = 0, faults = 0;
  std::uint64_t refused =
      0;  ///< number of refused messages; a repeated request does not count, since it gets its reply again
  std::uint64_t refused_requests =
      0;  ///< number of impossible requests from render nodes; the first one is reported
};

/// Joins the session, drives the device that its scene names, and returns when the session has ended or
/// `stop` is set. The force on the hand is zero once no state of the part has come for 20 ms. The device's
/// own force limits always apply. Throws LoadError if the session has another version or already has a
/// device, or if it names a device that this machine does not have.
VPS_SCENES_API DeviceNodeResult deviceNode(const DeviceNodeOptions& options);

/// A message from the render node to the watchers.
struct SessionNews {
  enum class Kind { Note, StepDone, Ended } kind = Kind::Note;
  int step = -1;
  Verdict verdict = Verdict::NotShown;
  double time_s = 0;  ///< simulated time
  std::string text;
};

/// State of the haptic loop, for watchers.
struct SessionForce {
  double time_s = 0;         ///< time of the device
  std::int64_t sent_ns = 0;  ///< time of sending by the monotonic clock of the device's machine
  Wrench F_hand_W;
  bool is_holding = false;
  bool is_faulted = false;
};

/// A watcher reads a session and cannot change it. Used by one thread.
class VPS_SCENES_API SessionWatcher {
 public:
  /// Joins a session as a watcher. Returns null if there is no such session. Throws LoadError if the session
  /// cannot be watched.
  static std::unique_ptr<SessionWatcher> join(const std::string& session, const SessionNetwork& network = {});
  ~SessionWatcher();

  [[nodiscard]] const Scene& scene() const;
  /// The newest snapshot; each snapshot is returned once.
  std::optional<Snapshot> takeSnapshot();
  /// Time at which the last snapshot was sent, by the monotonic clock of this machine. Over a network the
  /// time is accurate to half a round trip. For about the first 0.3 s, until the clock offset is known, the
  /// time of this call is returned.
  [[nodiscard]] std::int64_t snapshotSent_ns() const;
  /// The next message to the watchers; each message is returned once.
  std::optional<SessionNews> takeNews();
  std::optional<SessionForce> takeForce();
  /// True if the session has ended, or its render node is lost.
  [[nodiscard]] bool isOver() const;
  [[nodiscard]] bool hasEnded() const;
  [[nodiscard]] bool hasDevice() const;
  [[nodiscard]] std::uint64_t refused() const;
  /// Messages about nodes whose clocks are inconsistent; one for each node.
  std::vector<std::string> takeDoubts();

 private:
  struct Work;
  explicit SessionWatcher(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

}  // namespace vps::scenes

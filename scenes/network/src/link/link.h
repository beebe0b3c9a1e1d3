// SPDX-License-Identifier: BSD-3-Clause
// The connection between the nodes of a session, as one node uses it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "link/broadcast_ring.h"
#include "link/shared_region.h"
#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// Number format of states and snapshots; other messages have one form.
enum class WireForm : std::uint8_t {
  Exact,    ///< all bits, as a recording needs them
  Compact,  ///< a tenth of the bytes (dense_state.h, compact_fields.h)
};

/// Message streams between nodes, each with one writer. Of a state channel only the newest message matters;
/// other channels deliver all messages in order.
enum class Channel : std::uint8_t {
  Haptic,    ///< state of the haptic loop, from the device node to all nodes
  Physics,   ///< state of the part, from the render node to the device node
  Snapshot,  ///< snapshot of the scene, from the render node to the watchers
  Request,   ///< requests of the render node to the device node
  Reply,     ///< the device node's replies to requests
  Log,       ///< entries of the haptic loop's log, from the device node to the render node, for a recording
  News,      ///< events in words, from the render node to the watchers
};
inline constexpr std::size_t kChannels = 7;

constexpr bool isState(Channel channel) {
  return channel <= Channel::Snapshot;
}
constexpr NodeRole writerOf(Channel channel) {
  const bool is_devices = channel == Channel::Haptic || channel == Channel::Reply || channel == Channel::Log;
  return is_devices ? NodeRole::Device : NodeRole::Render;
}

/// Whether a role receives a channel over a network; in shared memory every node can read all channels.
constexpr bool isReader(Channel channel, NodeRole role) {
  switch (channel) {
    case Channel::Haptic:
      return role != NodeRole::Device;
    case Channel::Physics:
    case Channel::Request:
      return role == NodeRole::Device;
    case Channel::Reply:
    case Channel::Log:
      return role == NodeRole::Render;
    case Channel::Snapshot:
    case Channel::News:
      return role == NodeRole::Watch;
  }
  return false;
}

/// Length limit of a message of any channel [bytes]; the longest is a snapshot of a scene with many parts.
inline constexpr std::size_t kLongestMessage = 64 * 1024;

/// Ring shapes in which a node buffers the messages of each channel until they are read.
inline constexpr std::array<RingShape, kChannels> kChannelShapes = {{
    {16, 1024},            // Haptic
    {16, 1024},            // Physics
    {4, kLongestMessage},  // Snapshot
    {64, 1024},            // Request
    {64, 1024},            // Reply
    {1U << 15U, 256},      // Log: 6 s of a loop at 1.6 kHz
    {256, 1024},           // News
}};

/// Round trip to a peer on another machine, and its clock.
struct PeerTiming {
  double round_trip_s = 0;           ///< longest of the last round trips
  double clock_offset_s = 0;         ///< offset of the peer's monotonic clock; positive: it is ahead
  double clock_error_s = 0;          ///< error bound of the offset
  double clock_drift = 0;            ///< rate of the peer's clock, minus 1
  std::uint64_t contradictions = 0;  ///< number of contradictory times from the peer
};

/// A node that sent contradictory times.
struct PeerDoubt {
  NodeRole role = NodeRole::Watch;
  std::uint64_t sender = 0;
  std::uint64_t contradictions = 0;
};

/// Priority of the link's threads. Assumed: below the haptic loop's 80, above physics' 70.
inline constexpr int kLinkPriority = 75;

/// Period at which an otherwise silent render node signals that it is alive. Assumed: three signals within
/// the limit for a silent peer.
inline constexpr double kSignPeriod_s = 4e-3;

/// The connection of one node. send() and receive() never throw, allocate, lock or wait, except that the
/// render node's send() calls the network. A channel is used by one thread at a time.
class Link {
 public:
  virtual ~Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Returns false if the message is longer than the channel allows.
  virtual bool send(Channel channel, std::string_view message) noexcept = 0;
  /// The newest message of a state channel, or the next message of another channel; a view of `buffer`.
  /// Empty: no new message.
  virtual std::string_view receive(Channel channel, std::span<char> buffer) noexcept = 0;
  /// Number of a channel's messages that were overwritten before they were received.
  [[nodiscard]] virtual std::uint64_t lost(Channel channel) const noexcept = 0;

  /// A counter that changes at least every kSignPeriod_s while the render node is alive, even during a long
  /// physics step. The device node's haptic thread reads the counter, so this function neither locks nor
  /// calls the system.
  [[nodiscard]] virtual std::uint64_t signsOfLife() const noexcept { return 0; }

  /// The form in which states are sent.
  [[nodiscard]] virtual WireForm form() const noexcept { return WireForm::Exact; }

  // The functions below may call the system.
  /// Waits over UDP until a message comes, at most `most_ns`; only a thread with nothing else to do may wait,
  /// and only one thread at a time. In shared memory the call returns at once, since shared memory does not
  /// signal arrivals.
  virtual void waitForMessage(std::int64_t /*most_ns*/) const {}
  /// Whether a live process has the role.
  [[nodiscard]] virtual bool isAlive(NodeRole role) const = 0;
  /// Number of live watchers.
  [[nodiscard]] virtual std::size_t watchers() const = 0;
  /// Identifier of this run of the render node, unique among all runs.
  [[nodiscard]] virtual std::uint64_t sessionId() const = 0;
  /// Whether the render node has ended the session regularly.
  [[nodiscard]] virtual bool hasEnded() const = 0;
  /// Timing of a peer; empty within one machine, and until the timing is known.
  [[nodiscard]] virtual std::optional<PeerTiming> timing(NodeRole) const { return {}; }
  /// The nodes of this session that sent contradictory times.
  [[nodiscard]] virtual std::vector<PeerDoubt> doubts() const { return {}; }
  /// Number of beats that could not be read, or were repeated.
  [[nodiscard]] virtual std::uint64_t refusedBeats() const { return 0; }
  /// The scene as an archive, which the caller has to validate.
  [[nodiscard]] virtual std::string sceneBytes() const = 0;

 protected:
  Link() = default;
};

/// Creates a session in shared memory of this machine, for the render node. Destroying the link ends the
/// session. Throws LoadError if the session exists.
std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes);
/// Joins a session in shared memory, for the other nodes. Returns null if there is no such session. Throws
/// LoadError if the session belongs to another version of this program, or if another device has joined it.
std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role);

/// Creates or joins a session in the given network. Over UDP the call waits up to a second for a session to
/// be found. Also throws LoadError if this build has no network support.
std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes,
                                  const SessionNetwork& network);
std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role, const SessionNetwork& network);

/// Creates or joins a session over UDP; implemented in dds/.
std::unique_ptr<Link> makeNetworkSession(const std::string& session, std::string_view scene_bytes,
                                         const SessionNetwork& network);
std::unique_ptr<Link> joinNetworkSession(const std::string& session, NodeRole role,
                                         const SessionNetwork& network);

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

/// Sends the pointers of one watcher to all watchers of a session; best effort. Used by one thread.
class PointerTopic {
 public:
  virtual ~PointerTopic() = default;
  PointerTopic(const PointerTopic&) = delete;
  PointerTopic& operator=(const PointerTopic&) = delete;

  virtual void send(std::string_view message) = 0;
  /// Messages received since the last call, including this watcher's own messages; in a flood, only the
  /// newest messages.
  virtual std::vector<std::string> take() = 0;

 protected:
  PointerTopic() = default;
};

/// Implemented in dds/. Throws LoadError as joinSession() over a network.
std::unique_ptr<PointerTopic> makePointerTopic(const std::string& session, const SessionNetwork& network);

}  // namespace vps::scenes

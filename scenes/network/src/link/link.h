// SPDX-License-Identifier: BSD-3-Clause
// The connection between the nodes of a session, as one node sees it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "link/broadcast_ring.h"
#include "link/shared_region.h"
#include "link/wire_form.h"
#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// What flows between nodes, each from one writer. States: the newest counts. The others: each counts, in
/// order.
enum class Channel : std::uint8_t {
  Haptic,    ///< state, device to all
  Physics,   ///< state, render to device
  Snapshot,  ///< state, render to watchers
  Request,   ///< render to device
  Reply,     ///< device to render
  Log,       ///< device to render: what a recording holds of the haptic loop
  News,      ///< render to watchers: what happened, in words
};
inline constexpr std::size_t kChannels = 7;

constexpr bool isState(Channel channel) {
  return channel <= Channel::Snapshot;
}
constexpr NodeRole writerOf(Channel channel) {
  const bool is_devices = channel == Channel::Haptic || channel == Channel::Reply || channel == Channel::Log;
  return is_devices ? NodeRole::Device : NodeRole::Render;
}

/// Who gets a channel's messages over a network; in shared memory all can read them.
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

/// Longest message of any channel, a snapshot of a scene with many parts.
inline constexpr std::size_t kLongestMessage = 64 * 1024;

/// Where a node keeps the messages of each channel until they are read.
inline constexpr std::array<RingShape, kChannels> kChannelShapes = {{
    {16, 1024},            // Haptic
    {16, 1024},            // Physics
    {4, kLongestMessage},  // Snapshot
    {64, 1024},            // Request
    {64, 1024},            // Reply
    {1U << 15U, 256},      // Log: 6 s of a loop at 1.6 kHz
    {256, 1024},           // News
}};

/// How a peer on another machine is reached.
struct PeerTiming {
  double round_trip_s = 0;           ///< the longest of the last ones
  double clock_offset_s = 0;         ///< what the peer's monotonic clock is ahead
  double clock_error_s = 0;          ///< bound of that
  double clock_drift = 0;            ///< its rate, less 1
  std::uint64_t contradictions = 0;  ///< times that it gave and that cannot be
};

/// What another node said of its times, and cannot be.
struct PeerDoubt {
  NodeRole role = NodeRole::Watch;
  std::uint64_t sender = 0;
  std::uint64_t contradictions = 0;
};

/// Of the threads of a link. assumed: below the haptic loop's 80, above physics' 70
inline constexpr int kLinkPriority = 75;

/// How often a render node that sends nothing else shows that it lives. assumed: three times within the limit
/// of a silent peer.
inline constexpr double kSignPeriod_s = 4e-3;

/// send() and receive() neither throw, allocate, lock nor wait, except that the render node's send() calls
/// the network. A channel is used by one thread at a time.
class Link {
 public:
  virtual ~Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// False: longer than the channel's messages may be.
  virtual bool send(Channel channel, std::string_view message) noexcept = 0;
  /// The newest message of a state, the next one of another channel, as it came; views `buffer`. Empty:
  /// nothing new.
  virtual std::string_view receive(Channel channel, std::span<char> buffer) noexcept = 0;
  /// Messages of a channel that were overwritten before they were received.
  [[nodiscard]] virtual std::uint64_t lost(Channel channel) const noexcept = 0;

  /// Changes while the render node lives, every kSignPeriod_s, also during a long step of its physics. For
  /// the device's node, whose haptic thread calls it: neither locks nor calls the system.
  [[nodiscard]] virtual std::uint64_t signsOfLife() const noexcept { return 0; }

  /// In which states are sent.
  [[nodiscard]] virtual WireForm form() const noexcept { return WireForm::Exact; }

  // The functions below may call the system.
  /// Over UDP until a message comes, or so long; for threads with nothing else to do, one at a time. In
  /// shared memory nobody is told of a message, so it returns at once.
  virtual void waitForMessage(std::int64_t /*most_ns*/) const {}
  /// Whether a process has the role now.
  [[nodiscard]] virtual bool isAlive(NodeRole role) const = 0;
  /// How many watchers there are now.
  [[nodiscard]] virtual std::size_t watchers() const = 0;
  /// A number that no other run of the render node has.
  [[nodiscard]] virtual std::uint64_t sessionId() const = 0;
  /// The render node has ended the session in good order.
  [[nodiscard]] virtual bool hasEnded() const = 0;
  /// Empty in one machine, and while nothing is known.
  [[nodiscard]] virtual std::optional<PeerTiming> timing(NodeRole) const { return {}; }
  /// The nodes of this session whose times contradict themselves.
  [[nodiscard]] virtual std::vector<PeerDoubt> doubts() const { return {}; }
  /// Beats that could not be read, or were sent again.
  [[nodiscard]] virtual std::uint64_t refusedBeats() const { return 0; }
  /// The scene, as its archive; the caller checks it.
  [[nodiscard]] virtual std::string sceneBytes() const = 0;

 protected:
  Link() = default;
};

/// In shared memory of this machine. For the render node: makes the session, whose link says that it has
/// ended once it is destroyed. Throws LoadError where the session exists.
std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes);
/// For the other nodes: null where there is no such session now. Throws LoadError where it is of another
/// version of this program, or another device has joined it.
std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role);

/// The same where the network says. Over UDP it waits up to a second for a session to be found. Throws
/// LoadError also where this build has no network.
std::unique_ptr<Link> makeSession(const std::string& session, std::string_view scene_bytes,
                                  const SessionNetwork& network);
std::unique_ptr<Link> joinSession(const std::string& session, NodeRole role, const SessionNetwork& network);

/// Over UDP only; in dds/.
std::unique_ptr<Link> makeNetworkSession(const std::string& session, std::string_view scene_bytes,
                                         const SessionNetwork& network);
std::unique_ptr<Link> joinNetworkSession(const std::string& session, NodeRole role,
                                         const SessionNetwork& network);

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// The messages between nodes: versioned, without pointers, little-endian. Each kind has a fixed size, except
// snapshots, which grow with the scene.
//
// Bytes from a peer are never trusted: size, version, number and every value are checked before use.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "link/link.h"
#include "messages/dense_state.h"
#include "messages/message_order.h"
#include "vps_device/coupling_port.h"
#include "vps_device/metronome.h"
#include "vps_device/operator.h"
#include "vps_device/run_log.h"
#include "vps_device/tick_statistics.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/run/snapshot.h"

namespace vps::scenes {

/// Version of the message formats; nodes of other versions are refused when they join.
inline constexpr std::uint16_t kMessageVersion = 8;

enum class MessageKind : std::uint16_t {
  Haptic = 1,
  Physics,
  Request,
  Reply,
  Hello,
  Times,
  Log,
  Snapshot,
  News,
  Beat,
  Pointer,
  Ask,
  Answer,
  Piece,
  DenseHaptic,  ///< dense states are numbered separately
  DensePhysics,
  Fetched,
};
inline constexpr std::size_t kMessageKinds = 18;  ///< number of kinds, including 0, which no message has

/// Header of each message.
struct Envelope {
  std::uint64_t sender =
      0;  ///< random number, unique to the sending process; compact messages contain its lower half
  std::uint64_t number = 0;  ///< number of the message, counted by the sender for each kind, from 1
  std::int64_t time_ns = 0;  ///< sending time by the sender's monotonic clock
};

/// State of the haptic loop after a tick, and of the hand.
struct HapticMessage {
  device::HapticState state;
  std::uint8_t hand = 0;  ///< device::toByte(OperatorState)
};

struct PhysicsMessage {
  device::PhysicsState state;
};

enum class RequestKind : std::uint8_t {
  Command,  ///< a command of the physics thread to hand and loop
  Start,    ///< starts the loop
  Stop,     ///< stops the loop
  Setup,    ///< sets the gains, and whether the loop's log is sent on Channel::Log
};

/// A request to the device node. The way points of a part are taken from the scene, which both nodes have.
struct RequestMessage {
  RequestKind kind = RequestKind::Command;
  device::SyncEventKind command = device::SyncEventKind::Tick;
  bool keeps_log = false;       ///< for Setup
  Pose X_WG{};                  ///< for HandOver
  std::uint32_t step = 0;       ///< for Begin and GoBack
  double now_s = 0;             ///< for Begin
  device::OperatorTask task{};  ///< for Begin, without its way points
  /// For Begin: number of way points of the scene's step that are still ahead of the part.
  std::uint32_t way_points_left = 0;
  CouplingGains gains{};  ///< for Setup
};

struct ReplyMessage {
  std::uint64_t request = 0;  ///< number of the request that was carried out or refused
  std::uint8_t hand = 0;      ///< state of the hand after the request
  std::int32_t tick = 0;  ///< last tick of the loop; states up to this tick show the hand before the request
  std::array<char, 160> refusal{};  ///< reason of a refusal, zero-terminated; empty: carried out
};

/// Sent by the device node when it joins.
struct HelloMessage {
  device::DeviceLimits limits;
  std::array<char, 64> name{};  ///< name of the device, zero-terminated
  bool is_by_person = false;    ///< moved by a person, who is slower than the virtual operator
  bool may_rearm = false;       ///< the render node may re-arm the loop after a peer was lost
};

/// Timing statistics of the device node.
struct TimesMessage {
  TickTimes tick, late, response;
  std::array<std::uint64_t, device::kTickCauses> missed_by{};
  std::uint64_t stale_ticks = 0, worst_tick = 0, faults = 0;
  double worst_us = 0;
  std::uint8_t worst_cause = 0;
  bool has_priority = false, has_locked_memory = false;
};

struct LogMessage {
  std::uint32_t number = 0;  ///< number of the entry; lost entries leave a gap
  device::LogEntry entry;    ///< a DeviceSample, a WrittenWrench or a SyncEvent
};

struct SnapshotMessage {
  Snapshot snapshot;
};

enum class NewsKind : std::uint8_t {
  Note,
  StepDone,
  Ended,  ///< the run has ended
};

struct NewsMessage {
  NewsKind kind = NewsKind::Note;
  std::int32_t step = -1;
  Verdict verdict = Verdict::NotShown;
  double time_s = 0;             ///< simulated time
  std::array<char, 512> text{};  ///< zero-terminated
};

/// Shows over a network that a node is alive; sent every 20 ms. A beat returns the times of each peer's last
/// beat, for the clock estimate.
struct BeatMessage {
  NodeRole role = NodeRole::Render;
  std::uint64_t session = 0;  ///< Link::sessionId()
  bool has_ended = false;
  std::uint64_t peer = 0;         ///< sender of the beat whose times are returned; 0: none
  std::int64_t peer_sent_ns = 0;  ///< sending time of the returned beat, by the peer's clock
  std::int64_t received_ns = 0;   ///< arrival time of the returned beat, by the clock of this beat's sender
};

/// Position of a watching person's pointer, sent to the other watchers.
struct PointerMessage {
  std::uint32_t person = 0;  ///< number of the person, assigned by the sender
  bool is_shown = false;     ///< false: the pointer was removed
  Vec3 p_W = Vec3::Zero();
};

/// Kinds of requests to the render node from a program that is not a node.
enum class AskKind : std::uint8_t {
  Who,      ///< status of the nodes
  Take,     ///< takes the next part; `text`: its name, or empty
  Release,  ///< releases the part in hand
  Rearm,    ///< re-arms the haptic loop after a fault
  Gains,    ///< sets the gains from the next part on
  Load,     ///< runs the scene with the hash `text` instead of the current one
  Again,    ///< runs the same scene from its beginning
  Record,   ///< records the runs that begin from now on in the file `text`; empty: stops recording
  Fetch,    ///< requests a piece, from `offset` on, of the recording that the sender requested with
            ///< `wants_file`
};

struct AskMessage {
  AskKind kind = AskKind::Who;
  std::array<char, 64> text{};  ///< zero-terminated
  double k_N_per_m = 0;         ///< for Gains
  double k_Nm_per_rad = 0;      ///< for Gains; 0: unchanged
  bool wants_file = false;      ///< for Record: the sender will fetch the file when it is complete
  std::uint64_t offset = 0;     ///< for Fetch [bytes]; the size of the file: the whole file was received
};

struct AnswerMessage {
  std::uint64_t asker = 0;  ///< sender of the answered request; `number` is the request's number
  std::uint64_t number = 0;
  bool is_done = false;
  bool wants_scene = false;       ///< for Load: the scene is unknown here and has to be sent in pieces
  std::array<char, 1024> text{};  ///< resulting state, or the reason of a refusal; zero-terminated
};

/// A piece of a scene's archive. Pieces are sent in order, and each piece is answered before the next piece
/// is sent.
struct PieceMessage {
  static constexpr std::size_t kMost = 32 * 1024;
  std::array<char, 64> hash{};  ///< hash of the whole archive, zero-terminated
  std::uint64_t total = 0;      ///< size of the whole archive [bytes]
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
  std::array<char, kMost> bytes{};
};

/// The answer to Fetch once the file is complete; before, the answer is an AnswerMessage.
struct FetchedMessage {
  std::uint64_t asker = 0;  ///< as in AnswerMessage
  std::uint64_t number = 0;
  PieceMessage piece;  ///< a piece of the file
};

/// Result of reading a message.
enum class Reading : std::uint8_t {
  Good,
  BadSize,
  BadVersion,
  BadKind,
  BadValue,  ///< not finite, out of range, or not a rotation
  WrongSender,
  Replayed,     ///< the message's number does not exceed the last number of this kind of message
  TooFarAhead,  ///< the message's number exceeds what the sender can have sent by now; see MessageOrder
  // The next results do not count as faults of the sender.
  Early,      ///< a dense state before the first whole one, which is normal after a late join
  Overtaken,  ///< a dense state that arrived after a later whole one
};
inline constexpr std::size_t kReadings = 10;
constexpr bool isRefused(Reading reading) {
  return reading != Reading::Good && reading < Reading::Early;
}
const char* toText(Reading reading);

/// Writes messages without allocating; the buffer keeps its capacity between messages.
class MessageWriter {
 public:
  /// @param sender  Envelope::sender
  explicit MessageWriter(std::uint64_t sender, WireForm form = WireForm::Exact);

  /// Returns the bytes, which stay valid until the next call. The sending time is the time of the call.
  template <typename Message>
  std::string_view write(const Message& message) noexcept;
  /// Number of the last message of a kind.
  [[nodiscard]] std::uint64_t number(MessageKind kind) const noexcept {
    return numbers_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::uint64_t sender() const noexcept { return sender_; }
  /// From now on states are written as with WireForm::Exact; readers accept both number formats.
  void writeExactStates() noexcept { has_exact_states_ = true; }
  /// The next states are sent whole, for a reader that has not received a whole state.
  void startAnew() noexcept { dense_haptic_ = dense_physics_ = {}; }

 private:
  std::string out_;
  std::uint64_t sender_;
  WireForm form_;
  bool has_exact_states_ = false;
  std::array<std::uint64_t, kMessageKinds> numbers_{};
  DenseWriter dense_haptic_, dense_physics_;
};

/// Reads messages and counts refused ones.
class MessageReader {
 public:
  explicit MessageReader(device::RealTimeClock& clock = device::monotonicClock()) noexcept : clock_(&clock) {}
  /// Accepts only this sender from now on; its first message may have any number.
  void bindTo(std::uint64_t sender) noexcept {
    sender_ = sender;
    forget();
  }
  /// Returns Good if `message` was filled; otherwise it is unchanged. Reads both number formats of WireForm,
  /// and of the compact format both whole and dense states. A dense state lacks some values, for which
  /// `message` must hold the previously read state. Allocates for snapshots only.
  template <typename Message>
  Reading read(std::string_view bytes, Message& message) noexcept;

  /// Envelope of the last good message.
  [[nodiscard]] const Envelope& envelope() const noexcept { return envelope_; }
  [[nodiscard]] const std::array<std::uint64_t, kReadings>& counts() const noexcept { return counts_; }
  [[nodiscard]] std::uint64_t refused() const noexcept;

 private:
  void forget() noexcept {
    orders_ = {};
    last_numbers_ = {};
    haptic_base_ = physics_base_ = {};
  }
  DenseBase& baseFor(const HapticMessage&) noexcept { return haptic_base_; }
  DenseBase& baseFor(const PhysicsMessage&) noexcept { return physics_base_; }
  template <typename Message>
  Reading readDenseState(std::string_view bytes, Message& message) noexcept;

  device::RealTimeClock* clock_;
  std::uint64_t sender_ = 0;  ///< 0: any sender
  std::array<MessageOrder, kMessageKinds> orders_{};
  std::array<std::uint64_t, kMessageKinds> last_numbers_{};
  DenseBase haptic_base_, physics_base_;
  Envelope envelope_;
  std::array<std::uint64_t, kReadings> counts_{};
};

/// The kind that the bytes claim to be.
MessageKind kindOf(std::string_view bytes) noexcept;

/// A new random identifier for Envelope::sender.
std::uint64_t newSender();

}  // namespace vps::scenes

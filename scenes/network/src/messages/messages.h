// SPDX-License-Identifier: BSD-3-Clause
// The messages between nodes: versioned, without pointers, least significant byte first. Each is of a fixed
// size, except snapshots, which grow with the scene.
//
// Bytes from a peer are never trusted: size, version, number, and every value are checked before use.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "link/shared_region.h"
#include "link/wire_form.h"
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

/// Of all messages together; nodes of other versions are refused when they join.
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
  DenseHaptic,  ///< states in another form, which count by themselves
  DensePhysics,
  Fetched,
};
inline constexpr std::size_t kMessageKinds = 18;  ///< and 0, of none

/// At the start of each message.
struct Envelope {
  std::uint64_t sender = 0;  ///< a number that no other process has; of compact ones the lower half
  std::uint64_t number = 0;  ///< of the message, counted by its sender for each kind, from 1
  std::int64_t time_ns = 0;  ///< of sending, by the sender's monotonic clock
};

/// The loop after a tick, and what the hand does.
struct HapticMessage {
  device::HapticState state;
  std::uint8_t hand = 0;  ///< device::toByte(OperatorState)
};

struct PhysicsMessage {
  device::PhysicsState state;
};

enum class RequestKind : std::uint8_t {
  Command,  ///< of the physics thread to hand and loop
  Start,    ///< the loop
  Stop,     ///< the loop
  Setup,    ///< gains, and whether what the loop does is sent on Channel::Log
};

/// Asks the device's node for something. A part's way points are in the scene, which both nodes have.
struct RequestMessage {
  RequestKind kind = RequestKind::Command;
  device::SyncEventKind command = device::SyncEventKind::Tick;
  bool keeps_log = false;       ///< of Setup
  Pose X_WG{};                  ///< of HandOver
  std::uint32_t step = 0;       ///< of Begin and GoBack
  double now_s = 0;             ///< of Begin
  device::OperatorTask task{};  ///< of Begin, without its way points
  /// Of Begin: how many way points of the scene's step are still ahead of the part.
  std::uint32_t way_points_left = 0;
  CouplingGains gains{};  ///< of Setup
};

struct ReplyMessage {
  std::uint64_t request = 0;  ///< the number of the request that was carried out, or refused
  std::uint8_t hand = 0;      ///< after it
  std::int32_t tick = 0;      ///< the loop's last one; states of this tick and before show the hand before it
  std::array<char, 160> refusal{};  ///< why it was not carried out, zero-terminated; empty: it was
};

/// The device's node when it joins.
struct HelloMessage {
  device::DeviceLimits limits;
  std::array<char, 64> name{};  ///< of the device, zero-terminated
  bool is_by_person = false;    ///< moved by a person, who takes longer than the virtual operator
  bool may_rearm = false;       ///< after a lost peer, the render node may re-arm the loop
};

/// How the device's node keeps time.
struct TimesMessage {
  TickTimes tick, late, response;
  std::array<std::uint64_t, device::kTickCauses> missed_by{};
  std::uint64_t stale_ticks = 0, worst_tick = 0, faults = 0;
  double worst_us = 0;
  std::uint8_t worst_cause = 0;
  bool has_priority = false, has_locked_memory = false;
};

struct LogMessage {
  std::uint32_t number = 0;  ///< of the entry; those that were lost leave a gap
  device::LogEntry entry;    ///< a DeviceSample, a WrittenWrench or a SyncEvent
};

struct SnapshotMessage {
  Snapshot snapshot;
};

enum class NewsKind : std::uint8_t {
  Note,
  StepDone,
  Ended,  ///< the run
};

struct NewsMessage {
  NewsKind kind = NewsKind::Note;
  std::int32_t step = -1;
  Verdict verdict = Verdict::NotShown;
  double time_s = 0;             ///< simulated
  std::array<char, 512> text{};  ///< zero-terminated
};

/// That a node lives, over a network; each 20 ms. It sends the last beat of each peer back, for the clocks.
struct BeatMessage {
  NodeRole role = NodeRole::Render;
  std::uint64_t session = 0;  ///< Link::sessionId()
  bool has_ended = false;
  std::uint64_t peer = 0;         ///< whose beat is sent back; 0: none
  std::int64_t peer_sent_ns = 0;  ///< by the peer's clock
  std::int64_t received_ns = 0;   ///< by the sender's
};

/// Where a person who watches points, to the others who watch.
struct PointerMessage {
  std::uint32_t person = 0;  ///< counted by the sender
  bool is_shown = false;     ///< false: no longer
  Vec3 p_W = Vec3::Zero();
};

/// What is asked of the render node by a program that is no node.
enum class AskKind : std::uint8_t {
  Who,      ///< who is there, and what they do
  Take,     ///< the next part; `text`: its name, or empty
  Release,  ///< the part in hand
  Rearm,    ///< the haptic loop, after a fault
  Gains,    ///< from the next part on
  Load,     ///< the scene with the hash `text` in place of this one
  Again,    ///< the same scene from its beginning
  Record,   ///< the runs that begin from now on, in the file `text`; empty: none
  Fetch,    ///< a piece of the recording that the sender asked for with `wants_file`, from `offset` on
};

struct AskMessage {
  AskKind kind = AskKind::Who;
  std::array<char, 64> text{};  ///< zero-terminated
  double k_N_per_m = 0;         ///< of Gains
  double k_Nm_per_rad = 0;      ///< of Gains; 0: as it is
  bool wants_file = false;      ///< of Record: the sender fetches the file once it is whole
  std::uint64_t offset = 0;     ///< of Fetch [bytes]; the size of the file: all has come
};

struct AnswerMessage {
  std::uint64_t asker = 0;  ///< the sender of what is answered, and its number
  std::uint64_t number = 0;
  bool is_done = false;
  bool wants_scene = false;       ///< of Load: it is not known here, and is to be sent in pieces
  std::array<char, 1024> text{};  ///< what is so, or why it was not done; zero-terminated
};

/// Of a scene's archive, in order, each answered before the next.
struct PieceMessage {
  static constexpr std::size_t kMost = 32 * 1024;
  std::array<char, 64> hash{};  ///< of the whole, zero-terminated
  std::uint64_t total = 0;      ///< [bytes]
  std::uint64_t offset = 0;
  std::uint32_t size = 0;
  std::array<char, kMost> bytes{};
};

/// The answer to Fetch once the file is whole; an AnswerMessage before.
struct FetchedMessage {
  std::uint64_t asker = 0;  ///< as in AnswerMessage
  std::uint64_t number = 0;
  PieceMessage piece;  ///< of the file
};

/// What became of the bytes of a message.
enum class Reading : std::uint8_t {
  Good,
  BadSize,
  BadVersion,
  BadKind,
  BadValue,  ///< not finite, out of range, or a rotation that is none
  WrongSender,
  Replayed,     ///< its number is not above the last one of its kind
  TooFarAhead,  ///< its number is above what the sender can have sent by now; see MessageOrder
  // Not refused for a fault of the sender:
  Early,      ///< a dense state before the first whole one, as who joins late gets them
  Overtaken,  ///< a dense state that came after a later whole one
};
inline constexpr std::size_t kReadings = 10;
constexpr bool isRefused(Reading reading) {
  return reading != Reading::Good && reading < Reading::Early;
}
const char* toText(Reading reading);

/// Writes messages without allocating: `out` keeps its room from one message to the next.
class MessageWriter {
 public:
  /// @param sender  Envelope::sender
  explicit MessageWriter(std::uint64_t sender, WireForm form = WireForm::Exact);

  /// The bytes, which stay until the next call. The time is that of the call.
  template <typename Message>
  std::string_view write(const Message& message) noexcept;
  /// Number of the last message of a kind.
  [[nodiscard]] std::uint64_t number(MessageKind kind) const noexcept {
    return numbers_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] std::uint64_t sender() const noexcept { return sender_; }
  /// States have every bit from now on; a reader takes both forms.
  void writeExactStates() noexcept { has_exact_states_ = true; }
  /// The next states are sent whole, for a reader that has none to begin with.
  void startAnew() noexcept { dense_haptic_ = dense_physics_ = {}; }

 private:
  std::string out_;
  std::uint64_t sender_;
  WireForm form_;
  bool has_exact_states_ = false;
  std::array<std::uint64_t, kMessageKinds> numbers_{};
  DenseWriter dense_haptic_, dense_physics_;
};

/// Reads messages and counts what was refused.
class MessageReader {
 public:
  explicit MessageReader(device::RealTimeClock& clock = device::monotonicClock()) noexcept : clock_(&clock) {}
  /// Refuses all senders but this one, whose messages begin at any number.
  void bindTo(std::uint64_t sender) noexcept {
    sender_ = sender;
    forget();
  }
  /// Good: `message` has the values. Otherwise it is unchanged. Takes all forms; of a dense state some values
  /// are those that `message` had, so it is the one that was read before. Allocates for snapshots only.
  template <typename Message>
  Reading read(std::string_view bytes, Message& message) noexcept;

  /// Of the last good message.
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
  std::uint64_t sender_ = 0;  ///< 0: any
  std::array<MessageOrder, kMessageKinds> orders_{};
  std::array<std::uint64_t, kMessageKinds> last_numbers_{};
  DenseBase haptic_base_, physics_base_;
  Envelope envelope_;
  std::array<std::uint64_t, kReadings> counts_{};
};

/// The kind that a message claims to be.
MessageKind kindOf(std::string_view bytes) noexcept;

/// A number for Envelope::sender.
std::uint64_t newSender();

}  // namespace vps::scenes

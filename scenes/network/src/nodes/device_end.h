// SPDX-License-Identifier: BSD-3-Clause
// The device node as the render node sees it: its identity, its newest state, and requests to it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/hand.h"
#include "haptics/merged_log.h"
#include "link/link.h"
#include "messages/messages.h"
#include "vps_scenes/run/run_requests.h"

namespace vps::scenes {

/// The render node's view of the device node. Used by the physics thread.
class DeviceEnd {
 public:
  /// @param link  link of the render node; outlives this object
  /// @param say   receives messages for the user and the watchers
  /// @param requests  requests of other programs; null: none are accepted
  DeviceEnd(Link& link, const std::atomic<bool>* stop, std::function<void(const std::string&)> say,
            RunRequests* requests = nullptr);

  /// Waits until a device has joined, or joined again. Returns false if the run was stopped.
  bool waitForDevice();
  /// Reads the messages that have arrived.
  void poll();

  /// Description of the device that joined first. Devices that replace the first device must have the same
  /// description.
  [[nodiscard]] const HelloMessage& hello() const { return *first_; }
  /// Number of times that a device has joined so far.
  [[nodiscard]] int joins() const { return joins_; }
  /// Whether a device is in the session and has sent its description.
  [[nodiscard]] bool isPresent() const { return is_present_ && link_.isAlive(NodeRole::Device); }

  /// The newest state, which is returned once; null: no state arrived since the last call.
  const HapticMessage* takeState();
  /// Time since the last state was received [s].
  [[nodiscard]] double silence_s() const;

  /// Sends a request and waits until it is carried out. Returns false if the device was lost in the meantime
  /// or the run is stopped. Throws LoadError with the device node's reason if it refuses the request; Stop is
  /// never refused.
  /// @param wait  called repeatedly while waiting
  bool request(const RequestMessage& request, const std::function<void()>& wait);
  /// Reply to the last request.
  [[nodiscard]] const ReplyMessage& reply() const { return reply_; }

  /// From now on sends states of the part with all bits, as a recording needs them.
  void sendExactStates() { writer_.writeExactStates(); }
  /// Sends a state of the part.
  void send(const device::PhysicsState& state);
  /// Sends a snapshot or news to the watchers.
  void send(const SnapshotMessage& snapshot);
  void send(const NewsMessage& news);

  [[nodiscard]] const TimesMessage& times() const { return times_; }
  /// Calls `each` for the received entries of the device's log, once per entry.
  template <typename Each>
  void takeLog(const Each& each) {
    for (std::string_view bytes; !(bytes = link_.receive(Channel::Log, buffer_)).empty();)
      if (log_reader_.read(bytes, log_) == Reading::Good) each(log_.number, log_.entry);
  }
  /// Summary of refused messages; empty: none.
  [[nodiscard]] std::string refusals() const;
  /// Reports each node whose times are inconsistent, once.
  void sayDoubts() {
    for (const std::string& words : doubts_.takeNew(link_)) say(words);
  }
  /// Summary of all inconsistent nodes with their counts; empty: none.
  [[nodiscard]] std::string doubts() const { return ClockDoubts::summary(link_); }
  [[nodiscard]] bool isStopped() const { return stop_ != nullptr && stop_->load(); }
  void say(const std::string& words) const { say_(words); }
  /// Whether other programs requested that the loop be re-armed; each request is returned once.
  [[nodiscard]] bool takeRearm() const { return requests_ != nullptr && requests_->takeRearm(); }
  void setFaulted(bool is_faulted) const {
    if (requests_ != nullptr) requests_->setFaulted(is_faulted);
  }
  /// Timing of the device node, see Link.
  [[nodiscard]] std::optional<PeerTiming> timing() const { return link_.timing(NodeRole::Device); }

 private:
  void welcome(const HelloMessage& hello);

  Link& link_;
  const std::atomic<bool>* stop_;
  std::function<void(const std::string&)> say_;
  RunRequests* requests_;
  MessageWriter writer_;
  MessageReader hello_reader_, reply_reader_, state_reader_, log_reader_;
  std::vector<char> buffer_;
  ClockDoubts doubts_;
  std::optional<HelloMessage> first_;
  bool is_present_ = false;
  std::uint64_t sender_ = 0;  ///< sender of the device's messages
  int joins_ = 0;
  HapticMessage state_;
  ReplyMessage reply_;
  TimesMessage times_;
  LogMessage log_;
  std::int64_t heard_ns_ = 0;  ///< arrival time of the last state
};

/// A hand in the device node; the driver of the hand sends each command to that node.
/// @param end  outlives the hand; a device must have joined
/// @param log  log of the run; null: the run is not recorded
std::unique_ptr<Hand> remoteHand(DeviceEnd& end, const Scene& scene, MergedLog* log = nullptr);

/// Time of silence after which a node counts as lost; the force on the hand is zero by then [s].
inline constexpr double kPeerLimit_s = 0.02;
/// Limit of silence in the device node; the rest of kPeerLimit_s is left for the tick that detects it.
inline constexpr double kSilence_s = 0.75 * kPeerLimit_s;

}  // namespace vps::scenes

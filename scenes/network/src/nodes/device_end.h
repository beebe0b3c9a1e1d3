// SPDX-License-Identifier: BSD-3-Clause
// The device's node, as the render node sees it: who it is, its newest state, and requests to it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/hand.h"
#include "haptics/merged_log.h"
#include "link/clock_doubts.h"
#include "link/link.h"
#include "messages/messages.h"
#include "vps_scenes/run/run_requests.h"

namespace vps::scenes {

/// Used by the physics thread.
class DeviceEnd {
 public:
  /// @param link  of the render node; outlives this object
  /// @param say   notes for the user and the watchers
  /// @param requests  of others; null: nobody asks
  DeviceEnd(Link& link, const std::atomic<bool>* stop, std::function<void(const std::string&)> say,
            RunRequests* requests = nullptr);

  /// Waits until a device has joined, or rejoined. False: stopped.
  bool waitForDevice();
  /// Reads what has come.
  void poll();

  /// Of the device that joined first. Those that take its place have the same.
  [[nodiscard]] const HelloMessage& hello() const { return *first_; }
  /// How often a device has joined so far.
  [[nodiscard]] int joins() const { return joins_; }
  /// A device is in the session and has said what it is.
  [[nodiscard]] bool isPresent() const { return is_present_ && link_.isAlive(NodeRole::Device); }

  /// The newest state, once; null: none since the last call.
  const HapticMessage* takeState();
  /// How long no state has come.
  [[nodiscard]] double silence_s() const;

  /// Sends a request and waits until it is carried out. False: the device was lost meanwhile, or the run is
  /// stopped. Throws LoadError if the device's node refuses it, in its words; Stop is never refused.
  /// @param wait  called from time to time meanwhile
  bool request(const RequestMessage& request, const std::function<void()>& wait);
  /// To the last request.
  [[nodiscard]] const ReplyMessage& reply() const { return reply_; }

  /// States of the part are sent with every bit from now on, as a recording needs them.
  void sendExactStates() { writer_.writeExactStates(); }
  /// Sends a state of the part.
  void send(const device::PhysicsState& state);
  /// Sends a snapshot or news to the watchers.
  void send(const SnapshotMessage& snapshot);
  void send(const NewsMessage& news);

  [[nodiscard]] const TimesMessage& times() const { return times_; }
  /// Entries of the device's log that have come. Each once.
  template <typename Each>
  void takeLog(const Each& each) {
    for (std::string_view bytes; !(bytes = link_.receive(Channel::Log, buffer_)).empty();)
      if (log_reader_.read(bytes, log_) == Reading::Good) each(log_.number, log_.entry);
  }
  /// What came and was refused, in words; empty: nothing.
  [[nodiscard]] std::string refusals() const;
  /// Says once of each node that its times contradict themselves.
  void sayDoubts() {
    for (const std::string& words : doubts_.takeNew(link_)) say(words);
  }
  /// All of them with their counts; empty: none.
  [[nodiscard]] std::string doubts() const { return ClockDoubts::summary(link_); }
  [[nodiscard]] bool isStopped() const { return stop_ != nullptr && stop_->load(); }
  void say(const std::string& words) const { say_(words); }
  /// Others ask for the loop to be re-armed, once.
  [[nodiscard]] bool takeRearm() const { return requests_ != nullptr && requests_->takeRearm(); }
  void setFaulted(bool is_faulted) const {
    if (requests_ != nullptr) requests_->setFaulted(is_faulted);
  }
  /// See Link.
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
  std::uint64_t sender_ = 0;  ///< of the device's messages
  int joins_ = 0;
  HapticMessage state_;
  ReplyMessage reply_;
  TimesMessage times_;
  LogMessage log_;
  std::int64_t heard_ns_ = 0;  ///< when the last state came
};

/// A hand in the device's node: its driver sends each command there.
/// @param end  outlives the hand; a device has joined
/// @param log  the log of the run; null: it is not recorded
std::unique_ptr<Hand> remoteHand(DeviceEnd& end, const Scene& scene, MergedLog* log = nullptr);

/// How long a node may be silent before it counts as lost: the force on the hand is zero by then.
inline constexpr double kPeerLimit_s = 0.02;
/// In the device's node. The rest of the limit is left for the tick that finds it.
inline constexpr double kSilence_s = 0.75 * kPeerLimit_s;

}  // namespace vps::scenes

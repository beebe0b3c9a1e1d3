// SPDX-License-Identifier: BSD-3-Clause
// The facts of a render node's run, and the handling of requests. Independent of sockets.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "link/link.h"
#include "messages/messages.h"
#include "requests/request_channel.h"
#include "vps_scenes/network/request_server.h"
#include "vps_scenes/run/run_requests.h"

namespace vps::scenes {

/// The first of run.mcap, run-2.mcap, ... that does not exist, so that no earlier run is lost.
std::string unusedFile(const std::string& wanted);

/// The facts about the current run that requests need. Thread-safe.
class ServedRun {
 public:
  /// @param link  must stay valid until end()
  void begin(const Scene& scene, std::string scene_bytes, const Link& link, const std::string& recording);
  void end();
  /// @param most  greatest gains at which the device is passive here
  void setDevice(const std::string& name, bool may_rearm, const CouplingGains& gains,
                 const CouplingGains& most);

  /// Called when the run begins. @param file  file of the run's recording; empty: the run is not recorded.
  /// The file can no longer be changed.
  void beginRecording(const std::string& file);
  /// Called when the recording's file is complete.
  void finishRecording();
  /// State of a file that was given to begin() or beginRecording(). Any other file is Failed, since no run
  /// writes it.
  enum class Recorded : std::uint8_t { Growing, Whole, Failed };
  [[nodiscard]] Recorded stateOf(const std::string& file) const;

  struct Facts {
    std::uint64_t number = 0;        ///< number of the run, starting at 1; 0: there was no run so far
    std::string name, hash, bytes;   ///< name, hash and archive of the scene
    std::vector<std::string> parts;  ///< part of each step
    std::string recording;  ///< file of the recording, kept until the next run begins; empty: no recording
    std::string device;     ///< name of the device; empty: no device has joined
    bool may_rearm = false;
    CouplingGains gains, most;
    bool is_running = false, has_device = false;
    bool has_begun = false;  ///< true: too late to record this run; kept until the next run begins
    std::size_t watchers = 0;
  };
  [[nodiscard]] Facts facts(bool with_bytes = false) const;

 private:
  mutable std::mutex mutex_;  ///< locked by the physics thread when a run begins and ends
  Facts facts_;
  std::map<std::string, Recorded> recorded_;
  const Link* link_ = nullptr;
};

/// Reads requests and answers them. Used by one thread.
class RequestHandler {
 public:
  /// All arguments must outlive this object.
  RequestHandler(const RequestServerOptions& options, RunRequests& requests, const ServedRun& run)
      : options_(options), requests_(requests), run_(run), writer_(newSender()) {}

  /// The bytes of the answer, valid until the next call; empty: no answer.
  std::string_view answer(const IncomingRequest& ask);
  /// A requested scene that is to run next; returned once.
  std::optional<Scene> takeNext() { return std::exchange(next_, std::nullopt); }
  /// The requested recording file for runs that begin from now on; empty: none.
  [[nodiscard]] const std::string& recording() const { return recording_; }
  /// Whether a requester is fetching a recording, or waits for one.
  [[nodiscard]] bool isFetched(double now_s) const;
  /// Frees the memory of a scene whose sender has stopped sending.
  void dropLostTransfer(double now_s);

 private:
  struct Client {
    MessageReader reader;
    std::string last_answer;
    std::uint64_t heard = 0;  ///< value of heard_ after the client's last request
  };
  struct Answer {
    bool is_done = false;
    std::string words;
    bool wants_scene = false;
  };
  struct Transfer {
    std::uint64_t sender = 0;
    std::string hash, bytes;
    std::uint64_t total = 0;
    double heard_s = 0;  ///< arrival time of the transfer's last piece, by device::monotonicSeconds()
  };

  /// A requester that wants a recording's file.
  struct Fetcher {
    std::string file;          ///< empty: the recording of the next recorded run
    std::string hash;          ///< hash of the whole file; empty: not computed yet
    double heard_s = 0;        ///< time of the requester's last message, by device::monotonicSeconds()
    std::uint64_t wanted = 0;  ///< if `file` is empty: number of the first run that may be meant
  };

  Client& clientOf(std::uint64_t sender);
  std::string_view write(std::uint64_t sender, std::uint64_t number, const Answer& answer);
  std::string_view refuseUnread(Reading reading);
  Answer obey(std::uint64_t sender, const AskMessage& ask);
  Answer who() const;
  /// The current gains of the coupling.
  [[nodiscard]] CouplingGains gainsOf(const ServedRun::Facts& facts) const;
  Answer take(const std::string& part);
  Answer release();
  Answer rearm();
  Answer setGains(double k_N_per_m, double k_Nm_per_rad);
  Answer load(const std::string& hash);
  Answer again();
  Answer record(std::uint64_t sender, const std::string& name, bool wants_file);
  /// Registers a requester of a file, or, if `file` is empty, of the recording of a run with a number of at
  /// least `wanted`. Returns false if there are too many requesters.
  bool addFetcher(std::uint64_t sender, const std::string& file, std::uint64_t wanted);
  /// Returns a piece of the file; if the result is empty, `words` is the answer.
  std::string_view fetch(const Envelope& envelope, std::uint64_t offset, Answer& words);
  Answer addPiece(std::uint64_t sender, const PieceMessage& piece);
  /// Validates the scene, and ends the current run to start it.
  Answer begin(const std::string& bytes);
  /// Stores a scene in the folder of received scenes.
  void keep(const std::string& hash, const std::string& bytes) const;
  [[nodiscard]] std::string fileOf(const std::string& hash) const;

  const RequestServerOptions& options_;
  RunRequests& requests_;
  const ServedRun& run_;
  MessageWriter writer_;
  std::map<std::uint64_t, Client> clients_;
  std::uint64_t heard_ = 0, refused_ = 0;
  Transfer transfer_;
  std::map<std::uint64_t, Fetcher> fetchers_;  ///< by sender
  std::optional<Scene> next_;
  std::string recording_;
  std::optional<CouplingGains> gains_;  ///< last requested gains
  int gains_step_ = -1;                 ///< step of the procedure when gains_ was requested
};

}  // namespace vps::scenes

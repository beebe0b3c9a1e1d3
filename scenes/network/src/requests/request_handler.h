// SPDX-License-Identifier: BSD-3-Clause
// What the render node tells of its run, and what is answered to a request. Nothing here knows sockets.
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

/// The run of now. All functions may be called by any thread.
class ServedRun {
 public:
  /// @param link  stays until end()
  void begin(const Scene& scene, std::string scene_bytes, const Link& link, const std::string& recording);
  void end();
  /// @param most  gains at which the device is passive here
  void setDevice(const std::string& name, bool may_rearm, const CouplingGains& gains,
                 const CouplingGains& most);

  /// The run is recorded from its beginning; empty: not. Nobody can change that from now on.
  void beginRecording(const std::string& file);
  /// The file is whole.
  void finishRecording();
  /// Of a file that was given to begin() or beginRecording(). Any other file is Failed: nobody writes it.
  enum class Recorded : std::uint8_t { Growing, Whole, Failed };
  [[nodiscard]] Recorded stateOf(const std::string& file) const;

  struct Facts {
    std::uint64_t number = 0;        ///< of the run, from 1 on; 0: there was none yet
    std::string name, hash, bytes;   ///< of the scene
    std::vector<std::string> parts;  ///< that each step moves
    std::string recording;           ///< file, which stays until the next run begins; empty: none
    std::string device;              ///< empty: none has joined
    bool may_rearm = false;
    CouplingGains gains, most;
    bool is_running = false, has_device = false;
    bool has_begun = false;  ///< so that it is too late to record it; stays until the next run begins
    std::size_t watchers = 0;
  };
  [[nodiscard]] Facts facts(bool with_bytes = false) const;

 private:
  mutable std::mutex mutex_;  ///< the physics thread takes it where a run begins and ends
  Facts facts_;
  std::map<std::string, Recorded> recorded_;
  const Link* link_ = nullptr;
};

/// Reads requests and answers them. Used by one thread.
class RequestHandler {
 public:
  /// All outlive it.
  RequestHandler(const RequestServerOptions& options, RunRequests& requests, const ServedRun& run)
      : options_(options), requests_(requests), run_(run), writer_(newSender()) {}

  /// The bytes of the answer; empty: none. They stay until the next call.
  std::string_view answer(const IncomingRequest& ask);
  /// A scene that is to run next, once.
  std::optional<Scene> takeNext() { return std::exchange(next_, std::nullopt); }
  /// The file that was asked for, for the runs that begin from now on; empty: none.
  [[nodiscard]] const std::string& recording() const { return recording_; }
  /// Somebody is fetching a recording, or waits for it.
  [[nodiscard]] bool isFetched(double now_s) const;
  /// Frees the memory of a scene that its sender has ceased to send.
  void dropLostTransfer(double now_s);

 private:
  struct Client {
    MessageReader reader;
    std::string last_answer;
    std::uint64_t heard = 0;  ///< count of requests then
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
    double heard_s = 0;  ///< when its last piece came, by device::monotonicSeconds()
  };

  /// Who wants to have a recording.
  struct Fetcher {
    std::string file;          ///< empty: of the next run that is recorded
    std::string hash;          ///< of the whole file; empty: not known yet
    double heard_s = 0;        ///< by device::monotonicSeconds()
    std::uint64_t wanted = 0;  ///< where `file` is empty: number of the first run that may be meant
  };

  Client& clientOf(std::uint64_t sender);
  std::string_view write(std::uint64_t sender, std::uint64_t number, const Answer& answer);
  std::string_view refuseUnread(Reading reading);
  Answer obey(std::uint64_t sender, const AskMessage& ask);
  Answer who() const;
  /// That the coupling has now.
  [[nodiscard]] CouplingGains gainsOf(const ServedRun::Facts& facts) const;
  Answer take(const std::string& part);
  Answer release();
  Answer rearm();
  Answer setGains(double k_N_per_m, double k_Nm_per_rad);
  Answer load(const std::string& hash);
  Answer again();
  Answer record(std::uint64_t sender, const std::string& name, bool wants_file);
  /// Takes up who wants the file, or without one the recording of a run from number `wanted` on; false: there
  /// are too many.
  bool addFetcher(std::uint64_t sender, const std::string& file, std::uint64_t wanted);
  /// The answer in `words`, or, if the result is not empty, a piece of the file.
  std::string_view fetch(const Envelope& envelope, std::uint64_t offset, Answer& words);
  Answer addPiece(std::uint64_t sender, const PieceMessage& piece);
  /// Checks the scene, and ends the run for it.
  Answer begin(const std::string& bytes);
  /// In the folder of scenes that were sent.
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
  std::optional<CouplingGains> gains_;  ///< that were set last
  int gains_step_ = -1;                 ///< of the procedure, in which that was
};

}  // namespace vps::scenes

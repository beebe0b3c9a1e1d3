// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/session_recording.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "core/valid_text.h"
#include "record/scene_archive.h"
#include "requests/asking.h"
#include "vps/errors.h"
#include "vps/write_file.h"

namespace vps::scenes {

namespace {

constexpr std::chrono::milliseconds kLook{300};   // interval of checks whether the run has ended
constexpr std::chrono::milliseconds kAppear{20};  // interval of checks whether the session exists
constexpr std::chrono::milliseconds kWait{5};
constexpr std::uint64_t kMostFile = std::uint64_t{1}
                                    << 34U;  // size limit of a recording [bytes]; assumed: hours of a run

/// Text from another program, without control characters that a terminal would interpret.
std::string wordsOf(const AnswerMessage& answer) {
  return printable(answer.text.data());
}

}  // namespace

bool isRecordingName(const std::string& name) {
  const auto is_good = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  };
  return name.size() > 5 && name.ends_with(".mcap") && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), is_good);
}

std::string recordingName(const std::string& file) {
  constexpr std::size_t kLongest = 63;  // length limit of AskMessage::text
  const std::string name = std::filesystem::path(file).filename().string();
  return isRecordingName(name) && name.size() <= kLongest ? name : "run.mcap";
}

struct SessionRecording::Work {
  explicit Work(SessionRecordingOptions given) : options(std::move(given)), thread([this] { run(); }) {}
  ~Work() {
    is_ending = true;
    if (thread.joinable()) thread.join();
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  [[nodiscard]] bool isStopped() const {
    return is_ending || (options.stop != nullptr && options.stop->load());
  }
  void run() {
    try {
      if (std::optional<Asking> asking = ask()) fetch(*asking);
    } catch (const std::exception& failed) {
      failure = failed.what();
    }
    is_over = true;  // set first: a thread that sees is_asked uses it to detect a refusal
    is_asked = true;
  }
  /// Requests the recording as soon as the session exists. Returns nothing if the request was refused or the
  /// user stops.
  std::optional<Asking> ask() {
    AskMessage message;
    message.kind = AskKind::Record;
    message.wants_file = true;
    const std::string name = options.name.empty() ? recordingName(options.file) : options.name;
    std::memcpy(message.text.data(), name.data(), std::min(name.size(), message.text.size() - 1));
    while (!isStopped()) {
      try {
        Asking asking(options.session, options.network);
        const AnswerMessage answer = asking.ask(message);
        if (!answer.is_done) {
          failure = wordsOf(answer);
          return {};
        }
        if (options.say) options.say(wordsOf(answer));
        is_asked = true;
        return asking;
      } catch (const LoadError& error) {  // usually the session does not exist yet
        keepProblem(error.what());
        std::this_thread::sleep_for(kAppear);
      }
    }
    failure = withProblem(
        "no vps render of this session has answered; check that vps render runs and accepts requests from "
        "this node");
    return {};
  }
  void keepProblem(const std::string& words) {
    const std::lock_guard lock(mutex);
    problem = words;
  }
  /// Appends the last problem to a message.
  std::string withProblem(const std::string& words) {
    const std::lock_guard lock(mutex);
    return problem.empty() ? words : words + ": " + problem;
  }
  void fetch(Asking& asking) {
    AskMessage message;
    message.kind = AskKind::Fetch;
    std::string bytes, hash;
    const auto piece = std::make_unique<FetchedMessage>();  // too large for the stack
    while (!isStopped()) {
      message.offset = bytes.size();
      const std::string answered = asking.askFor(message);
      if (kindOf(answered) != MessageKind::Fetched) {
        AnswerMessage answer;
        MessageReader().read(answered, answer);
        if (!answer.is_done) throw LoadError("", "", wordsOf(answer));
        std::this_thread::sleep_for(kLook);
        continue;
      }
      MessageReader().read(answered, *piece);
      if (take(piece->piece, hash, bytes)) {
        writeWholeFile(options.file, bytes);
        message.offset = bytes.size();
        tellThatItIsHere(asking, message);
        return;
      }
    }
    failure = "the transfer of the recording was stopped before the run had ended";
  }
  /// Tells the render node that the file has arrived, so that the render node does not wait for the transfer.
  static void tellThatItIsHere(Asking& asking, const AskMessage& message) {
    try {
      asking.ask(message);
    } catch (const LoadError&) {  // the session has ended, but the file is complete
    }
  }
  /// Appends a piece. Returns true after the last piece.
  static bool take(const PieceMessage& piece, std::string& hash, std::string& bytes) {
    if (hash.empty()) hash = piece.hash.data();
    if (piece.offset != bytes.size() || hash != piece.hash.data() || piece.size > PieceMessage::kMost ||
        piece.size == 0 || piece.total > kMostFile || piece.size > piece.total - piece.offset)
      throw LoadError("", "", "the received pieces of the recording are inconsistent");
    bytes.append(piece.bytes.data(), piece.size);
    if (bytes.size() < piece.total) return false;
    if (contentHash(bytes) != hash) throw LoadError("", "", "the recording was damaged in transfer");
    return true;
  }

  SessionRecordingOptions options;
  std::string failure;  ///< written by the thread before is_over is set
  std::mutex mutex;     ///< guards the next member
  std::string problem;  ///< reason of the last failed attempt
  std::atomic<bool> is_asked{false}, is_over{false}, is_ending{false};
  std::thread thread;
};

SessionRecording::SessionRecording(SessionRecordingOptions options)
    : work_(std::make_unique<Work>(std::move(options))) {}
SessionRecording::~SessionRecording() = default;

std::string SessionRecording::waitUntilAsked(double most_s) {
  for (double left_s = most_s; left_s > 0 && !work_->is_asked; left_s -= 5e-3)
    std::this_thread::sleep_for(kWait);
  if (!work_->is_asked) return work_->withProblem("no answer to the request for a recording");
  return work_->is_over ? work_->failure : "";
}

std::string SessionRecording::finish() {
  constexpr double kLate_s = 2;  // a session that has ended no longer answers
  if (!work_->is_asked && !waitUntilAsked(kLate_s).empty()) work_->is_ending = true;
  while (!work_->is_over) std::this_thread::sleep_for(kWait);
  return work_->failure;
}

}  // namespace vps::scenes

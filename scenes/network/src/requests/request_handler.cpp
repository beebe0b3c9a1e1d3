// SPDX-License-Identifier: BSD-3-Clause
#include "requests/request_handler.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "procedure/assembly_run.h"
#include "record/scene_archive.h"
#include "requests/request_channel.h"
#include "vps/errors.h"
#include "vps/write_file.h"
#include "vps_device/gains.h"
#include "vps_device/metronome.h"
#include "vps_scenes/network/session_request.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostSenders = 64;         // limits the memory that a flood of senders can take
constexpr std::uint64_t kMostScene = 1U << 30U;  // size limit of a scene's archive [bytes]
constexpr double kTransferLimit_s = 10;    // a sender repeats a piece every 0.3 s, and gives up after 5 s
constexpr std::size_t kMostFetchers = 16;  // assumed
constexpr double kFetchLimit_s = 5;        // a requester that waits for a recording asks every 0.3 s
constexpr const char* kSceneEnding = ".scene";
constexpr std::size_t kMostKept =
    16;  // limit of stored scenes; assumed: as many as a person works on; the newest are kept

template <std::size_t N>
std::string textOf(const std::array<char, N>& text) {
  return text.data();
}

std::string quoted(const std::string& name) {
  return "'" + name + "'";
}

std::string gainsInWords(const CouplingGains& gains) {
  char words[80];
  std::snprintf(words, sizeof words, "%.0f N/m and %.1f N m/rad", gains.k_N_per_m, gains.k_Nm_per_rad);
  return words;
}

/// Size of the longest prefix within a limit that does not split a UTF-8 character.
std::size_t fittingSize(const std::string& text, std::size_t most) {
  std::size_t size = std::min(text.size(), most);
  if (size == text.size()) return size;
  while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return size;
}

std::string readAll(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

RequestHandler::Client& RequestHandler::clientOf(std::uint64_t sender) {
  if (!clients_.contains(sender) && clients_.size() >= kMostSenders)
    clients_.erase(std::min_element(clients_.begin(), clients_.end(), [](const auto& a, const auto& b) {
      return a.second.heard < b.second.heard;
    }));
  const auto [found, is_new] = clients_.try_emplace(sender);
  if (is_new) found->second.reader.bindTo(sender);
  found->second.heard = ++heard_;
  return found->second;
}

std::string_view RequestHandler::write(std::uint64_t sender, std::uint64_t number, const Answer& answer) {
  AnswerMessage message{sender, number, answer.is_done, answer.wants_scene, {}};
  std::memcpy(message.text.data(), answer.words.data(), fittingSize(answer.words, message.text.size() - 1));
  return writer_.write(message);
}

/// The answer's version tells a requester of another version that the versions differ.
std::string_view RequestHandler::refuseUnread(Reading reading) {
  if (refused_++ == 0 && options_.say)
    options_.say(std::string("a request that cannot be read was refused: ") + toText(reading));
  return reading == Reading::BadVersion ? write(0, 0, {false, "another version", false}) : std::string_view();
}

std::string_view RequestHandler::answer(const IncomingRequest& ask) {
  const bool is_piece = kindOf(ask.bytes) == MessageKind::Piece;
  AskMessage message;
  PieceMessage piece;
  const auto read = [&](MessageReader& reader) {
    return is_piece ? reader.read(ask.bytes, piece) : reader.read(ask.bytes, message);
  };
  MessageReader any;
  if (const Reading reading = read(any); reading != Reading::Good) return refuseUnread(reading);
  const Envelope envelope = any.envelope();
  if (ask.is_stranger)
    return write(envelope.sender, envelope.number,
                 {false, "refused: the session belongs to another user of this machine", false});
  Client& client = clientOf(envelope.sender);
  const Reading reading = read(client.reader);
  if (reading == Reading::Replayed && !client.last_answer.empty())
    return client.last_answer;  // the first answer was lost
  if (reading != Reading::Good) return refuseUnread(reading);
  Answer answer;
  if (!is_piece && message.kind == AskKind::Fetch) {
    if (const std::string_view fetched = fetch(envelope, message.offset, answer); !fetched.empty())
      return client.last_answer = fetched;
  } else {
    answer = is_piece ? addPiece(envelope.sender, piece) : obey(envelope.sender, message);
  }
  client.last_answer = write(envelope.sender, envelope.number, answer);
  return client.last_answer;
}

RequestHandler::Answer RequestHandler::obey(std::uint64_t sender, const AskMessage& ask) {
  if (ask.kind == AskKind::Who) return who();
  if (options_.rights != RequestRights::All)
    return {false, "refused: only `who` is allowed here; start vps render with --requests all to allow more",
            false};
  const std::string text = textOf(ask.text);
  switch (ask.kind) {
    case AskKind::Who:
      break;
    case AskKind::Take:
      return take(text);
    case AskKind::Release:
      return release();
    case AskKind::Rearm:
      return rearm();
    case AskKind::Gains:
      return setGains(ask.k_N_per_m, ask.k_Nm_per_rad);
    case AskKind::Load:
      return load(text);
    case AskKind::Again:
      return again();
    case AskKind::Record:
      return record(sender, text, ask.wants_file);
    case AskKind::Fetch:
      break;
  }
  return {};
}

RequestHandler::Answer RequestHandler::who() const {
  const ServedRun::Facts facts = run_.facts();
  const int step = requests_.step();
  const std::size_t count = facts.parts.size();
  std::string words = "render: ";
  if (!facts.is_running) {
    words += "no run";
  } else {
    words += quoted(facts.name) + " (scene " + facts.hash + ")";
    if (requests_.phase() == RunPhase::Preparing || step < 0)
      words += ", before its first step";
    else if (static_cast<std::size_t>(step) < count)
      words += ", step " + std::to_string(step + 1) + " of " + std::to_string(count) + ": " +
               quoted(facts.parts[static_cast<std::size_t>(step)]) +
               (requests_.phase() == RunPhase::InHand ? " is in hand" : " was let go of");
    if (requests_.isWaiting()) words += requests_.mayTake() ? "" : "; parts are taken on request";
    if (!facts.recording.empty()) words += "; recorded in " + facts.recording;
  }
  words += "\ndevice: ";
  if (!facts.has_device)
    words += facts.is_running ? "none, the run waits for a device" : "none";
  else
    words += (facts.device.empty() ? "joining" : quoted(facts.device) + ", " + gainsInWords(gainsOf(facts))) +
             (requests_.isFaulted() ? "; safe state after a fault, without force" : "");
  words += "\nwatchers: " + std::to_string(facts.watchers);
  return {true, words, false};
}

/// The current gains; requested gains apply from the step after the request on.
CouplingGains RequestHandler::gainsOf(const ServedRun::Facts& facts) const {
  return gains_ && requests_.step() > gains_step_ ? *gains_ : facts.gains;
}

RequestHandler::Answer RequestHandler::take(const std::string& part) {
  if (!requests_.isWaiting())
    return {false, "refused: this run takes its parts automatically; start vps render with --on-request",
            false};
  const ServedRun::Facts facts = run_.facts();
  const bool has_begun = requests_.phase() != RunPhase::Preparing;
  const auto next = static_cast<std::size_t>(has_begun ? requests_.step() + 1 : 0);
  if (!facts.is_running || next >= facts.parts.size())
    return {false, "refused: there is no further part to take", false};
  if (requests_.phase() == RunPhase::InHand)
    return {false, "refused: the hand has " + quoted(facts.parts[next - 1]), false};
  if (!part.empty() && part != facts.parts[next])
    return {false, "refused: the next part is " + quoted(facts.parts[next]), false};
  requests_.take();
  return {true, quoted(facts.parts[next]) + " is taken next", false};
}

RequestHandler::Answer RequestHandler::release() {
  const ServedRun::Facts facts = run_.facts();
  const auto step =
      static_cast<std::size_t>(requests_.step());  // -1 (no step) becomes larger than all indices
  if (!facts.is_running || requests_.phase() != RunPhase::InHand || step >= facts.parts.size())
    return {false, "refused: nothing is in hand", false};
  requests_.release();
  return {true, "the hand lets go of " + quoted(facts.parts[step]), false};
}

RequestHandler::Answer RequestHandler::rearm() {
  const ServedRun::Facts facts = run_.facts();
  if (!facts.has_device || facts.device.empty()) return {false, "refused: no device has joined", false};
  if (!facts.may_rearm)
    return {false, "refused: the person at the device has not allowed re-arming (vps device --auto-rearm)",
            false};
  if (!requests_.isFaulted()) return {false, "refused: the device has no fault", false};
  requests_.rearm();
  return {true, "the device is re-armed", false};
}

RequestHandler::Answer RequestHandler::setGains(double k_N_per_m, double k_Nm_per_rad) {
  const ServedRun::Facts facts = run_.facts();
  if (!facts.is_running || facts.device.empty())
    return {false, "refused: no device has joined, so the limits of the gains are unknown", false};
  if (!facts.recording.empty())
    return {false, "refused: the gains of a recorded run cannot be changed", false};
  CouplingGains wish = facts.most;
  wish.k_N_per_m = k_N_per_m;
  wish.k_Nm_per_rad = k_Nm_per_rad > 0 ? k_Nm_per_rad : gainsOf(facts).k_Nm_per_rad;
  const CouplingGains gains = device::softerOf(wish, facts.most);
  if (!device::areUsable(gains))
    return {false, "refused: " + gainsInWords(wish) + " are too low to hold a part", false};
  requests_.setGains(gains);
  gains_ = gains;
  gains_step_ = requests_.step();
  const bool is_bounded = gains.k_N_per_m < wish.k_N_per_m || gains.k_Nm_per_rad < wish.k_Nm_per_rad;
  return {true,
          "from the next part on the coupling has " + gainsInWords(gains) +
              (is_bounded ? ", the limit at which this device is passive" : ""),
          false};
}

std::string RequestHandler::fileOf(const std::string& hash) const {
  return options_.scenes.empty() ? "" : options_.scenes + "/" + hash + kSceneEnding;
}

RequestHandler::Answer RequestHandler::load(const std::string& hash) {
  if (!isSceneHash(hash)) return {false, "refused: name a scene by the 32 digits of its hash", false};
  const ServedRun::Facts facts = run_.facts(true);
  if (facts.hash == hash) return begin(facts.bytes);
  if (const std::string file = fileOf(hash); !file.empty())
    if (const std::string bytes = readAll(file); contentHash(bytes) == hash) return begin(bytes);
  return {false, "the scene " + hash + " is unknown to this vps render; give its file, which is then sent",
          true};
}

RequestHandler::Answer RequestHandler::addPiece(std::uint64_t sender, const PieceMessage& piece) {
  if (options_.rights != RequestRights::All) return {false, "refused: this session accepts no scenes", false};
  const std::string hash = textOf(piece.hash);
  if (!isSceneHash(hash) || piece.total == 0 || piece.total > kMostScene || piece.size > PieceMessage::kMost)
    return {false, "refused: the piece of the scene is invalid", false};
  if (piece.offset == 0) transfer_ = {sender, hash, {}, piece.total, 0};
  Transfer& now = transfer_;
  if (now.sender != sender || now.hash != hash || now.total != piece.total ||
      now.bytes.size() != piece.offset || piece.size > now.total - piece.offset)
    return {false, "refused: another scene was sent in the meantime; try again", false};
  now.bytes.append(piece.bytes.data(), piece.size);
  now.heard_s = device::monotonicSeconds();
  if (now.bytes.size() < now.total) return {true, "more", true};
  const std::string bytes = std::exchange(transfer_, {}).bytes;
  if (contentHash(bytes) != hash)
    return {false, "refused: the scene was damaged in transfer; try again", false};
  const Answer answer = begin(bytes);
  if (answer.is_done) keep(hash, bytes);
  return answer;
}

void RequestHandler::dropLostTransfer(double now_s) {
  if (!transfer_.bytes.empty() && now_s - transfer_.heard_s > kTransferLimit_s) transfer_ = {};
}

void RequestHandler::keep(const std::string& hash, const std::string& bytes) const {
  namespace fs = std::filesystem;
  if (options_.scenes.empty()) return;
  try {
    fs::create_directories(options_.scenes);
    writeWholeFile(fileOf(hash), bytes);
    std::vector<fs::directory_entry> kept;
    for (const fs::directory_entry& entry : fs::directory_iterator(options_.scenes))
      if (entry.path().extension() == kSceneEnding) kept.push_back(entry);
    std::sort(kept.begin(), kept.end(), [](const fs::directory_entry& a, const fs::directory_entry& b) {
      return a.last_write_time() > b.last_write_time();
    });
    for (std::size_t i = kMostKept; i < kept.size(); ++i) fs::remove(kept[i]);
  } catch (const std::exception& failed) {  // the scene runs anyway
    if (options_.say) options_.say(std::string("the received scene could not be stored: ") + failed.what());
  }
}

RequestHandler::Answer RequestHandler::begin(const std::string& bytes) {
  try {
    Scene scene = sceneFromBytes(bytes, "the requested scene");
    requireSteps(scene);
    const std::string name = scene.name;
    gains_.reset();
    next_ = std::move(scene);
    return {true, (run_.facts().is_running ? "this run ends, and " : "") + quoted(name) + " begins", false};
  } catch (const std::exception& bad) {
    return {false, std::string("refused: ") + bad.what(), false};
  }
}

RequestHandler::Answer RequestHandler::again() {
  const ServedRun::Facts facts = run_.facts(true);
  if (facts.bytes.empty()) return {false, "refused: there was no run so far", false};
  return begin(facts.bytes);
}

RequestHandler::Answer RequestHandler::record(std::uint64_t sender, const std::string& name,
                                              bool wants_file) {
  const ServedRun::Facts facts = run_.facts();
  if (name.empty()) {
    recording_.clear();
    return {
        true,
        std::string("no further run is recorded") +
            (!facts.is_running || facts.recording.empty() ? "" : "; the current recording ends with its run"),
        false};
  }
  if (!isRecordingName(name))
    return {false,
            "refused: give a file name such as run_1.mcap, without a folder; vps render chooses the folder",
            false};
  constexpr const char* kCrowd = "refused: too many requesters wait for recordings";
  if (wants_file && facts.is_running && !facts.recording.empty()) {
    if (!addFetcher(sender, facts.recording, facts.number)) return {false, kCrowd, false};
    return {
        true,
        "this run is recorded in " + facts.recording + " already; the file is sent when the run has ended",
        false};
  }
  const std::string folder = options_.recordings.empty() ? "." : options_.recordings;
  if (access(folder.c_str(), W_OK) != 0)
    return {false, "refused: vps render cannot write to its folder for recordings", false};
  const bool is_late = facts.is_running && facts.has_begun;
  const bool is_next = !facts.is_running || is_late;
  if (wants_file && !addFetcher(sender, "", facts.number + (is_next ? 1 : 0))) return {false, kCrowd, false};
  recording_ = (std::filesystem::path(folder) / name).string();
  const char* which = is_next ? "the next run is recorded in " : "this run is recorded in ";
  return {true, which + unusedFile(recording_) + (is_late ? "; `vps ask again` starts that run" : ""), false};
}

bool RequestHandler::addFetcher(std::uint64_t sender, const std::string& file, std::uint64_t wanted) {
  const double now_s = device::monotonicSeconds();
  std::erase_if(fetchers_,
                [now_s](const auto& entry) { return now_s - entry.second.heard_s > kFetchLimit_s; });
  if (fetchers_.size() >= kMostFetchers && !fetchers_.contains(sender)) return false;
  fetchers_[sender] = {file, "", now_s, wanted};
  return true;
}

bool RequestHandler::isFetched(double now_s) const {
  return std::any_of(fetchers_.begin(), fetchers_.end(), [now_s](const auto& entry) {
    return !entry.second.file.empty() && now_s - entry.second.heard_s < kFetchLimit_s;
  });
}

std::string_view RequestHandler::fetch(const Envelope& envelope, std::uint64_t offset, Answer& words) {
  const auto found = fetchers_.find(envelope.sender);
  if (found == fetchers_.end()) {
    words = {false, "refused: no recording was requested, or too long ago", false};
    return {};
  }
  Fetcher& fetcher = found->second;
  fetcher.heard_s = device::monotonicSeconds();
  if (fetcher.file.empty()) {
    const ServedRun::Facts facts = run_.facts();
    if (facts.has_begun && facts.number >= fetcher.wanted) fetcher.file = facts.recording;
  }
  words = {true, "the run has not ended", false};
  if (fetcher.file.empty()) return {};
  const ServedRun::Recorded state = run_.stateOf(fetcher.file);
  if (state == ServedRun::Recorded::Growing) return {};
  FetchedMessage message{envelope.sender, envelope.number, {}};
  PieceMessage& piece = message.piece;
  std::ifstream in(fetcher.file, std::ios::binary | std::ios::ate);
  if (state == ServedRun::Recorded::Failed || !in) {
    words = {false, "the run was stopped before its end, so there is no recording", false};
    fetchers_.erase(found);
    return {};
  }
  piece.total = static_cast<std::uint64_t>(in.tellg());
  if (offset >= piece.total) {
    words = {true, "sent", false};
    fetchers_.erase(found);
    return {};
  }
  if (fetcher.hash.empty()) fetcher.hash = contentHash(readAll(fetcher.file));
  std::memcpy(piece.hash.data(), fetcher.hash.data(), fetcher.hash.size());
  piece.offset = offset;
  piece.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(PieceMessage::kMost, piece.total - offset));
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(piece.bytes.data(), piece.size);
  return writer_.write(message);
}

}  // namespace vps::scenes

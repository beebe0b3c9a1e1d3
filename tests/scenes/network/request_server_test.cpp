// SPDX-License-Identifier: BSD-3-Clause
// Requests to a running render node. tests/program/ask_test.cpp tests the same with the program.
#include "vps_scenes/network/request_server.h"
#include "scenes/session_name.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <thread>

#include "record/scene_archive.h"
#include "requests/request_server_work.h"
#include "scenes/two_pins.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"
#include "vps_device/recording.h"
#include "vps_scenes/network/session_recording.h"
#include "vps_scenes/network/session_request.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

/// A request handler for two pins, without sockets and without a run.
class RequestHandlerTest : public testing::Test {
 protected:
  void SetUp() override { begin(); }
  void begin(const std::string& recording = "") {
    scene_ = twoPins();
    scene_.name = "two pins";
    bytes_ = sceneToBytes(scene_);
    run_.begin(scene_, bytes_, *link_, recording);
  }
  void joinDevice(bool may_rearm = true) {
    run_.setDevice("arm", may_rearm, gains(800, 8), gains(1000, 10));
    if (device_ == nullptr) device_ = joinSession(session_, NodeRole::Device);
  }
  static CouplingGains gains(double k_N_per_m, double k_Nm_per_rad) {
    CouplingGains gains;
    gains.k_N_per_m = k_N_per_m;
    gains.k_Nm_per_rad = k_Nm_per_rad;
    gains.b_Ns_per_m = gains.b_Nms_per_rad = 1;
    gains.max_force_N = gains.max_torque_Nm = 10;
    return gains;
  }
  static AskMessage message(AskKind kind, const std::string& text = "") {
    AskMessage ask;
    ask.kind = kind;
    std::copy(text.begin(), text.end(), ask.text.begin());
    return ask;
  }
  AnswerMessage answerTo(const std::string& bytes, bool is_stranger = false) {
    AnswerMessage answer;
    MessageReader reader;
    answered_ = handler_.answer({1, bytes, is_stranger});
    EXPECT_EQ(reader.read(answered_, answer), Reading::Good);
    return answer;
  }
  AnswerMessage ask(AskKind kind, const std::string& text = "") {
    return answerTo(std::string(asker_.write(message(kind, text))));
  }
  AnswerMessage askGains(double k_N_per_m) {
    AskMessage ask = message(AskKind::Gains);
    ask.k_N_per_m = k_N_per_m;
    return answerTo(std::string(asker_.write(ask)));
  }
  AnswerMessage askForFile(const std::string& name) {
    AskMessage wish = message(AskKind::Record, name);
    wish.wants_file = true;
    return answerTo(std::string(asker_.write(wish)));
  }
  /// The first piece of the requested recording.
  std::string fetchedBytes() {
    const auto fetched = std::make_unique<FetchedMessage>();
    answered_ = handler_.answer({1, std::string(asker_.write(message(AskKind::Fetch))), false});
    EXPECT_EQ(MessageReader().read(answered_, *fetched), Reading::Good);
    return {fetched->piece.bytes.data(), fetched->piece.size};
  }
  static bool says(const AnswerMessage& answer, const std::string& words) {
    return std::string(answer.text.data()).find(words) != std::string::npos;
  }

  std::string session_ = sessionName("requests"), bytes_, answered_;
  std::unique_ptr<Link> link_ = makeSession(session_, "a scene"), device_;
  Scene scene_;
  RequestServerOptions options_;
  RunRequests requests_;
  ServedRun run_;
  RequestHandler handler_{options_, requests_, run_};
  MessageWriter asker_{newSender()};
};

TEST_F(RequestHandlerTest, WhoTellsSceneStepDeviceAndWatchers) {
  EXPECT_TRUE(says(ask(AskKind::Who), "'two pins' (scene " + contentHash(bytes_) + "), before its first"));
  EXPECT_TRUE(says(ask(AskKind::Who), "device: none, the run waits for a device"));
  joinDevice();
  requests_.beginStep(1);
  const std::unique_ptr<Link> watcher = joinSession(session_, NodeRole::Watch);
  const AnswerMessage answer = ask(AskKind::Who);
  EXPECT_TRUE(answer.is_done);
  EXPECT_TRUE(says(answer, "step 2 of 2: 'right' is in hand")) << answer.text.data();
  EXPECT_TRUE(says(answer, "'arm', 800 N/m and 8.0 N m/rad")) << answer.text.data();
  EXPECT_TRUE(says(answer, "watchers: 1")) << answer.text.data();
}

TEST_F(RequestHandlerTest, AnAnswerNamesWhomItIsForAndARequestThatIsRepeatedIsCarriedOutOnce) {
  requests_.beginStep(0);
  const std::string bytes(asker_.write(message(AskKind::Release)));
  const AnswerMessage answer = answerTo(bytes);
  EXPECT_EQ(answer.asker, asker_.sender());
  EXPECT_EQ(answer.number, 1u);
  EXPECT_TRUE(requests_.isReleaseWanted());
  requests_.beginStep(1);  // clears the request
  EXPECT_EQ(answerTo(bytes).number, 1u);
  EXPECT_FALSE(requests_.isReleaseWanted());
}

TEST_F(RequestHandlerTest, PartsAreTakenInTheirOrderOnly) {
  EXPECT_TRUE(says(ask(AskKind::Take), "takes its parts automatically"));
  requests_.setWaiting(true);
  EXPECT_FALSE(requests_.mayTake());
  EXPECT_TRUE(says(ask(AskKind::Take, "right"), "the next part is 'left'"));
  EXPECT_FALSE(requests_.mayTake());
  EXPECT_TRUE(ask(AskKind::Take, "left").is_done);
  EXPECT_TRUE(requests_.mayTake());
  requests_.beginStep(0);
  EXPECT_FALSE(requests_.mayTake());
  EXPECT_TRUE(says(ask(AskKind::Take), "the hand has 'left'"));
  requests_.endWork();
  EXPECT_TRUE(says(ask(AskKind::Take), "'right' is taken next"));
  requests_.beginStep(1);
  requests_.endWork();
  EXPECT_TRUE(says(ask(AskKind::Take), "no further part"));
}

TEST_F(RequestHandlerTest, NothingIsReleasedThatIsNotInHand) {
  EXPECT_TRUE(says(ask(AskKind::Release), "nothing is in hand"));
  requests_.beginStep(0);
  requests_.endWork();
  EXPECT_FALSE(ask(AskKind::Release).is_done);
  EXPECT_FALSE(requests_.isReleaseWanted());
  requests_.beginStep(1);
  run_.end();  // the run stopped while a part was in hand
  EXPECT_TRUE(says(ask(AskKind::Release), "nothing is in hand"));
  EXPECT_TRUE(says(askGains(500), "no device has joined"));
}

// The system lists the watchers' locks in the order in which they joined, and not by process number.
TEST_F(RequestHandlerTest, WatchersAreCountedWhateverTheirOrder) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  const pid_t child = fork();  // has a higher number than this process, and joins first
  if (child == 0) {
    const std::unique_ptr<Link> watcher = joinSession(session_, NodeRole::Watch);
    (void)!write(pipe_ends[1], "w", 1);
    pause();
    _exit(0);
  }
  char byte = 0;
  ASSERT_EQ(read(pipe_ends[0], &byte, 1), 1);
  const std::unique_ptr<Link> watcher = joinSession(session_, NodeRole::Watch);
  EXPECT_TRUE(says(ask(AskKind::Who), "watchers: 2")) << answered_;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(says(ask(AskKind::Who), "watchers: 1"));
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_F(RequestHandlerTest, OnlyADeviceThatAllowsItIsRearmedFromElsewhere) {
  EXPECT_TRUE(says(ask(AskKind::Rearm), "no device has joined"));
  joinDevice(false);
  requests_.setFaulted(true);
  EXPECT_TRUE(says(ask(AskKind::Rearm), "the person at the device has not allowed"));
  EXPECT_FALSE(requests_.takeRearm());
  run_.setDevice("arm", true, gains(800, 8), gains(1000, 10));
  EXPECT_TRUE(ask(AskKind::Rearm).is_done);
  EXPECT_TRUE(requests_.takeRearm());
  requests_.setFaulted(false);
  EXPECT_TRUE(says(ask(AskKind::Rearm), "has no fault"));
}

TEST_F(RequestHandlerTest, GainsAreBoundedByWhatIsPassive) {
  EXPECT_TRUE(says(askGains(500), "no device has joined"));
  joinDevice();
  EXPECT_TRUE(askGains(500).is_done);
  EXPECT_EQ(requests_.takeGains()->k_N_per_m, 500);
  EXPECT_TRUE(says(askGains(5000), "1000 N/m and 8.0 N m/rad, the limit at which"));
  EXPECT_EQ(requests_.takeGains()->k_N_per_m, 1000);
  begin("run.mcap");
  joinDevice();
  EXPECT_TRUE(says(askGains(500), "the gains of a recorded run"));
  EXPECT_FALSE(requests_.takeGains());
}

TEST_F(RequestHandlerTest, RightsAreHeld) {
  options_.rights = RequestRights::Look;
  requests_.beginStep(0);
  EXPECT_TRUE(ask(AskKind::Who).is_done);
  for (const AskKind kind : {AskKind::Take, AskKind::Release, AskKind::Rearm, AskKind::Load, AskKind::Again})
    EXPECT_TRUE(says(ask(kind), "only `who` is allowed here"));
  PieceMessage piece;
  EXPECT_TRUE(says(answerTo(std::string(asker_.write(piece))), "accepts no scenes"));
  options_.rights = RequestRights::All;
  EXPECT_TRUE(says(answerTo(std::string(asker_.write(message(AskKind::Release))), true), "to another user"));
  EXPECT_FALSE(requests_.isReleaseWanted());
  EXPECT_FALSE(handler_.takeNext());
}

TEST_F(RequestHandlerTest, RecordingsGoToTheFolderOfTheRenderNodeOnly) {
  const test::TemporaryFolder folder;
  options_.recordings = folder.path();
  for (const char* name : {"../run.mcap", "/tmp/run.mcap", "run", ".mcap", ".a.mcap", "a b.mcap"})
    EXPECT_FALSE(ask(AskKind::Record, name).is_done) << name;
  EXPECT_TRUE(ask(AskKind::Record, "run_1.mcap").is_done);
  EXPECT_EQ(handler_.recording(), (folder.path() / "run_1.mcap").string());
  EXPECT_EQ(unusedFile(handler_.recording()), handler_.recording());
  std::ofstream(handler_.recording()) << "an earlier run";
  EXPECT_EQ(unusedFile(handler_.recording()), (folder.path() / "run_1-2.mcap").string());
  EXPECT_TRUE(ask(AskKind::Record).is_done);
  EXPECT_EQ(handler_.recording(), "");
}

TEST_F(RequestHandlerTest, ARecordingIsFetchedInPiecesOnceItIsWhole) {
  const test::TemporaryFolder folder;
  options_.recordings = folder.path();
  const auto fetch = [this](std::uint64_t offset) {
    AskMessage ask = message(AskKind::Fetch);
    ask.offset = offset;
    return std::string(asker_.write(ask));
  };
  const auto piece = [this, &fetch](std::uint64_t offset) {
    auto fetched = std::make_unique<FetchedMessage>();
    answered_ = handler_.answer({1, fetch(offset), false});
    EXPECT_EQ(MessageReader().read(answered_, *fetched), Reading::Good);
    EXPECT_EQ(fetched->asker, asker_.sender());
    return fetched;
  };
  EXPECT_TRUE(says(answerTo(fetch(0)), "no recording was requested"));
  EXPECT_TRUE(says(askForFile("run.mcap"), "this run is recorded in"));
  EXPECT_TRUE(says(answerTo(fetch(0)), "has not ended"));
  const std::string file = handler_.recording();
  run_.beginRecording(file);
  EXPECT_TRUE(says(answerTo(fetch(0)), "has not ended"));
  EXPECT_TRUE(handler_.isFetched(device::monotonicSeconds()));
  EXPECT_FALSE(handler_.isFetched(device::monotonicSeconds() + 10));
  std::string whole(PieceMessage::kMost + 100, 'a');
  whole.back() = 'b';
  std::ofstream(file) << whole;
  run_.finishRecording();
  const auto first = piece(0), last = piece(PieceMessage::kMost);
  EXPECT_EQ(first->piece.size, PieceMessage::kMost);
  EXPECT_EQ(last->piece.size, 100u);
  EXPECT_EQ(last->piece.bytes[99], 'b');
  EXPECT_EQ(last->piece.total, whole.size());
  EXPECT_EQ(std::string(last->piece.hash.data()), contentHash(whole));
  EXPECT_TRUE(says(answerTo(fetch(whole.size())), "sent"));
  EXPECT_FALSE(handler_.isFetched(device::monotonicSeconds()));
}

TEST_F(RequestHandlerTest, ARunThatHasBegunIsRecordedNoLongerAndAStoppedOneHasNoRecording) {
  const test::TemporaryFolder folder;
  options_.recordings = folder.path();
  run_.beginRecording("");
  EXPECT_TRUE(says(ask(AskKind::Record, "run.mcap"), "the next run is recorded in"));
  run_.beginRecording(handler_.recording());
  EXPECT_TRUE(says(askForFile("other.mcap"), "run.mcap already"));
  run_.end();
  EXPECT_TRUE(says(ask(AskKind::Fetch), "was stopped before its end"));
  const AnswerMessage between = ask(AskKind::Record, "third.mcap");
  EXPECT_TRUE(says(between, "the next run is recorded in"));
  EXPECT_FALSE(says(between, "again"));
}

// A request between two runs is possible with vps render --stay.
TEST_F(RequestHandlerTest, WhoAsksBetweenTwoRunsReceivesTheRecordingOfTheNextOne) {
  const test::TemporaryFolder folder;
  options_.recordings = folder.path();
  const std::string first = folder.path() / "first.mcap", second = folder.path() / "second.mcap";
  run_.beginRecording(first);
  std::ofstream(first) << "first";
  run_.finishRecording();
  run_.end();
  EXPECT_TRUE(says(askForFile("second.mcap"), "the next run is recorded in"));
  EXPECT_TRUE(says(ask(AskKind::Fetch), "has not ended"));
  EXPECT_FALSE(handler_.isFetched(device::monotonicSeconds()));  // the requester has no file yet
  begin();
  EXPECT_TRUE(says(ask(AskKind::Fetch), "has not ended"));
  run_.beginRecording(second);
  std::ofstream(second) << "second";
  run_.finishRecording();
  run_.end();
  EXPECT_EQ(fetchedBytes(), "second");
}

// `vps ask load` ends a run that still waits for its device.
TEST_F(RequestHandlerTest, ARunThatEndsBeforeItsRecordingBeginsHasNone) {
  begin("run.mcap");
  EXPECT_TRUE(says(askForFile("other.mcap"), "run.mcap already"));
  EXPECT_TRUE(says(ask(AskKind::Fetch), "has not ended"));
  run_.end();
  EXPECT_TRUE(says(ask(AskKind::Fetch), "was stopped before its end"));
  EXPECT_EQ(run_.stateOf("unknown.mcap"), ServedRun::Recorded::Failed);
  begin("run.mcap");  // the name is still free
  EXPECT_TRUE(says(askForFile("other.mcap"), "run.mcap already"));
  EXPECT_TRUE(says(ask(AskKind::Fetch), "has not ended"));
}

TEST_F(RequestHandlerTest, ASceneIsSentInPiecesOnceAndThenKnownByItsHash) {
  const test::TemporaryFolder folder;
  options_.scenes = folder.path() / "scenes";
  Scene other = twoPins();
  other.name = "other pins";
  other.parts[0].part.mesh = makeSphere(10e-3, 5);  // its archive has several pieces
  const std::string bytes = sceneToBytes(other), hash = contentHash(bytes);
  ASSERT_GT(bytes.size(), 2 * PieceMessage::kMost);
  EXPECT_TRUE(ask(AskKind::Load, hash).wants_scene);
  EXPECT_FALSE(ask(AskKind::Load, "../../etc/passwd").wants_scene);
  const auto send = [&](std::uint64_t offset, const std::string& from) {
    PieceMessage piece;
    std::copy(hash.begin(), hash.end(), piece.hash.begin());
    piece.total = from.size();
    piece.offset = offset;
    piece.size = static_cast<std::uint32_t>(std::min<std::size_t>(PieceMessage::kMost, from.size() - offset));
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(offset), piece.size, piece.bytes.begin());
    return answerTo(std::string(asker_.write(piece)));
  };
  EXPECT_TRUE(says(send(PieceMessage::kMost, bytes),
                   "another scene was sent"));  // the transfer does not start at offset 0
  std::string damaged = bytes;
  damaged[100] ^= 1;
  AnswerMessage last;
  for (std::uint64_t at = 0; at < bytes.size(); at += PieceMessage::kMost) last = send(at, damaged);
  EXPECT_TRUE(says(last, "was damaged in transfer"));
  EXPECT_FALSE(handler_.takeNext());
  for (std::uint64_t at = 0; at < bytes.size(); at += PieceMessage::kMost) last = send(at, bytes);
  EXPECT_TRUE(last.is_done) << last.text.data();
  ASSERT_TRUE(handler_.takeNext());
  EXPECT_TRUE(ask(AskKind::Load, hash).is_done);
  EXPECT_EQ(handler_.takeNext()->name, "other pins");
}

// A sender that is killed during a transfer leaves an incomplete scene, which is dropped after 10 s without a
// message.
TEST_F(RequestHandlerTest, ASceneWhoseSenderIsGoneIsForgotten) {
  Scene other = twoPins();
  other.parts[0].part.mesh = makeSphere(10e-3, 5);  // its archive has several pieces
  const std::string bytes = sceneToBytes(other), hash = contentHash(bytes);
  const auto send = [&](std::uint64_t offset) {
    PieceMessage piece;
    std::copy(hash.begin(), hash.end(), piece.hash.begin());
    piece.total = bytes.size();
    piece.offset = offset;
    piece.size = PieceMessage::kMost;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), piece.size, piece.bytes.begin());
    return answerTo(std::string(asker_.write(piece)));
  };
  ASSERT_GT(bytes.size(), 3 * PieceMessage::kMost);
  EXPECT_TRUE(send(0).is_done);
  const double sent_s = device::monotonicSeconds();
  handler_.dropLostTransfer(sent_s + 9.5);
  EXPECT_TRUE(send(PieceMessage::kMost).is_done);
  handler_.dropLostTransfer(device::monotonicSeconds() + 10.1);
  EXPECT_TRUE(says(send(2 * PieceMessage::kMost), "another scene was sent"));
}

TEST_F(RequestHandlerTest, ASceneThatCannotRunEndsNoRun) {
  Scene empty = twoPins();
  empty.steps.clear();
  const std::string bytes = sceneToBytes(empty);
  run_.begin(empty, bytes, *link_, "");
  EXPECT_TRUE(says(ask(AskKind::Again), "has no [[step]]"));
  EXPECT_FALSE(handler_.takeNext());
}

TEST_F(RequestHandlerTest, ALongAnswerEndsBetweenTwoCharacters) {
  for (const char* shift : {"", "x", "xx"}) {
    scene_.name = shift;
    for (int i = 0; i < 500; ++i) scene_.name += "\u20ac";  // three bytes each
    run_.begin(scene_, bytes_, *link_, "");
    const AnswerMessage answer = ask(AskKind::Who);
    const std::string words = answer.text.data();
    EXPECT_GT(words.size(), answer.text.size() - 5);
    EXPECT_EQ(words.substr(words.size() - 3), "\u20ac");
  }
}

TEST_F(RequestHandlerTest, WhatCannotBeReadIsRefusedAndSaidOnce) {
  std::vector<std::string> said;
  options_.say = [&said](const std::string& words) { said.push_back(words); };
  std::string bytes(asker_.write(message(AskKind::Release)));
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_EQ(handler_.answer({1, bytes.substr(0, i), false}), "");
  EXPECT_EQ(said.size(), 1u);
  bytes[2] ^= 1;  // changes the version
  AnswerMessage answer;
  MessageReader reader;
  EXPECT_EQ(reader.read(std::string(handler_.answer({1, bytes, false})), answer), Reading::Good);
  EXPECT_TRUE(says(answer, "another version"));
}

/// A render node with its server, and a device, each on a thread.
class RequestServerTest : public testing::Test {
 protected:
  void start(const std::string& file = "", bool waits = false) {
    RequestServerOptions options;
    options.session = session_;
    options.waits = waits;
    options.stop = &stop_;
    options.recordings = recordings_;
    server_.emplace(options);
    render_ = std::thread([this, file] {
      Scene scene = twoPins();
      RenderOptions render;
      render.session = session_;
      render.server = &*server_;
      render.stop = server_->endsRun();
      result_ = renderNode(scene, render, file);
      is_over_ = true;
    });
    device_ = std::thread([this] {
      deviceNode({session_, "", &stop_, {}, false, false, "", nullptr, before_hello_});
    });
  }
  void TearDown() override {
    stop_ = true;
    join();
  }
  void join() {
    if (render_.joinable()) render_.join();
    if (device_.joinable()) device_.join();
  }
  bool waitFor(const std::function<bool()>& isSo) const {
    for (int i = 0; i < 3000 && !isSo(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return isSo();
  }
  [[nodiscard]] RunRequests& requests() { return server_->work().requests; }

  std::string session_ = sessionName("requests"), recordings_;
  std::function<void()> before_hello_;
  std::atomic<bool> stop_{false}, is_over_{false};
  std::optional<RequestServer> server_;
  AssembleResult result_;
  std::thread render_, device_;
  SessionRequest request_{session_};
};

TEST_F(RequestServerTest, APartThatIsReleasedEndsItsStepAndTheRunReplaysBitForBit) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  start(file);
  ASSERT_TRUE(waitFor([&] { return requests().phase() == RunPhase::InHand; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // gives the hand time to work
  ASSERT_EQ(requests().step(), 0);
  EXPECT_TRUE(request_.release().is_done);
  join();
  ASSERT_EQ(result_.steps.size(), 2u);
  EXPECT_FALSE(result_.steps[0].completed);
  EXPECT_NE(result_.steps[0].failure_reason.find("released on request"), std::string::npos)
      << result_.steps[0].failure_reason;
  const device::RecordedRun run = device::loadRecording(file);
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
}

TEST_F(RequestServerTest, ADeviceHasItsRunRecordedAndReceivesTheFile) {
  const test::TemporaryFolder folder;
  recordings_ = folder.path();
  std::optional<SessionRecording> recording;
  const std::string file = folder.path() / "mine.mcap";
  before_hello_ = [&] {
    recording.emplace(SessionRecordingOptions{session_, "", file, "", &stop_, {}});
    EXPECT_EQ(recording->waitUntilAsked(10), "");
  };
  start();
  join();
  EXPECT_EQ(recording->finish(), "");
  const device::RecordedRun run = device::loadRecording(file);
  const ReplayResult replayed = replay(run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, run.entries.size());
  EXPECT_GT(replayed.equal, result_.haptic.count);
}

TEST_F(RequestServerTest, APartWaitsUntilItIsAskedForAndGainsComeWithIt) {
  const test::TemporaryFolder folder;
  start("", true);
  ASSERT_TRUE(waitFor([&] {
    return request_.who().words.find("parts are taken on request") != std::string::npos &&
           request_.who().words.find("N/m") != std::string::npos;
  }));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(requests().phase(), RunPhase::Preparing);
  EXPECT_TRUE(request_.take("left").is_done);
  ASSERT_TRUE(waitFor([&] { return requests().phase() == RunPhase::Settling; }));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_EQ(requests().step(), 0);
  EXPECT_FALSE(is_over_);
  EXPECT_TRUE(request_.setGains(500).is_done);
  EXPECT_TRUE(request_.take().is_done);
  join();
  EXPECT_EQ(result_.steps.size(),
            2u);                         // on a busy machine the hand may not have had enough time
  EXPECT_FALSE(requests().takeGains());  // the run has taken the gains
}

TEST_F(RequestServerTest, AnotherSceneEndsTheRunAndIsNext) {
  start();
  ASSERT_TRUE(waitFor([&] { return requests().phase() == RunPhase::InHand; }));
  Scene other = twoPins();
  other.name = "other pins";
  EXPECT_TRUE(request_.load(other).is_done);
  render_.join();
  const std::optional<Scene> next = server_->takeNext();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->name, "other pins");
  EXPECT_FALSE(server_->endsRun()->load());
}

TEST(SessionRequest, WhereNobodyAnswersThatIsSaid) {
  EXPECT_THROW((void)SessionRequest(sessionName("requests")).who(), LoadError);
  EXPECT_THROW(SessionRequest("a/b"), LoadError);
  RequestServerOptions options;
  options.session = sessionName("requests");
  const RequestServer server(options);
  EXPECT_THROW(RequestServer second(options), LoadError);
  EXPECT_NE(SessionRequest(options.session).who().words.find("no run"), std::string::npos);
}

TEST(SessionRequest, AWishForARecordingThatIsNotGrantedSaysWhy) {
  const test::TemporaryFolder folder;
  RequestServerOptions options;
  options.session = sessionName("requests");
  options.rights = RequestRights::Look;
  const std::string file = folder.path() / "run.mcap";
  const SessionRecordingOptions wish{options.session, "", file, "", nullptr, {}};
  SessionRecording early(wish);
  const auto names = [](const std::string& words, const char* part) {
    return words.find(part) != std::string::npos;
  };
  EXPECT_PRED2(names, early.waitUntilAsked(0.3), "no vps render that accepts requests runs this session");
  EXPECT_PRED2(names, early.finish(), "no vps render that accepts requests runs this session");
  const RequestServer server(options);
  SessionRecording refused(wish);
  EXPECT_PRED2(names, refused.waitUntilAsked(10), "only `who` is allowed here");
  EXPECT_PRED2(names, refused.finish(), "only `who` is allowed here");
}

/// Two clients of a session's request socket.
class LocalRequestsTest : public testing::Test {
 protected:
  std::string session_ = sessionName("requests");
  std::unique_ptr<ServerChannel> server_ = makeLocalServer(session_);
};

TEST_F(LocalRequestsTest, WhoSendsWithoutEndKeepsNobodyOut) {
  const std::unique_ptr<ClientChannel> flood = findLocalServer(session_), other = findLocalServer(session_);
  const auto floods = [&] {
    for (int i = 0; i < 20; ++i) flood->send("flood");
  };
  floods();
  bool is_heard = false;
  for (int i = 0; i < 20 && !is_heard; ++i) {
    if (i == 5) other->send("other");
    const std::optional<IncomingRequest> ask = server_->receive(std::chrono::milliseconds(100));
    is_heard = ask && ask->bytes == "other";
    floods();
  }
  EXPECT_TRUE(is_heard);
}

// The render node may be stopped as soon as its last piece was sent.
TEST_F(LocalRequestsTest, ARecordingThatHasComeIsKeptAlthoughTheSessionHasEnded) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap", whole = "a recording", hash = contentHash(whole);
  SessionRecording recording({session_, "", file, "", nullptr, {}});
  std::uint64_t from = 0;
  const auto next = [&] {
    MessageReader reader;
    AskMessage ask;
    for (int i = 0; i < 100; ++i) {
      const std::optional<IncomingRequest> heard = server_->receive(std::chrono::milliseconds(100));
      if (!heard) continue;
      from = heard->from;
      EXPECT_EQ(reader.read(heard->bytes, ask), Reading::Good);
      return reader.envelope();
    }
    ADD_FAILURE() << "no request arrived";
    return Envelope{};
  };
  MessageWriter writer(newSender());
  const Envelope wish = next();
  server_->answer(from, writer.write(AnswerMessage{wish.sender, wish.number, true, false, {}}));
  const Envelope fetch = next();
  const auto fetched = std::make_unique<FetchedMessage>();
  fetched->asker = fetch.sender;
  fetched->number = fetch.number;
  std::copy(hash.begin(), hash.end(), fetched->piece.hash.begin());
  fetched->piece.total = whole.size();
  fetched->piece.size = static_cast<std::uint32_t>(whole.size());
  std::copy(whole.begin(), whole.end(), fetched->piece.bytes.begin());
  server_->answer(from, writer.write(*fetched));
  server_.reset();
  EXPECT_EQ(recording.finish(), "");
  std::ifstream in(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), whole);
}

TEST_F(LocalRequestsTest, WhoAsksWaitsForNoServerThatDoesNotRead) {
  const std::unique_ptr<ClientChannel> channel = findLocalServer(session_);
  const std::string bytes(kLongestAsk, 'x');
  for (int i = 0; i < 100; ++i) channel->send(bytes);  // more than the system buffers
  EXPECT_FALSE(channel->isOver());
  std::vector<std::unique_ptr<ClientChannel>> waiting;
  EXPECT_THROW(
      {
        for (int i = 0; i < 100; ++i) waiting.push_back(findLocalServer(session_));
      },
      LoadError);
}

// The test needs the right to become another user.
TEST(SessionRequest, AnotherUserOfTheMachineIsRefused) {
  if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
  RequestServerOptions options;
  options.session = sessionName("requests");
  const RequestServer server(options);
  const pid_t child = fork();
  if (child == 0) {  // the child becomes another user, without the server's thread
    if (setuid(65534) != 0) _exit(10);
    const std::unique_ptr<ClientChannel> channel = findLocalServer(options.session, 0);
    if (channel == nullptr) _exit(11);
    MessageWriter writer(newSender());
    channel->send(writer.write(AskMessage{}));
    AnswerMessage answer;
    MessageReader reader;
    const std::string bytes = channel->receive(std::chrono::seconds(5));
    if (reader.read(bytes, answer) != Reading::Good) _exit(12);
    const bool is_refused =
        !answer.is_done && std::string(answer.text.data()).find("to another user") != std::string::npos;
    _exit(is_refused ? 0 : 13);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(SessionRequest, OverANetworkTheSameIsAnswered) {
  RequestServerOptions options;
  options.session = sessionName("requests");
  options.network = "lo";
  try {
    const RequestServer server(options);
    EXPECT_NE(SessionRequest(options.session, "lo").who().words.find("no run"), std::string::npos);
    EXPECT_FALSE(SessionRequest(options.session, "lo").again().is_done);
  } catch (const LoadError& error) {
    if (std::string(error.what()).find("this build has no network") == std::string::npos) throw;
    GTEST_SKIP() << "this build has no network";
  }
}

}  // namespace
}  // namespace vps::scenes

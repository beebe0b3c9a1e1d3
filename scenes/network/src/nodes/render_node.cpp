// SPDX-License-Identifier: BSD-3-Clause
// The render node: physics, contact and procedure, with the hand in another process.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

#include "nodes/device_end.h"
#include "procedure/assembly_run.h"
#include "record/run_record.h"
#include "record/scene_archive.h"
#include "requests/request_server_work.h"
#include "vps/errors.h"
#include "vps_device/gains.h"
#include "vps_scenes/network/nodes.h"

namespace vps::scenes {

namespace {

/// Sends snapshots and news to the watchers, from the physics thread.
class Broadcast {
 public:
  Broadcast(DeviceEnd& end, const RenderOptions& options)
      : end_(end), period_s_(1 / options.picture_rate_hz) {
    tap_.give = [this](Snapshot&& snapshot) { end_.send(SnapshotMessage{std::move(snapshot)}); };
  }

  SnapshotTap* tap() { return &tap_; }
  void afterStep(double time_s) {
    time_s_ = time_s;
    if (time_s < next_s_) return;
    next_s_ = std::max(next_s_ + period_s_, time_s);
    tap_.is_wanted = true;
  }
  void tell(NewsKind kind, int step, Verdict verdict, const std::string& text) {
    NewsMessage news{kind, step, verdict, time_s_, {}};
    std::memcpy(news.text.data(), text.data(), std::min(text.size(), news.text.size() - 1));
    end_.send(news);
  }

 private:
  DeviceEnd& end_;
  SnapshotTap tap_;
  double period_s_, next_s_ = 0, time_s_ = 0;
};

std::string wordsOf(const StepResult& step) {
  return "'" + step.part + "' " + toText(step.verdict) +
         (step.reason.empty() ? std::string() : ": " + step.reason);
}

void requirePossible(const Scene& scene, const RenderOptions& options) {
  requireSteps(scene);
  if (!options.has_local_contact) return;
  throw LoadError(scene.file, "",
                  "local contact needs the parts' models in the process of the haptic loop; turn local "
                  "contact off, or use vps assemble --real-time");
}

/// Round trip from a state of the proxy to its answer. The coupling gains depend on the round trip, which is
/// also reported to the user.
double networkDelay_s(DeviceEnd& end, const RenderOptions& options) {
  if (options.network.empty()) return 0;
  constexpr int kTries = 200;
  for (int i = 0; i < kTries; ++i) {
    if (const std::optional<PeerTiming> timing = end.timing()) {
      char words[160];
      std::snprintf(words, sizeof words,
                    "the device answers within %.2f ms; its clock is %.6f s ahead, to within %.0f us",
                    1e3 * timing->round_trip_s, timing->clock_offset_s, 1e6 * timing->clock_error_s);
      end.say(words);
      return timing->round_trip_s;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  throw LoadError("", "", "no answers arrive from the device; check --network on both machines");
}

/// Registers a run with the request server, for as long as the run lasts.
class Served {
 public:
  Served(RequestServer* server, const Scene& scene, std::string scene_bytes, const Link& link,
         const std::string& file)
      : server_(server), work_(server != nullptr ? &server->work() : nullptr) {
    if (work_ == nullptr) return;
    work_->requests.beginRun();
    work_->run.begin(scene, std::move(scene_bytes), link, file);
  }
  ~Served() {
    if (work_ != nullptr) work_->run.end();
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  [[nodiscard]] RunRequests* requests() const { return work_ != nullptr ? &work_->requests : nullptr; }
  void setDevice(const HelloMessage& hello, const CouplingGains& gains, const CouplingGains& most) {
    if (work_ != nullptr) work_->run.setDevice(hello.name.data(), hello.may_rearm, gains, most);
  }
  /// The file in which the run is recorded, as requested by this user or by others.
  std::string beginRecording(const std::string& wish) const {
    if (work_ == nullptr) return wish;
    std::string file = wish.empty() ? server_->recording() : wish;
    work_->run.beginRecording(file);
    return file;
  }
  void finishRecording() const {
    if (work_ != nullptr) work_->run.finishRecording();
  }
  /// Waits until the first part may be taken. Returns false if the run was stopped.
  bool waitForTake(DeviceEnd& end) const {
    if (requests() == nullptr || requests()->mayTake()) return true;
    end.say("the run waits for a request to take the first part: vps ask take");
    while (!requests()->mayTake()) {
      if (end.isStopped()) return false;
      end.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

 private:
  RequestServer* server_;
  RequestServer::Work* work_;  ///< null: no requests are accepted
};

}  // namespace

AssembleResult renderNode(Scene& scene, const RenderOptions& given, const std::string& file) {
  requirePossible(scene, given);
  std::string scene_bytes = sceneToBytes(scene);
  const std::unique_ptr<Link> link = makeSession(given.session, scene_bytes, given.network);
  Served served(given.server, scene, std::move(scene_bytes), *link, file);
  Broadcast* broadcast = nullptr;
  const auto say = [&](const std::string& words) {
    if (given.say) given.say(words);
    if (broadcast != nullptr) broadcast->tell(NewsKind::Note, -1, Verdict::NotShown, words);
  };
  DeviceEnd end(*link, given.stop, say, served.requests());
  Broadcast all(end, given);
  broadcast = &all;

  AssembleOptions options = given;
  options.is_real_time = true;
  options.requests = served.requests();
  options.tap = all.tap();
  options.after_step = [&](double time_s) {
    all.afterStep(time_s);
    if (given.after_step) given.after_step(time_s);
  };
  options.on_step = [&](const AssembleResult& so_far) {
    all.tell(NewsKind::StepDone, static_cast<int>(so_far.steps.size()) - 1, so_far.steps.back().verdict,
             wordsOf(so_far.steps.back()));
    if (given.on_step) given.on_step(so_far);
  };
  end.say(sessionWords(given.session) + " waits for a device: vps device --session " + given.session);
  AssembleResult result;
  result.scene = scene.name;
  if (!end.waitForDevice()) return result;

  if (end.hello().is_by_person)
    for (SceneStep& step : scene.steps) step.timeout_s = std::max(step.timeout_s, kPersonTimeout_s);
  const std::unique_ptr<Hand> hand = remoteHand(end, scene);
  const double delay_s = networkDelay_s(end, given);
  device::LoopSettings settings = loopSettings(scene, hand->device(), delay_s);
  if (!device::areUsable(settings.gains))
    throw LoadError(scene.file, "",
                    "the device '" + std::string(hand->device().name()) +
                        "' reports limits that allow no usable coupling; check its node");
  if (!given.network.empty()) {
    char words[120];
    std::snprintf(words, sizeof words, "the coupling has %.0f N/m and %.1f N m/rad", settings.gains.k_N_per_m,
                  settings.gains.k_Nm_per_rad);
    end.say(words);
  }
  served.setDevice(end.hello(), settings.gains,
                   passiveGains(scene, hand->device().limits(), scene.fidelity.physics_rate_hz, delay_s));
  if (!served.waitForTake(end)) return result;
  const std::string recording = served.beginRecording(file);
  if (recording.empty()) {
    result = runProcedure(scene, *hand, nullptr, settings, options);
  } else {
    if (file.empty()) end.say("the run is recorded in " + recording);
    if (given.on_recording) given.on_recording(recording);
    end.sendExactStates();
    RunRecord record(recording, scene, hand->device(), settings, options);
    MergedLog log(record);
    result = runProcedure(scene, *remoteHand(end, scene, &log), &log, settings, options);
    if (given.stop == nullptr || !given.stop->load()) {
      record.finish();
      served.finishRecording();
    }
  }
  all.tell(NewsKind::Ended, -1, result.verdict, toText(result.verdict));
  return result;
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// vps watch: prints what happens in a session. A watcher reads only, so that it can disturb nobody.
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "command.h"
#include "run_report.h"
#include "session_option.h"
#include "table.h"
#include "terminal.h"
#include "vps_scenes/network/nodes.h"

namespace vps::viewer::inline v0 {

namespace {

struct WatchArguments {
  std::string session = kDefaultSession, network;
  double rate_hz = 1;  ///< lines a second about the part in hand; 0: none
};

constexpr std::chrono::milliseconds kWatchPoll{5};

/// What a watcher knows.
class Watching {
 public:
  Watching(scenes::SessionWatcher& watcher, double rate_hz) : watcher_(watcher), rate_hz_(rate_hz) {}

  /// Until the session is over, or the user stops.
  void run() {
    while (!stopRequested()) {
      const bool is_over = watcher_.isOver();  // first, so that the last news is read
      readAll();
      if (is_over) return;
      std::this_thread::sleep_for(kWatchPoll);
    }
  }
  /// Of the run; empty: it has not ended.
  [[nodiscard]] std::optional<scenes::Verdict> verdict() const { return verdict_; }
  [[nodiscard]] std::size_t snapshots() const { return snapshots_; }

 private:
  void readAll() {
    while (const auto news = watcher_.takeNews()) tell(*news);
    if (const auto force = watcher_.takeForce()) force_ = *force;
    if (auto snapshot = watcher_.takeSnapshot()) {
      ++snapshots_;
      follow(*snapshot);
    }
  }
  void tell(const scenes::SessionNews& news) {
    if (news.kind == scenes::SessionNews::Kind::Ended) verdict_ = news.verdict;
    const char* what = news.kind == scenes::SessionNews::Kind::StepDone ? "step " : "";
    std::printf("%8.2f s  %s%s\n", news.time_s, what, news.text.c_str());
    std::fflush(stdout);
  }
  void follow(const scenes::Snapshot& now) {
    const scenes::Scene& scene = watcher_.scene();
    const auto step = static_cast<std::size_t>(now.step);
    if (now.step < 0 || step >= scene.steps.size()) return;
    if (now.step != step_) {
      step_ = now.step;
      next_s_ = now.time_s;
      std::printf("%8.2f s  step %d of %zu: %s\n", now.time_s, now.step + 1, scene.steps.size(),
                  scene.parts[scene.steps[step].part].part.name.c_str());
    }
    if (rate_hz_ <= 0 || now.time_s < next_s_) return;
    next_s_ = now.time_s + 1 / rate_hz_;
    for (const scenes::BodySnapshot& body : now.bodies)
      if (body.part == scene.steps[step].part)
        std::printf("%8.2f s  at %s mm, %zu contacts, force on the hand %.1f N%s\n", now.time_s,
                    millimetres(body.X_WP.p).c_str(), now.contacts.size(), force_.F_hand_W.f.norm(),
                    force_.is_faulted ? " (the device is safe: no force)" : "");
    std::fflush(stdout);
  }
  static std::string millimetres(const Vec3& p) {
    return fixed(1e3 * p.x(), 2) + ", " + fixed(1e3 * p.y(), 2) + ", " + fixed(1e3 * p.z(), 2);
  }

  scenes::SessionWatcher& watcher_;
  double rate_hz_;
  std::optional<scenes::Verdict> verdict_;
  scenes::SessionForce force_;
  std::size_t snapshots_ = 0;
  int step_ = -1;
  double next_s_ = 0;
};

int runWatch(const WatchArguments& given) {
  bool has_said = false;
  while (!stopRequested()) {
    const std::unique_ptr<scenes::SessionWatcher> watcher =
        scenes::SessionWatcher::join(given.session, given.network);
    if (watcher == nullptr) {
      if (!has_said) say("waiting for the session '" + given.session + "', which vps render starts");
      has_said = true;
      std::this_thread::sleep_for(kWatchPoll);
      continue;
    }
    has_said = false;
    say("watching '" + watcher->scene().name + "'");
    Watching watching(*watcher, given.rate_hz);
    watching.run();
    if (watching.verdict()) {
      std::printf("%zu snapshots seen\n", watching.snapshots());
      return statusOf(*watching.verdict());
    }
    if (!stopRequested()) say(watcher->hasEnded() ? "the session was stopped" : "the render node is lost");
    if (watcher->hasEnded()) return kNotShown;
  }
  throw Stopped();
}

}  // namespace

void addWatch(CommandLine& line) {
  const auto given = std::make_shared<WatchArguments>();
  CLI::App& command = addCommand(
      line, "watch", "follows a session of vps render: its steps, the part in hand, forces and verdict",
      "vps watch --session demo", [given] { return runWatch(*given); });
  addSessionOption(command, given->session);
  addNetworkOption(command, given->network);
  command.add_option("--rate", given->rate_hz, "lines a second about the part in hand; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
}

}  // namespace vps::viewer::inline v0

// SPDX-License-Identifier: BSD-3-Clause
// vps watch: shows a session in a window, or prints its steps, forces and verdict. A watcher only reads, so
// it cannot disturb the session. vps watch --web: shows a session, a run of a scene, or a recording in web
// browsers.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "input/file_kind.h"
#include "input/scene_arguments.h"
#include "input/session_options.h"
#include "output/command.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_device/recording.h"
#include "vps_scenes/network/nodes.h"
#include "vps_scenes/network/ros_topics.h"
#include "vps_scenes/network/session_pointers.h"
#include "vps_viewer/web/web.h"
#include "vps_viewer/window/window.h"

namespace vps::viewer {

namespace {

struct WatchArguments {
  std::string session = kDefaultSession;
  scenes::SessionNetwork network;
  double rate_hz = 1;   ///< printed lines per second about the part in hand; 0: none
  std::string record;   ///< file for the recording of the run; empty: none
  int ros_domain = -1;  ///< negative: no topics of ROS 2
  bool is_ros_in_clear = false;
  bool is_terminal = false;  ///< opens no window even if there is a display
  bool is_silent = false;
  SceneArguments scene;
  int port = -1;  ///< port of the web page; negative: no page
  WebOptions web;
  std::vector<std::string> tls;  ///< files of certificate and key; empty: no https
};

constexpr std::chrono::milliseconds kWatchPoll{5};
constexpr std::chrono::milliseconds kLook{50};  ///< time between reads without ROS 2; 256 messages can wait

/// Follows one session: reads its messages, snapshots and forces, prints them, and publishes them in ROS 2.
class Watching {
 public:
  Watching(scenes::SessionWatcher& watcher, const WatchArguments& given)
      : watcher_(watcher), rate_hz_(given.rate_hz) {
    try {
      pointers_.emplace(given.session, given.network);
    } catch (const LoadError& refused) {  // the certificates were made before pointers existed
      say(std::string("pointers are not shown: ") + refused.what());
    }
    const std::string interface = given.network.empty() ? "lo" : given.network.interface;
    if (given.ros_domain >= 0)
      ros_ = std::make_unique<scenes::RosTopics>(given.ros_domain, interface, given.session, watcher.scene());
  }

  /// Runs until the session is over or the user stops the program.
  void run() {
    while (!stopRequested()) {
      const bool is_over = watcher_.isOver();  // asked before the messages are read, so that none is missed
      readAll();
      if (is_over) return;
      std::this_thread::sleep_for(ros_ ? kWatchPoll : kLook);
    }
  }
  /// Verdict of the run; empty until the run has ended.
  [[nodiscard]] std::optional<scenes::Verdict> verdict() const { return verdict_; }
  [[nodiscard]] std::size_t snapshots() const { return snapshots_; }

 private:
  void readAll() {
    while (const auto news = watcher_.takeNews()) tell(*news);
    for (const std::string& doubt : watcher_.takeDoubts()) say(doubt);
    if (pointers_)
      for (const scenes::SessionPointer& pointer : pointers_->take()) tell(pointer);
    if (const auto force = watcher_.takeForce()) {
      force_ = *force;
      if (ros_) ros_->publish(force_.F_hand_W, systemTime_ns());
    }
    if (auto snapshot = watcher_.takeSnapshot()) {
      ++snapshots_;
      if (ros_) ros_->publish(*snapshot, systemTime_ns());
      follow(*snapshot);
    }
  }
  void tell(const scenes::SessionNews& news) {
    if (news.kind == scenes::SessionNews::Kind::Ended) verdict_ = news.verdict;
    const char* what = news.kind == scenes::SessionNews::Kind::StepDone ? "step " : "";
    std::printf("%8.2f s  %s%s\n", news.time_s, what, news.text.c_str());
    std::fflush(stdout);
  }
  /// Prints where a pointer appears; printing its motion would take too many lines.
  void tell(const scenes::SessionPointer& pointer) {
    if (!pointer.p_W) {
      pointing_.erase(pointer.who);
    } else if (pointing_.insert(pointer.who).second) {
      std::printf("            somebody points at %s mm\n", millimetres(*pointer.p_W).c_str());
      std::fflush(stdout);
    }
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
                    force_.is_faulted ? " (safety stop: the device gives no force)" : "");
    std::fflush(stdout);
  }
  static std::int64_t systemTime_ns() {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
  }
  static std::string millimetres(const Vec3& p) {
    return fixed(1e3 * p.x(), 2) + ", " + fixed(1e3 * p.y(), 2) + ", " + fixed(1e3 * p.z(), 2);
  }

  scenes::SessionWatcher& watcher_;
  std::unique_ptr<scenes::RosTopics> ros_;  ///< null: none
  std::optional<scenes::SessionPointers> pointers_;
  std::set<int> pointing_;
  double rate_hz_;
  std::optional<scenes::Verdict> verdict_;
  scenes::SessionForce force_;
  std::size_t snapshots_ = 0;
  int step_ = -1;
  double next_s_ = 0;
};

int serveWeb(const WatchArguments& given) {
  WebOptions web = given.web;
  web.port = static_cast<std::uint16_t>(given.port);
  web.session = given.session;
  web.network = given.network;
  web.stop = &stopRequested();
  if (!given.tls.empty()) {
    web.tls_certificate = given.tls.front();
    web.tls_key = given.tls.back();
  }
  web.say = [](const std::string& words) { say(words); };
  if (given.scene.scene.empty()) {
    serveSession(web);
    return kGood;
  }
  if (lowerExtension(given.scene.scene) == ".mcap") {
    if (web.allows_hand)
      throw LoadError(given.scene.scene, "",
                      "is a recording, in which no part can be moved; leave out --allow-hand");
    serveRecording(device::loadRecording(given.scene.scene), web);
    return kGood;
  }
  const scenes::Scene scene = sceneFrom(given.scene.scene, given.scene.fidelity, {}, given.scene.cache);
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache);
  web.models.cache = cache ? &*cache : nullptr;
  web.models.models_everything = given.scene.models_everything;
  serveScene(scene, web);
  return kGood;
}

/// Throws LoadError if a session with certificates would be published as topics of ROS 2, which are not
/// encrypted, without --ros-in-clear.
void requireRosAllowed(const WatchArguments& given) {
  const std::string& interface = given.network.interface;
  if (given.ros_domain < 0 || given.is_ros_in_clear || interface.empty()) return;
  if (given.network.security.empty() || given.network.security == "none") return;
  throw LoadError(
      "--ros", "",
      "publishes handle, force and parts on " + interface +
          " without encryption, while the session is protected by --security; add --ros-in-clear if "
          "everybody on that network may read them, or leave out --ros");
}

/// Whether there is a display and no option needs the terminal.
bool wantsWindow(const WatchArguments& given) {
  const bool has_display = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  return has_display && !given.is_terminal && given.ros_domain < 0 && missingForWindow().empty();
}

int showWindow(const WatchArguments& given) {
  WindowOptions window;
  window.session = given.session;
  window.network = given.network;
  window.has_sound = !given.is_silent;
  window.stop = &stopRequested();
  window.say = [](const std::string& words) { say(words); };
  const std::optional<scenes::Verdict> verdict = viewSession(window);
  if (verdict) return scenes::exitStatusOf(*verdict);
  throwIfStopped();
  return kNotShown;
}

/// Shows the window and returns the exit status. The result is empty if no window can be opened, for example
/// because no server answers at DISPLAY; the function then prints the reason.
std::optional<int> tryWindow(const WatchArguments& given) {
  try {
    return showWindow(given);
  } catch (const LoadError&) {
    throw;
  } catch (const std::runtime_error& error) {  // see viewSession()
    say(error.what());
    return {};
  }
}

int follow(const WatchArguments& given) {
  // On a machine with several nodes the watcher must not delay the nodes that compute.
  if (given.scene.scene.empty() && !given.web.allows_hand) giveWay();
  if (given.port >= 0) return serveWeb(given);
  if (!given.scene.scene.empty())
    throw LoadError(given.scene.scene, "", "vps watch follows a session; add --web PORT, or use vps view");
  if (wantsWindow(given))
    if (const std::optional<int> status = tryWindow(given)) return *status;
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
    Watching watching(*watcher, given);
    watching.run();
    if (watching.verdict()) {
      std::printf("%zu snapshots seen, %llu messages refused\n", watching.snapshots(),
                  static_cast<unsigned long long>(watcher->refused()));
      return scenes::exitStatusOf(*watching.verdict());
    }
    if (!stopRequested()) say(watcher->hasEnded() ? "the session was stopped" : "the render node is lost");
    if (watcher->hasEnded()) return kNotShown;
  }
  throw Stopped();
}

int runWatch(const WatchArguments& given) {
  requireRosAllowed(given);
  if (given.record.empty()) return follow(given);
  if (!given.scene.scene.empty())
    throw LoadError(given.scene.scene, "",
                    "--record is for a session; vps assemble --record records a scene");
  scenes::SessionRecording recording(recordingOptions(given.session, given.network, given.record));
  const int status = follow(given);
  const int recorded = finishRecording(recording, given.record);
  return recorded == kGood ? status : recorded;
}

}  // namespace

std::function<int()> addWatch(CLI::App& command) {
  const auto given = std::make_shared<WatchArguments>();
  addSceneOptions(command, given->scene);
  command.get_option("scene")->required(false)->description(
      "scene file (TOML) to run, or recording (MCAP) to play, for the web page; without a file a session is "
      "followed");
  addSessionOption(command, given->session);
  addNetworkOption(command, given->network);
  command
      .add_option("--rate", given->rate_hz,
                  "in the terminal: printed lines per second about the part in hand; 0: none")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 100.0));
  command.add_flag("--terminal", given->is_terminal,
                   "print steps, forces and verdict instead of opening a window; the default without a "
                   "display and with --ros");
  addRecordOption(command, given->record);
  command.add_flag("--silent", given->is_silent, "open the window without sound");
  command
      .add_option(
          "--ros", given->ros_domain,
          "publish the session as topics of ROS 2 in this domain (ROS_DOMAIN_ID): handle (PoseStamped), "
          "force (WrenchStamped) and /tf, on the interface of --network, or on lo without it")
      ->type_name("DOMAIN")
      ->check(CLI::Range(0, 232));
  command
      .add_flag("--ros-in-clear", given->is_ros_in_clear,
                "with --security: publish the topics of ROS 2 although they are not encrypted")
      ->needs("--ros");
  CLI::Option* web =
      command
          .add_option(
              "--web", given->port,
              "serve a page for web browsers at this port; 0: a free port. The page shows the run in 3D with "
              "section planes, forces, verdict and sound, and can mark a place for all watchers")
          ->type_name("PORT")
          ->excludes("--ros")
          ->check(CLI::Range(0, 65535));
  command.get_option("scene")->needs(web);
  command
      .add_option("--listen", given->web.address,
                  "address of this machine at which the page is served. Addresses other than loopback need a "
                  "token: everybody who knows it can watch and, with --allow-hand, move the part")
      ->capture_default_str()
      ->type_name("ADDRESS")
      ->needs(web);
  command
      .add_option("--token", given->web.token,
                  "token of at least 16 letters, digits, - and _ (default: a new one if one is needed). "
                  "Other users of this machine can see it on the command line")
      ->envname("VPS_WEB_TOKEN")
      ->needs(web);
  command
      .add_option("--tls", given->tls,
                  "serve the page by https, with this certificate and its key (PEM files, the key without a "
                  "passphrase)")
      ->expected(2)
      ->type_name("CERT KEY")
      ->needs(web);
  command
      .add_flag("--allow-hand", given->web.allows_hand,
                "one browser at a time may take the part in hand, by mouse, finger or a headset's "
                "controller; this program is then the session's device")
      ->needs(web);
  return [given] { return runWatch(*given); };
}

}  // namespace vps::viewer

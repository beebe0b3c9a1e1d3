// SPDX-License-Identifier: BSD-3-Clause
// The nodes of a session as processes, which can be killed and started again, watched from this process.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "support/process/child_process.h"
#include "vps_scenes/network/nodes.h"

namespace vps::test {

/// The three nodes of one session.
class NodeProcesses {
 public:
  NodeProcesses(std::string program, std::string scene, std::string session, std::filesystem::path folder,
                std::string network = "")
      : program_(std::move(program)),
        scene_(std::move(scene)),
        session_(std::move(session)),
        folder_(std::move(folder)),
        network_(std::move(network)) {}

  void startRender() {
    render = start({program_, "render", scene_, "--no-pictures", "--out", (folder_ / "out").string(),
                    "--json", (folder_ / "run.json").string()},
                   "render.txt");
  }
  void startDevice() { device = start({program_, "device", "--stay"}, "device.txt"); }
  void startWatch() { watch = start({program_, "watch", "--terminal"}, "watch.txt"); }

  /// Joins the session as one more watcher, and waits until the session can be joined. Returns false at the
  /// limit.
  bool join(double limit_s = 30) {
    watcher.reset();
    return waitFor([this] { return (watcher = scenes::SessionWatcher::join(session_, network_)) != nullptr; },
                   limit_s);
  }
  /// Waits until the hand holds a part and force can flow.
  bool waitForHold(double limit_s = 30) {
    return waitFor(
        [this] {
          const auto force = watcher->takeForce();
          return force && force->is_holding && !force->is_faulted;
        },
        limit_s);
  }
  /// Waits until physics has advanced by this simulated time [s].
  bool waitForPhysics(double seconds, double limit_s = 30) {
    std::optional<double> begun_s;
    return waitFor(
        [&] {
          const auto snapshot = watcher->takeSnapshot();
          if (!snapshot) return false;
          if (!begun_s) begun_s = snapshot->time_s;
          return snapshot->time_s - *begun_s >= seconds;
        },
        limit_s);
  }
  /// Time from a kill to the first wrench of zero that the device gave with a fault [s]; empty if it gave
  /// none.
  std::optional<double> safeAfter_s(std::int64_t killed_ns, double limit_s = 1) {
    std::optional<double> safe_s;
    waitFor(
        [&] {
          const auto force = watcher->takeForce();
          if (force && force->is_faulted && force->F_hand_W.f.isZero() && force->F_hand_W.tau.isZero())
            safe_s = 1e-9 * static_cast<double>(force->sent_ns - killed_ns);
          return safe_s.has_value();
        },
        limit_s);
    return safe_s;
  }
  /// Number of named shared memory segments of this session.
  [[nodiscard]] std::size_t segments() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/shm"))
      count += entry.path().filename().string().find("." + session_) != std::string::npos;
    return count;
  }

  static bool waitFor(const std::function<bool()>& isSo, double limit_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
    while (!isSo()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return true;
  }

  ChildProcess render, device, watch;
  std::unique_ptr<scenes::SessionWatcher> watcher;
  /// Folder of the certificates for processes that are started from now on; empty: none.
  std::string security;

 private:
  [[nodiscard]] ChildProcess start(std::vector<std::string> words, const std::string& output) const {
    words.insert(words.end(), {"--session", session_});
    if (!network_.empty()) words.insert(words.end(), {"--network", network_});
    if (!security.empty()) words.insert(words.end(), {"--security", security});
    return {std::move(words), (folder_ / output).string()};
  }

  std::string program_, scene_, session_;
  std::filesystem::path folder_;
  std::string network_;  ///< interface; empty: shared memory
};

}  // namespace vps::test

// SPDX-License-Identifier: BSD-3-Clause
// The space mouse through libspnav 1.0. The only file that includes spnav.h.
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "drivers/polled_device.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

// The last include, since it defines Xlib's macros (Status, Success, None).
#include <spnav.h>

namespace vps::device {

namespace {

constexpr double kFull = 350;  // counts at full deflection. assumed: what 3Dconnexion's devices reach
constexpr int kWait_ms = 20;   // wait for events, and time that the thread takes to end
constexpr auto kRetry = std::chrono::milliseconds(500);

std::atomic<bool> is_in_use{false};  // libspnav keeps its connection in globals

/// True if a daemon may be running. Checked before spnav_open(), which in version 1.0 leaks some bytes at
/// each failure.
bool mayBeRunning() {
  const char* named = std::getenv("SPNAV_SOCKET");
  return (named != nullptr && access(named, F_OK) == 0) || access("/etc/spnavrc", F_OK) == 0 ||
         access("/var/run/spnav.sock", F_OK) == 0;
}

/// libspnav's axes are x right, y up, z away from the person, which is left-handed; its rotation is (rx, ry,
/// -rz) in x right, y up, z towards the person. D: x towards the person, y right, z up.
Deflection deflectionOf(const spnav_event_motion& motion) {
  Deflection deflection;
  deflection.push = Vec3(-motion.z, motion.x, motion.y) / kFull;
  deflection.turn = Vec3(-motion.rz, motion.rx, motion.ry) / kFull;
  return deflection;
}

class SpaceMouse final : public HandSource {
 public:
  SpaceMouse() {
    // libspnav may write to a daemon that has ended, and SIGPIPE would end the program. The signal goes to
    // the thread that writes, which is this thread.
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
  }
  ~SpaceMouse() override {
    close();
    is_in_use.store(false);
  }

  void poll(HandInput& input) override {
    if (!is_open_) return connect(input);
    pollfd waited{spnav_fd(), POLLIN, 0};
    if (::poll(&waited, 1, kWait_ms) <= 0) return;
    if (isHungUp()) {
      input = {};
      return close();
    }
    for (spnav_event event; spnav_poll_event(&event) != 0;) take(event, input);
  }

 private:
  void connect(HandInput& input) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_try_ || !mayBeRunning() || spnav_open() != 0) {
      if (now >= next_try_) next_try_ = now + kRetry;
      std::this_thread::sleep_for(std::chrono::milliseconds(kWait_ms));
      return;
    }
    is_open_ = true;
    if (isHungUp()) {  // the daemon ended while we connected
      next_try_ = now + kRetry;
      return close();
    }
    input = {};
    input.is_connected = true;  // a daemon without a mouse sends nothing, as does a mouse at rest
  }

  /// The library does not distinguish the end of the daemon or an error from "no event".
  static bool isHungUp() {
    char byte = 0;
    const ssize_t count = recv(spnav_fd(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
  }

  void close() {
    if (is_open_) spnav_close();
    is_open_ = false;
  }

  static void take(const spnav_event& event, HandInput& input) {
    if (event.type == SPNAV_EVENT_MOTION) {
      const bool is_recentring = input.deflection.is_recentring;
      input.deflection = deflectionOf(event.motion);
      input.deflection.is_recentring = is_recentring;
      input.is_connected = true;
    } else if (event.type == SPNAV_EVENT_BUTTON && event.button.bnum == 0) {
      input.deflection.is_recentring = event.button.press != 0;
    } else if (event.type == SPNAV_EVENT_DEV) {
      input = {};
      input.is_connected = event.dev.op == SPNAV_DEV_ADD;
    }
  }

  bool is_open_ = false;
  std::chrono::steady_clock::time_point next_try_;
};

}  // namespace

std::unique_ptr<Device> openSpaceMouse(const RateSettings& settings) {
  if (is_in_use.exchange(true))
    throw LoadError("", "", "this program already uses the space mouse; close that device first");
  return std::make_unique<PolledDevice<SpaceMouse>>(settings, "space_mouse");
}

DeviceKind spaceMouseKind() {
  return {"space_mouse",
          "6-DOF mouse through spacenavd, moved by a person; gives no force",
          "start spacenavd (Debian: apt install spacenavd), or set SPNAV_SOCKET to its socket, and plug the "
          "mouse in",
          [](const DeviceOptions& options) { return openSpaceMouse(rateSettings(options)); },
          nullptr,
          [] { return std::string(mayBeRunning() ? "" : "no spacenavd daemon was found"); }};
}

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
// The time of a state from the device's node to the render node and of the answer back. The render node's
// side answers at once, so that only the link is measured. For comparison, the time of the calls that any
// link needs is measured: writing and reading in one process, or the same bytes over UDP without DDS.
#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exchange_times.h"
#include "link/link.h"
#include "messages/messages.h"
#include "rows.h"
#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"

namespace vps::bench {

namespace {

using namespace scenes;

constexpr const char* kSession = "bench-latency";

/// One end of the link with what it needs to write and read.
struct End {
  /// @param form  form in which the nodes write states on this link
  End(std::unique_ptr<Link> joined, std::uint64_t sender, WireForm form)
      : link(std::move(joined)), writer(sender, form) {}

  void sendHaptic(std::int32_t tick) {
    haptic.state.tick = tick;
    link->send(Channel::Haptic, writer.write(haptic));
  }
  bool takeHaptic() {
    const std::string_view bytes = link->receive(Channel::Haptic, buffer);
    return !bytes.empty() && reader.read(bytes, haptic) == Reading::Good;
  }
  void sendPhysics(std::int32_t step) {
    physics.state.step = step;
    link->send(Channel::Physics, writer.write(physics));
  }
  bool takePhysics() {
    const std::string_view bytes = link->receive(Channel::Physics, buffer);
    return !bytes.empty() && reader.read(bytes, physics) == Reading::Good;
  }

  std::unique_ptr<Link> link;
  MessageWriter writer;
  MessageReader reader;
  HapticMessage haptic;
  PhysicsMessage physics;
  std::vector<char> buffer = std::vector<char>(kLongestMessage);
};

/// The form in which the nodes write states on a network: over UDP the compact form.
WireForm formOf(const std::string& network) {
  return network.empty() ? WireForm::Exact : WireForm::Compact;
}

/// Waits for a message over UDP, as the calls of bare UDP do; does not wait in shared memory.
void pauseFor(const End& end) {
  if (end.link->form() == WireForm::Compact) end.link->waitForMessage(kPeriod_ns);
}

/// Runs the render node's side until it is killed.
[[noreturn]] void echo(End& end) {
  device::requestRealTime(70, false);
  for (;;) {
    if (!end.takeHaptic()) {
      pauseFor(end);
      continue;
    }
    end.sendPhysics(end.haptic.state.tick);
    // The system throttles a thread with real-time priority that never sleeps.
    device::monotonicClock().sleepUntil(now_ns() + kPeriod_ns / 2);
  }
}

/// The render node's side in a process of its own, and this process's side.
struct Ends {
  explicit Ends(const std::string& network) {
    other = fork();
    if (other == 0) {
      End render(makeSession(kSession, "no scene", network), 1, formOf(network));
      echo(render);
    }
    std::unique_ptr<Link> link;
    while ((link = joinSession(kSession, NodeRole::Device, network)) == nullptr) usleep(1000);
    if (link->form() != formOf(network)) throw std::logic_error("the link has another form than is measured");
    device.emplace(std::move(link), 2, formOf(network));
  }
  ~Ends() {
    kill(other, SIGKILL);
    waitpid(other, nullptr, 0);
  }
  pid_t other = 0;
  std::optional<End> device;
};

/// Times of the same calls in one process, through shared memory.
Times bareTimes(double seconds, WireForm form) {
  device::requestRealTime(80, false);
  End render(makeSession("bench-bare", "no scene"), 1, form);
  End device(joinSession("bench-bare", NodeRole::Device), 2, form);
  Times times = timed(seconds, [&](std::int32_t i) {
    device.sendHaptic(i);
    render.takeHaptic();
    render.sendPhysics(i);
    device.takePhysics();
  });
  device::leaveRealTime();
  return times;
}

/// A socket of UDP on lo.
class UdpSocket {
 public:
  UdpSocket() : file_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    socklen_t size = sizeof address_;
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval limit{0, 100'000};
    if (file_ < 0 || bind(file_, generic(), size) != 0 || getsockname(file_, generic(), &size) != 0 ||
        setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit) != 0)
      throw std::runtime_error("no UDP on lo");
  }
  ~UdpSocket() { close(file_); }
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  void send(UdpSocket& to, std::string_view bytes) {
    sendto(file_, bytes.data(), bytes.size(), 0, to.generic(), sizeof address_);
  }
  /// Waits for a message and returns it.
  std::string_view receive() {
    const ssize_t size = recv(file_, buffer_.data(), buffer_.size(), 0);
    return {buffer_.data(), static_cast<std::size_t>(std::max<ssize_t>(0, size))};
  }

 private:
  sockaddr* generic() { return reinterpret_cast<sockaddr*>(&address_); }
  int file_;
  sockaddr_in address_{};
  std::vector<char> buffer_ = std::vector<char>(kLongestMessage);
};

/// Times of the same bytes between two processes with the system's calls for UDP alone, in which each process
/// waits.
Times bareUdpTimes(double seconds) {
  UdpSocket device, render;
  const pid_t other = fork();
  if (other == 0) {
    device::requestRealTime(70, false);
    MessageWriter writer(1, WireForm::Compact);
    MessageReader reader;
    HapticMessage haptic;
    PhysicsMessage physics;
    for (;;) {
      if (reader.read(render.receive(), haptic) != Reading::Good) continue;
      physics.state.step = haptic.state.tick;
      render.send(device, writer.write(physics));
    }
  }
  device::requestRealTime(80, false);
  MessageWriter writer(2, WireForm::Compact);
  MessageReader reader;
  HapticMessage haptic;
  PhysicsMessage physics;
  const Times times = timed(seconds, [&](std::int32_t i) {
    haptic.state.tick = i;
    device.send(render, writer.write(haptic));
    while (reader.read(device.receive(), physics) == Reading::Good && physics.state.step != i) {
    }
  });
  device::leaveRealTime();
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  return times;
}

bool latencyRow(const std::string& network, double seconds, double p50_bar_us, double p99_bar_us) {
  const Times bare = network.empty() ? bareTimes(seconds, formOf(network)) : bareUdpTimes(seconds);
  MessageWriter sizes(1, formOf(network));
  HapticMessage usual;
  std::size_t bytes = 0;  // the first states are whole, so the size is that of the last message
  for (usual.state.tick = 1; usual.state.tick < 20; ++usual.state.tick) bytes = sizes.write(usual).size();
  Ends ends(network);
  End& device = *ends.device;
  int unanswered = 0;
  device.sendHaptic(0);
  usleep(300'000);  // time in which both processes find each other
  device::requestRealTime(80, false);
  const Times both = timed(seconds, [&](std::int32_t i) {
    device.sendHaptic(i);
    const std::int64_t end_ns = now_ns() + kPeriod_ns;
    while (!device.takePhysics() || device.physics.state.step != i) {
      pauseFor(device);
      if (now_ns() < end_ns) continue;
      ++unanswered;
      return;
    }
  });
  device::leaveRealTime();

  char words[240], bar[80];
  std::snprintf(words, sizeof words,
                "p50 %.1f us, p99 %.1f us, p99.9 %.1f us; %d of %zu not within a period; %s p50 %.1f us, p99 "
                "%.1f us; a state of the proxy has %zu bytes",
                both.us(0.5), both.us(0.99), both.us(0.999), unanswered, both.all.size(),
                network.empty() ? "the same calls in one process" : "bare UDP between two processes",
                bare.us(0.5), bare.us(0.99), bytes);
  std::snprintf(bar, sizeof bar, "p50 <= %.0f us, p99 <= %.0f us beyond bare calls", p50_bar_us, p99_bar_us);
  const bool is_reached =
      both.us(0.5) - bare.us(0.5) <= p50_bar_us && both.us(0.99) - bare.us(0.99) <= p99_bar_us;
  printRow("device to render and back, 1600 Hz, " + (network.empty() ? "shared memory" : "UDP on " + network),
           bar, words, is_reached);
  return is_reached;
}

}  // namespace

bool latencyRows(double seconds) {
  const bool is_shared_good = latencyRow("", seconds, 20, 60);
  return latencyRow("lo", seconds, 100, 250) && is_shared_good;
}

}  // namespace vps::bench

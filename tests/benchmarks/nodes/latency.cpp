// SPDX-License-Identifier: BSD-3-Clause
// How long a state takes from the device's node to the render node and its answer back. The render node's
// side answers at once, so that the link alone is measured.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include "network/link.h"
#include "network/messages.h"
#include "rows.h"
#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"

namespace vps::bench {

namespace {

using namespace scenes;

constexpr std::int64_t kPeriod_ns = 625'000;  // 1600 Hz
constexpr const char* kSession = "bench-latency";

std::int64_t now_ns() {
  return device::monotonicClock().now_ns();
}

/// One end of the link with what it needs to write and read.
struct End {
  End(std::unique_ptr<Link> joined, std::uint64_t sender) : link(std::move(joined)), writer(sender) {}

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

/// The render node's side, until it is killed.
[[noreturn]] void echo(End& end) {
  device::requestRealTime(70, false);
  for (;;)
    if (end.takeHaptic()) end.sendPhysics(end.haptic.state.tick);
}

struct Times {
  explicit Times(std::vector<std::int64_t> ns) : all(std::move(ns)) { std::sort(all.begin(), all.end()); }
  [[nodiscard]] double us(double share) const {
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(all.size() - 1));
    return 1e-3 * static_cast<double>(all[rank]);
  }
  std::vector<std::int64_t> all;
};

/// Calls `exchange` at 1600 Hz, with its number, and times it.
template <typename Exchange>
Times timed(double seconds, const Exchange& exchange) {
  device::Metronome metronome(kPeriod_ns, device::monotonicClock());
  metronome.start();
  std::vector<std::int64_t> ns;
  const auto count = static_cast<std::int32_t>(1e9 * seconds / kPeriod_ns);
  ns.reserve(static_cast<std::size_t>(count));
  for (std::int32_t i = 1; i <= count; ++i) {
    metronome.wait();
    const std::int64_t begun_ns = now_ns();
    exchange(i);
    ns.push_back(now_ns() - begun_ns);
  }
  return Times(std::move(ns));
}

}  // namespace

bool latencyRows(double seconds) {
  auto render = std::make_unique<End>(makeSession(kSession, "no scene"), 1);
  End device(joinSession(kSession, NodeRole::Device), 2);
  device::requestRealTime(80, false);
  // The same calls without another process.
  const Times bare = timed(seconds, [&](std::int32_t i) {
    device.sendHaptic(i);
    render->takeHaptic();
    render->sendPhysics(i);
    device.takePhysics();
  });
  const pid_t other = fork();
  if (other == 0) echo(*render);
  const Times both = timed(seconds, [&](std::int32_t i) {
    device.sendHaptic(i);
    while (!device.takePhysics() || device.physics.state.step != i) {
    }
  });
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  device::leaveRealTime();

  char words[200];
  std::snprintf(words, sizeof words,
                "p50 %.1f us, p99 %.1f us, p99.9 %.1f us; bare calls p50 %.1f us, p99 %.1f us", both.us(0.5),
                both.us(0.99), both.us(0.999), bare.us(0.5), bare.us(0.99));
  const double p50_us = both.us(0.5) - bare.us(0.5), p99_us = both.us(0.99) - bare.us(0.99);
  const bool is_reached = p50_us <= 20 && p99_us <= 60;
  printRow("device to render and back, shared memory, 1600 Hz",
           "p50 <= 20 us, p99 <= 60 us beyond bare calls", words, is_reached);
  return is_reached;
}

}  // namespace vps::bench

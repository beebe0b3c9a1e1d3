// SPDX-License-Identifier: BSD-3-Clause
// A state of the proxy is sent to another process through iceoryx, and the answer back, with the bytes and
// the rate of latency.cpp. As there, both ends look for the next message without a pause. The daemon of
// iceoryx, iox-roudi, holds the memory and must be installed (Debian: iceoryx).
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iceoryx_posh/popo/publisher.hpp>
#include <iceoryx_posh/popo/subscriber.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <string>

#include "exchange_times.h"
#include "messages/messages.h"
#include "rows.h"
#include "support/process/child_process.h"
#include "support/temporary_folder.h"
#include "vps_device/periodic_thread.h"

namespace vps::bench {

namespace {

using namespace scenes;

struct Bytes {
  std::size_t size = 0;
  std::array<char, 512> bytes{};
};

/// A publisher and a subscriber of one process.
class End {
 public:
  End(const char* process, const char* out, const char* in)
      : runtime_(iox::runtime::PoshRuntime::initRuntime(
            iox::RuntimeName_t(iox::cxx::TruncateToCapacity, process))),
        out_({"vps", "bench", iox::capro::IdString_t(iox::cxx::TruncateToCapacity, out)}),
        in_({"vps", "bench", iox::capro::IdString_t(iox::cxx::TruncateToCapacity, in)}, newestOnly()) {}

  void send(std::string_view bytes) {
    auto sample = out_.loan();
    if (sample.has_error()) return;
    (*sample)->size = bytes.size();
    std::memcpy((*sample)->bytes.data(), bytes.data(), bytes.size());
    sample->publish();
  }
  /// Returns false if no message has arrived.
  template <typename Message>
  bool take(MessageReader& reader, Message& message) {
    auto sample = in_.take();
    return !sample.has_error() &&
           reader.read({(*sample)->bytes.data(), (*sample)->size}, message) == Reading::Good;
  }

 private:
  static iox::popo::SubscriberOptions newestOnly() {
    iox::popo::SubscriberOptions options;
    options.queueCapacity = 1;
    return options;
  }
  iox::runtime::PoshRuntime& runtime_;
  iox::popo::Publisher<Bytes> out_;
  iox::popo::Subscriber<Bytes> in_;
};

[[noreturn]] void echo() {
  End end("vps-bench-render", "physics", "haptic");
  device::requestRealTime(70, false);
  MessageWriter writer(1);
  MessageReader reader;
  HapticMessage haptic;
  PhysicsMessage physics;
  for (;;) {
    if (!end.take(reader, haptic)) continue;
    physics.state.step = haptic.state.tick;
    end.send(writer.write(physics));
    // The system throttles a thread with real-time priority that never sleeps.
    device::monotonicClock().sleepUntil(now_ns() + kPeriod_ns / 2);
  }
}

/// The path of a program; empty: it is not installed.
std::string pathOf(const std::string& program) {
  for (const char* folder : {"/usr/bin/", "/usr/local/bin/"})
    if (std::filesystem::exists(folder + program)) return folder + program;
  return "";
}

/// Measures in a process of its own, since the daemon ends all its clients when it ends.
[[noreturn]] void measure(const char* what, double seconds) {
  const pid_t other = fork();
  if (other == 0) echo();
  End end("vps-bench-device", "haptic", "physics");
  usleep(500'000);  // time in which both ends find each other
  device::requestRealTime(80, false);
  MessageWriter writer(2);
  MessageReader reader;
  HapticMessage haptic;
  PhysicsMessage physics;
  int unanswered = 0;
  const Times times = timed(seconds, [&](std::int32_t i) {
    haptic.state.tick = i;
    end.send(writer.write(haptic));
    const std::int64_t end_ns = now_ns() + kPeriod_ns;
    while (!end.take(reader, physics) || physics.state.step != i) {
      if (now_ns() < end_ns) continue;
      ++unanswered;
      return;
    }
  });
  device::leaveRealTime();
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  char words[160];
  std::snprintf(words, sizeof words, "p50 %.1f us, p99 %.1f us, p99.9 %.1f us; %d of %zu not within a period",
                times.us(0.5), times.us(0.99), times.us(0.999), unanswered, times.all.size());
  printRow(what, "for comparison", words, true);
  _exit(0);
}

}  // namespace

bool iceoryxRow(double seconds) {
  const char* const what = "iceoryx, shared memory, device to render and back, 1600 Hz";
  const char* const chosen = std::getenv("IOX_ROUDI");
  const std::string daemon_path = chosen != nullptr ? chosen : pathOf("iox-roudi");
  if (daemon_path.empty()) {
    printRow(what, "for comparison", "not measured: iox-roudi is not installed, nor named by IOX_ROUDI",
             true);
    return true;
  }
  const test::TemporaryFolder folder;
  test::ChildProcess daemon({daemon_path}, folder.path() / "roudi.txt");
  usleep(1'000'000);  // time in which the daemon creates its memory
  const pid_t measuring = fork();
  if (measuring == 0) measure(what, seconds);
  int status = 0;
  waitpid(measuring, &status, 0);
  if (status != 0) printRow(what, "for comparison", "not measured: iox-roudi does not run", true);
  daemon.interrupt();
  daemon.wait();
  return true;
}

}  // namespace vps::bench

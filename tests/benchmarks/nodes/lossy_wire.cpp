// SPDX-License-Identifier: BSD-3-Clause
#include "lossy_wire.h"

#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <queue>
#include <random>
#include <stdexcept>
#include <vector>

#include "vps_device/metronome.h"
#include "vps_device/periodic_thread.h"

namespace vps::bench {

namespace {

void require(bool is_done, const std::string& what) {
  if (!is_done) throw std::runtime_error("no network namespaces: " + what);
}
void system(const std::string& command) {
  require(std::system((command + " >/dev/null 2>&1").c_str()) == 0, command);
}

/// Makes a namespace with its interface, and the other end of the pair, which this process reads.
void makeEnd(const std::string& side, const std::string& address) {
  const std::string space = "vpsbench-" + side, outer = "vpsw-" + side;
  std::system(
      ("ip netns del " + space + " >/dev/null 2>&1; ip link del " + outer + " >/dev/null 2>&1").c_str());
  system("ip netns add " + space);
  system("ip link add " + outer + " type veth peer name wire netns " + space);
  system("ip -n " + space + " addr add " + address + "/24 dev wire");
  system("ip -n " + space + " link set wire up");
  system("ip -n " + space + " link set lo up");
  system("ip link set " + outer + " promisc on up");
}

int openEnd(const std::string& side) {
  const int end = socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
  require(end >= 0, "a raw socket");
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(("vpsw-" + side).c_str()));
  require(bind(end, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0, "bind");
  return end;
}

/// The kernel leaves the checksum of a UDP packet to the interface, but there is no hardware here; the
/// checksum 0 means that there is none.
void clearUdpSum(std::vector<char>& frame) {
  constexpr std::size_t kIp = 14;
  constexpr unsigned char kUdp = 17;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(frame[i]); };
  if (frame.size() < kIp + 28 || byte(12) != 8 || byte(13) != 0 || byte(kIp + 9) != kUdp) return;
  if ((byte(kIp + 6) & 0x1fU) != 0 || byte(kIp + 7) != 0) return;  // not the first fragment
  const std::size_t udp = kIp + 4 * (byte(kIp) & 0xfU);
  if (frame.size() >= udp + 8) frame[udp + 6] = frame[udp + 7] = 0;
}

struct Packet {
  std::int64_t due_ns;
  int to;
  std::vector<char> bytes;
  bool operator<(const Packet& other) const { return due_ns > other.due_ns; }
};

}  // namespace

LossyWire::LossyWire(const WireFaults& faults) : faults_(faults) {
  makeEnd("a", "10.99.77.1");
  makeEnd("b", "10.99.77.2");
  ends_[0] = openEnd("a");
  ends_[1] = openEnd("b");
  thread_ = std::thread([this] { carry(); });
}

LossyWire::~LossyWire() {
  is_ending_ = true;
  thread_.join();
  for (const int end : ends_) close(end);
  std::system("ip netns del vpsbench-a; ip netns del vpsbench-b");  // their interfaces are deleted too
}

void LossyWire::carry() {
  device::requestRealTime(85, false);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(0, 1);
  std::priority_queue<Packet> waiting;
  std::vector<char> buffer(70'000);
  std::int64_t second_ns = device::monotonicClock().now_ns();
  std::uint64_t before = 0;  // bytes before this second
  while (!is_ending_) {
    const std::int64_t now_ns = device::monotonicClock().now_ns();
    if (now_ns - second_ns >= 1'000'000'000) {
      const std::lock_guard lock(mutex_);
      per_second_.push_back(bytes_ - before);
      before = bytes_;
      second_ns = now_ns;
    }
    while (!waiting.empty() && waiting.top().due_ns <= now_ns) {
      const Packet& packet = waiting.top();
      send(ends_[packet.to], packet.bytes.data(), packet.bytes.size(), 0);
      waiting.pop();
    }
    pollfd ends[2] = {{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}};
    timespec pause{0, 1'000'000};
    if (!waiting.empty())
      pause.tv_nsec = std::min<std::int64_t>(pause.tv_nsec, waiting.top().due_ns - now_ns);
    if (ppoll(ends, 2, &pause, nullptr) <= 0) continue;
    for (int from = 0; from < 2; ++from) {
      if ((ends[from].revents & POLLIN) == 0) continue;
      sockaddr_ll sender{};
      socklen_t length = sizeof sender;
      const ssize_t size = recvfrom(ends_[from], buffer.data(), buffer.size(), 0,
                                    reinterpret_cast<sockaddr*>(&sender), &length);
      if (size <= 0 || sender.sll_pkttype == PACKET_OUTGOING) continue;
      bytes_ += static_cast<std::uint64_t>(size);
      ++packets_;
      if (draw(random) < faults_.loss) continue;
      std::vector<char> frame(buffer.begin(), buffer.begin() + size);
      clearUdpSum(frame);
      const int copies = draw(random) < faults_.doubled ? 2 : 1;
      for (int i = 0; i < copies; ++i) {
        const double delay_s = faults_.delay_s + faults_.jitter_s * draw(random);
        waiting.push(
            {device::monotonicClock().now_ns() + static_cast<std::int64_t>(1e9 * delay_s), 1 - from, frame});
      }
    }
  }
}

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
// Two network namespaces that are joined by a wire which loses, delays, reorders and duplicates packets, for
// machines whose kernel has no netem.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vps::bench {

struct WireFaults {
  double loss = 0;      ///< share of the packets that are lost, in each direction
  double delay_s = 0;   ///< one way
  double jitter_s = 0;  ///< added to the delay, uniformly distributed, so that packets overtake each other
  double doubled = 0;   ///< share of packets that arrive twice
};

/// Namespaces "vpsbench-a" and "vpsbench-b" with an interface "wire" each. Throws std::runtime_error if the
/// system does not allow network namespaces.
class LossyWire {
 public:
  explicit LossyWire(const WireFaults& faults);
  ~LossyWire();
  LossyWire(const LossyWire&) = delete;
  LossyWire& operator=(const LossyWire&) = delete;

  /// Bytes and packets that were put on the wire, with all headers, in both directions.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Bytes of each whole second so far.
  [[nodiscard]] std::vector<std::uint64_t> perSecond() const {
    const std::lock_guard lock(mutex_);
    return per_second_;
  }

 private:
  void carry();

  WireFaults faults_;
  int ends_[2] = {-1, -1};
  std::atomic<std::uint64_t> bytes_{0}, packets_{0};
  mutable std::mutex mutex_;
  std::vector<std::uint64_t> per_second_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace vps::bench

// SPDX-License-Identifier: BSD-3-Clause
// A device under rate control, with a thread of its own that reads the input.
#pragma once

#include <atomic>
#include <chrono>
#include <string_view>
#include <thread>

#include "vps/triple_buffer.h"
#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

namespace vps::device {

struct HandInput {
  Deflection deflection;
  bool is_connected = false;
};

/// Reads the input through a library. One thread calls all functions, construction and destruction included.
class HandSource {
 public:
  virtual ~HandSource() = default;
  /// Updates `input`. Takes some milliseconds at most, and an attempt to connect at most a second.
  virtual void poll(HandInput& input) = 0;
};

/// The reading thread makes the Source, by its default constructor.
template <typename Source>
class PolledDevice final : public Device {
 public:
  PolledDevice(const RateSettings& settings, std::string_view name)
      : control_(settings), name_(name), thread_([this] { work(); }) {}
  ~PolledDevice() override {
    is_ending_.store(true);
    thread_.join();
  }
  PolledDevice(const PolledDevice&) = delete;
  PolledDevice& operator=(const PolledDevice&) = delete;

  DeviceSample read() noexcept override {
    const HandInput& input = input_.read();
    DeviceSample sample = control_.step(input.is_connected ? input.deflection : Deflection{}, seconds());
    if (!input.is_connected) sample.status = Status::Fault;
    return sample;
  }
  void write(const Wrench&) noexcept override {}  // the device has no motor
  [[nodiscard]] DeviceLimits limits() const noexcept override { return control_.limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return name_; }

 private:
  [[nodiscard]] double seconds() const noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

  void work() {
    Source source;
    for (HandInput input; !is_ending_.load();) {
      source.poll(input);
      input_.write(input);
    }
  }

  RateControl control_;
  std::string_view name_;
  TripleBuffer<HandInput> input_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::atomic<bool> is_ending_{false};
  std::thread thread_;  // the last member, as it uses the other members
};

inline RateSettings rateSettings(const DeviceOptions& options) {
  RateSettings settings;
  settings.rate_hz = options.rate_hz;
  settings.workspace_m = options.workspace_m;
  return settings;
}

}  // namespace vps::device

// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/run_log.h"

#include <algorithm>
#include <cstring>

namespace vps::device {

void RunEvent::setWords(std::string_view words) noexcept {
  text.fill(0);
  const std::size_t count = std::min(words.size(), text.size() - 1);
  std::copy_n(words.begin(), count, text.begin());
}

std::string_view RunEvent::words() const noexcept {
  return {text.data(), ::strnlen(text.data(), text.size())};
}

double timeOf(const LogEntry& entry) noexcept {
  return std::visit([](const auto& e) { return e.time_s; }, entry);
}

DeviceSample TappedDevice::read() noexcept {
  const DeviceSample sample = inner_.read();
  time_s_ = sample.time_s;
  log_.add(sample);
  return sample;
}

void TappedDevice::write(const Wrench& F_Ho_D) noexcept {
  inner_.write(F_Ho_D);
  log_.add(WrittenWrench{time_s_, F_Ho_D});
}

}  // namespace vps::device

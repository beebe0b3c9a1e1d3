// SPDX-License-Identifier: BSD-3-Clause
#include "sound/lasting_output.h"

#include <utility>

#include "vps_device/metronome.h"

namespace vps::viewer {

LastingOutput::LastingOutput(std::unique_ptr<SoundOutput> output,
                             std::function<std::unique_ptr<SoundOutput>()> open, double wait_s,
                             std::function<void(const std::string&)> tell)
    : output_(std::move(output)), open_(std::move(open)), wait_s_(wait_s), tell_(std::move(tell)) {}

bool LastingOutput::isOpen() {
  if (output_) return true;
  const double now_s = device::monotonicSeconds();
  if (!open_ || now_s < next_s_) return false;
  next_s_ = now_s + wait_s_;
  output_ = open_();
  if (output_) tell_("the sound card is back");
  return output_ != nullptr;
}

void LastingOutput::write(std::span<const float> parts, std::span<const float> beeps, const Vec3& to_L) {
  if (!isOpen()) return;
  output_->write(parts, beeps, to_L);
  if (output_->isThere()) return;
  tell_("the sound card is gone; all else goes on in silence");
  if (!open_) return;
  output_.reset();  // first, since a card is opened once
  next_s_ = device::monotonicSeconds() + wait_s_;
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "work/heard_run.h"

#include <cmath>
#include <cstdio>

#include "output/terminal.h"

namespace vps::viewer {

HeardRun::HeardRun() {
  tap_.is_wanted = true;
  tap_.give = [this](scenes::Snapshot&& shot) {
    if (sound_) sound_->hear(shot);
    tap_.is_wanted = true;
  };
}

std::string HeardRun::wav() {
  double full_scale_Pa = 0;
  const RunSound::Samples samples = sound_ ? sound_->take() : RunSound::Samples();
  std::string bytes = wavBytes(samples, sound_ ? sound_->rate_hz() : SoundSettings().rate_hz, &full_scale_Pa);
  // Sound pressure level: in decibels above 20 uPa.
  if (full_scale_Pa > 0)
    std::printf("sound: at most %.0f dB at half a metre\n", 20 * std::log10(0.708 * full_scale_Pa / 20e-6));
  else
    std::printf("sound: none, since nothing touched\n");
  return bytes;
}

}  // namespace vps::viewer

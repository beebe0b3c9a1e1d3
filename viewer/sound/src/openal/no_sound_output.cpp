// SPDX-License-Identifier: BSD-3-Clause
// Sound output in a build without OpenAL.
#include "sound/live_sound.h"

namespace vps::viewer {

std::unique_ptr<SoundOutput> openSoundOutput(int, std::string& why) {
  why = "this build has no sound output; install libopenal-dev, then build again";
  return nullptr;
}

std::unique_ptr<SoundOutput> openSoundLoopback(int rate_hz, HeardPeriod, std::string& why) {
  return openSoundOutput(rate_hz, why);
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Loudspeakers in a build without OpenAL.
#include "sound/live_sound.h"

namespace vps::viewer {

std::unique_ptr<SoundOutput> openSoundOutput(int, std::string& why) {
  why = "this build is silent; install libopenal-dev and build again";
  return nullptr;
}

std::unique_ptr<SoundOutput> openSoundLoopback(int rate_hz, HeardPeriod, std::string& why) {
  return openSoundOutput(rate_hz, why);
}

}  // namespace vps::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The three answers to "do the parts go together?".
#pragma once

#include <array>

namespace vps::scenes {

enum class Verdict {
  Fits,      ///< brought home by contact within tolerance, nothing overlaps, and it stays there
  Blocked,   ///< proven by geometry: as drawn, the part overlaps another by more than the error of the meshes
  NotShown,  ///< the hand did not manage it, and nothing proves that it cannot be done
};

/// "fits", "blocked", "not_shown": as JSON has it.
inline const char* toText(Verdict verdict) {
  constexpr std::array kWords{"fits", "blocked", "not_shown"};
  return kWords[static_cast<std::size_t>(verdict)];
}

}  // namespace vps::scenes

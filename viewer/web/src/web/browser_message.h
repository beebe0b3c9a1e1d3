// SPDX-License-Identifier: BSD-3-Clause
// What a browser says. None of it is trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "vps/pose.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

enum class BrowserWord {
  Ack,    ///< `number`: the snapshot that was drawn
  Ping,   ///< `number`: to be sent back
  Sound,  ///< `number`: 1, it wants to hear; 0, not
  Point,  ///< `vector`: a place in W that the others shall see; without one: no longer
  Take,   ///< the hand
  Leave,  ///< the hand
  Grab,   ///< `vector`: the place of the part in hand, in W
  Move,   ///< `vector`: the way of the grabbed point [m]
  Turn,   ///< `vector`: rotation vector [rad]
  Drop,   ///< what was grabbed
  Play,   ///< `number`: 1, a recording goes on; 0, it stands
  Seek,   ///< `number`: the time of a recording that is shown [s]
};

struct BrowserMessage {
  BrowserWord word = BrowserWord::Ping;
  double number = 0;
  std::optional<Vec3> vector;
};

inline constexpr std::size_t kLongestBrowserMessage = 512;  ///< [bytes]

/// A JSON object with one key. Empty: it is none, the key is not known, or a number is not finite or beyond
/// 1e9. Does not throw.
VPS_VIEWER_API std::optional<BrowserMessage> readBrowserMessage(std::string_view text) noexcept;

}  // namespace vps::viewer

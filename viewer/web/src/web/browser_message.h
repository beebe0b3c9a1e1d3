// SPDX-License-Identifier: BSD-3-Clause
// Messages from a browser, which are not trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "vps/pose.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

enum class BrowserWord {
  Ack,    ///< `number`: number of the snapshot that was drawn
  Ping,   ///< `number`: any number, which the server sends back
  Sound,  ///< `number`: 1 if the browser plays sound, else 0
  Point,  ///< `vector`: a place in W to mark for others; none: removes the mark
  Take,   ///< takes control of the part in hand
  Leave,  ///< gives up control
  Grab,   ///< `vector`: grabbed point of the part in hand, in W
  Move,   ///< `vector`: translation of the grabbed point [m]
  Turn,   ///< `vector`: rotation vector [rad]
  Drop,   ///< releases the grabbed point
  Play,   ///< `number`: 1 plays a recording, 0 pauses it
  Seek,   ///< `number`: time of a recording to show [s]
};

struct BrowserMessage {
  BrowserWord word = BrowserWord::Ping;
  double number = 0;
  std::optional<Vec3> vector;
};

inline constexpr std::size_t kLongestBrowserMessage = 512;  ///< [bytes]

/// Reads a message. Empty if the text is not a JSON object with one key, the key is unknown, or a number is
/// not finite or its magnitude exceeds 1e9. Does not throw.
VPS_VIEWER_API std::optional<BrowserMessage> readBrowserMessage(std::string_view text) noexcept;

}  // namespace vps::viewer

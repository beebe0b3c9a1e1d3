// SPDX-License-Identifier: BSD-3-Clause
// How the numbers of messages are written.
#pragma once

#include <cstdint>

namespace vps::scenes {

/// How the numbers of states and snapshots are written; other messages have one form.
enum class WireForm : std::uint8_t {
  Exact,    ///< every bit, as a recording needs it
  Compact,  ///< a tenth of the bytes (dense_state.h, compact_fields.h)
};

}  // namespace vps::scenes

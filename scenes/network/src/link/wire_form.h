// SPDX-License-Identifier: BSD-3-Clause
// Number formats of messages.
#pragma once

#include <cstdint>

namespace vps::scenes {

/// Number format of states and snapshots; other messages have one form.
enum class WireForm : std::uint8_t {
  Exact,    ///< all bits, as a recording needs them
  Compact,  ///< a tenth of the bytes (dense_state.h, compact_fields.h)
};

}  // namespace vps::scenes

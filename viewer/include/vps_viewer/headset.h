// SPDX-License-Identifier: BSD-3-Clause
// Headsets on this machine.
#pragma once

#include <string>

#include "vps_viewer/export.h"

namespace vps::viewer::inline v0 {

/// What OpenXR says of a headset here, in one line with what helps. This build draws in a headset by the
/// browser page alone, so it is a remark and no refusal.
VPS_VIEWER_API std::string headsetWords();

}  // namespace vps::viewer::inline v0

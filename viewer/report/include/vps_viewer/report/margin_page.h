// SPDX-License-Identifier: BSD-3-Clause
// The margins of an assembly as HTML.
#pragma once

#include <string>

#include "vps_scenes/planning/margin.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A page with the answer, a bar for each step (the tightest first) and a table.
VPS_VIEWER_API std::string marginPage(const scenes::MarginResult& result);

}  // namespace vps::viewer

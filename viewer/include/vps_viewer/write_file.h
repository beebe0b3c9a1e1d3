// SPDX-License-Identifier: BSD-3-Clause
// Files that appear whole or not at all.
#pragma once

#include <string>
#include <string_view>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// Writes to a temporary file beside the target and renames it over, so that a reader, a full disk or a
/// killed program never leaves half a file under the name. Makes the folder. Throws std::runtime_error naming
/// the file and the system's reason.
VPS_VIEWER_API void writeFileAtomically(const std::string& file, std::string_view bytes);

}  // namespace vps::viewer

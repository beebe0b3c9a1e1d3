// SPDX-License-Identifier: BSD-3-Clause
// A time limit for reading CAD files and for the work that follows before their parts are known.
#pragma once

#include <chrono>
#include <string>

#include "vps/errors.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

struct TimeLimit {
  double most_s = 0;  ///< 0: no limit
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
};

/// A callback that calls `progress`, and throws LoadError once the limit is over: "FILE: took more than 60 s
/// to read (finding fasteners, 40 % done); ...", with the work that was going on. Returns `progress` for no
/// limit.
[[nodiscard]] VPS_SCENES_API Progress withTimeLimit(const Progress& progress, const TimeLimit& limit,
                                                    const std::string& file);

}  // namespace vps::scenes

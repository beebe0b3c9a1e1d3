// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/cad/time_limit.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace vps::scenes {

Progress withTimeLimit(const Progress& progress, const TimeLimit& limit, const std::string& file) {
  if (!(limit.most_s > 0)) return progress;
  return [progress, limit, file](std::string_view doing, double share) {
    if (progress) progress(doing, share);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - limit.begun;
    if (spent.count() <= limit.most_s) return;
    std::array<char, 96> time{}, done{};
    std::snprintf(time.data(), time.size(), "took more than %.3g s to read (", limit.most_s);
    if (share > 0 && share < 1) std::snprintf(done.data(), done.size(), ", %.0f %% done", 100 * share);
    throw LoadError(
        file, "",
        time.data() + std::string(doing) + done.data() +
            "); export fewer parts into one file, or read STEP and IGES with a greater deflection");
  };
}

}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// Rows in which lengths and times go to their extremes.
#include <cmath>

#include "drop.h"
#include "rows.h"

namespace vps::stability {

namespace {

Judgement dropAtStep(const Run& run) {
  Drop what;
  what.dt_s = 1e-3 * run.value;
  what.duration_s = std::max(0.5, 60 * what.dt_s);
  return judgeDrop(run.mode, what);
}

// 20 ms and 0.2 ms in turn, then anything between, by a fixed rule.
Judgement dropAtChangingStep(const Run& run) {
  Drop what;
  const double ratio = run.value;
  what.dt_s = 1e-3 * std::sqrt(ratio);  // the longest: all bounds are those of it
  what.step_s = [ratio](int i) {
    const double share = i % 7 == 0 ? 1 : i % 2 == 0 ? 0 : (i % 5) / 5.0;
    return 1e-3 * std::pow(ratio, share - 0.5);
  };
  what.duration_s = 1000 * what.dt_s;
  return judgeDrop(run.mode, what);
}

Judgement dropAwayFromOrigin(const Run& run) {
  Drop what;
  what.X_WS = Pose::translation(run.value * Vec3(0.6, -0.64, 0.48));
  return judgeDrop(run.mode, what);
}

// Of a scene like another, times go with the root of lengths; steps do so down to 0.1 ms.
Judgement dropOfSize(const Run& run) {
  Drop what;
  what.size = run.value / 20e-3;
  what.dt_s = std::max(1e-4, std::min(5e-3, 1e-3 * std::sqrt(what.size)));
  what.duration_s = std::max(100 * what.dt_s, 0.5 * std::sqrt(what.size));
  return judgeDrop(run.mode, what);
}

}  // namespace

std::vector<Row> scaleRows() {
  return {
      {"long_step", "time step [ms]", "rest", {1, 5, 20, 50, 100, 200}, 3, dropAtStep},
      {"short_step", "time step [ms]", "rest", {1, 0.1, 0.01}, 2, dropAtStep},
      {"rate_change", "longest over shortest step in one run, around 1 ms", "rest", {1, 10, 100, 1e3, 1e4}, 3,
       dropAtChangingStep},
      {"far_away", "distance from the origin [m]", "rest", {0, 1, 30, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}, 4,
       dropAwayFromOrigin},
      {"small", "size of a part [m]", "rest", {20e-3, 1e-3, 1e-4, 1e-5, 1e-6}, 4, dropOfSize},
      {"large", "size of a part [m]", "rest", {20e-3, 1, 10, 100, 1e3, 1e4}, 4, dropOfSize},
  };
}

}  // namespace vps::stability

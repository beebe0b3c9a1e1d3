// SPDX-License-Identifier: BSD-3-Clause
// Rows with extreme lengths and times.
#include <algorithm>
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

// The steps alternate between the longest and the shortest value, then take values between them, by a fixed
// rule.
Judgement dropAtChangingStep(const Run& run) {
  Drop what;
  const double ratio = run.value;
  what.dt_s = 1e-3 * std::sqrt(ratio);  // the longest step, which sets all bounds
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

// A cube of 1 mm falls by a millimetre on a plate of this side, each modelled according to its size. The cube
// lands flat, since the spacing of the plate's points is greater than the cube.
Judgement dropOnLarge(const Run& run) {
  constexpr double cube_m = 1e-3;
  const double plate_m = run.value, thick_m = plate_m / 6;
  const dynamics::Engine fine = dynamics::vpsEngine({50e-6, 0.1e-3});
  const dynamics::Engine coarse = dynamics::vpsEngine({plate_m / 60, plate_m / 30});
  dynamics::World world({run.mode, true, fine});
  Placed plate{nullptr, dynamics::makePart(makeBox(Vec3(plate_m, plate_m, thick_m)))};
  plate.part.frame.mass_kg = 0;
  plate.body = world.addShape(coarse.makeShape(plate.part, true), plate.part.frame,
                              Pose::translation(Vec3(0, 0, -thick_m / 2)) * plate.part.frame.X_PB);
  const Pose start(rotationFromVector(Vec3(0.1, 0.06, 0.2)), Vec3(0.01 * plate_m, 0, 2e-3));
  const Placed cube = world.add(dynamics::makePart(makeBox(Vec3::Constant(cube_m))), start);
  Watching watching;
  watching.steps = 300;
  const Watched watched = watch(world, {plate, cube}, watching);
  const double mass_kg = cube.part.frame.mass_kg, weight_N = mass_kg * dynamics::World::kGravity_m_s2;
  const double step_m = watched.fastest_m_s * watching.dt_s;
  // A corner has a quarter of a point's area and absorbs a fall of 2 mm.
  const double spring_m =
      run.mode == Mode::Penalty ? std::sqrt(2 * weight_N * 2e-3 / (1e12 * 0.1e-3 * 0.1e-3 / 4)) : 0;
  Judgement judgement;
  judgeRun(judgement, watched, weight_N, 1e-6 + spring_m + std::min(cube_m / 2, step_m * step_m / cube_m),
           1e-3);
  judgeRest(judgement, watched, watching.dt_s);
  judgement.atMost("error of the height above the plate", std::abs(cube.pose().p.z() - cube_m / 2), 5e-6,
                   "m");
  return judgement;
}

// In similar scenes, times scale with the square root of lengths; so do steps, down to 0.1 ms.
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
      {"rate_change",
       "longest over shortest step in one run, around 1 ms",
       "rest",
       {1, 10, 100, 1e3, 1e4},
       3,
       dropAtChangingStep},
      {"far_away",
       "distance from the origin [m]",
       "rest",
       {0, 1, 30, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8},
       4,
       dropAwayFromOrigin},
      {"mixed",
       "side of a plate on which a cube of 1 mm falls [m]",
       "rest, height",
       {10e-3, 1, 10, 100, 1e3, 1e4},
       3,
       dropOnLarge},
      {"small", "size of a part [m]", "rest", {20e-3, 1e-3, 1e-4, 1e-5, 1e-6}, 4, dropOfSize},
      {"large", "size of a part [m]", "rest", {20e-3, 1, 10, 100, 1e3, 1e4}, 4, dropOfSize},
  };
}

}  // namespace vps::stability

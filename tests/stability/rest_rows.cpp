// SPDX-License-Identifier: BSD-3-Clause
// Rows about long rest, and about the same scene moved, rotated and mirrored.
#include <algorithm>
#include <cmath>

#include "drop.h"
#include "dynamics/scenes.h"
#include "rows.h"

namespace vps::stability {

namespace {

// A seated peg at rest for some seconds, or for as many thousands of seconds in the thorough form.
Judgement restLong(const Run& run) {
  dynamics::World world({run.mode, true, dynamics::vpsEngine()});
  world.add(dynamics::borePart(50e-6), Pose(), true);
  const Placed peg =
      world.add(dynamics::pegPart(), Pose::translation(Vec3(3e-6, 2e-6, -dynamics::kBoreDepth_m)));
  world.step(1000);
  const Pose rest = peg.pose();
  const double duration_s = run.value * (run.is_thorough ? 1000 : 1);
  double drift_m = 0, speed_m_s = 0;
  for (int i = 0; i < static_cast<int>(duration_s * 1e3); ++i) {
    world.step();
    if (i % 100 == 0) world.resetTimes();
    const Pose X = peg.pose();
    drift_m = std::max(drift_m, (X.p - rest.p).norm() + (X.R - rest.R).norm() * dynamics::kPegLength_m);
    speed_m_s = std::max(speed_m_s, peg.speed_m_s());
  }
  Judgement judgement;
  judgement.atMost("drift", drift_m, 1e-6, "m");
  judgement.atMost("speed at rest", speed_m_s, 1e-3 * dynamics::World::kGravity_m_s2 * 1e-3, "m/s");
  if (run.is_thorough) judgement.note(toText(duration_s / 3600) + " hours");
  return judgement;
}

struct Copy {
  const char* name;
  Pose X_WS;
  bool is_mirrored;
};

const std::vector<Copy>& copies() {
  const Mat3 turned = rotationFromVector(Vec3(0.7, -1.1, 0.4));
  static const std::vector<Copy> all{
      {"moved by 10 m", Pose::translation(Vec3(6, -6.4, 4.8)), false},
      {"turned by a quarter about the vertical",
       {rotationFromVector(Vec3(0, 0, M_PI / 2)), Vec3(0, 0, 0)},
       false},
      {"turned by any angle, gravity too", {turned, Vec3(0.1, 0.2, 0.3)}, false},
      {"mirrored", {}, true},
      {"mirrored and turned", {turned, Vec3(0.1, 0.2, 0.3)}, true},
  };
  return all;
}

// Greatest distance between the same corner at two poses.
double apart_m(const Pose& a, const Pose& b) {
  return (a.p - b.p).norm() + (a.R - b.R).norm() * 13e-3;
}

// Compares the scene with its copy, in the copy's own frame, until the block has toppled onto its face.
Judgement compareCopy(const Run& run) {
  const Copy& copy = copies()[static_cast<std::size_t>(run.value)];
  Drop what;
  what.duration_s = 0.3;
  const Dropped one = drop(run.mode, what);
  what.X_WS = copy.X_WS;
  what.is_mirrored = copy.is_mirrored;
  const Dropped other = drop(run.mode, what);
  double early_m = 0, ever_m = 0;
  for (std::size_t i = 0; i < one.X_SB_path.size(); ++i) {
    const double apart = apart_m(one.X_SB_path[i], other.X_SB_path[i]);
    if (i <= 5) early_m = std::max(early_m, apart);
    ever_m = std::max(ever_m, apart);
  }
  Judgement judgement;
  judgement.require(other.watched.is_finite, "a pose is not a number");
  // The block hits the plate after 14 ms. Constraint contact is at the exact surface, within the micrometre
  // allowed for rest. In penalty contact the points of a copy lie elsewhere, and a corner has about a quarter
  // of a point's area: it yields by d = v sqrt(m / (k A)), 43 um at 0.14 m/s. The tolerance is half of this
  // depth.
  judgement.atMost("distance after 50 ms", early_m, run.mode == Mode::Penalty ? 20e-6 : 1e-6, "m");
  // After the impact the block topples, and the difference grows by at most a hundred times until it lies on
  // the plate.
  judgement.atMost("distance after 0.3 s", ever_m, run.mode == Mode::Penalty ? 2e-3 : 0.1e-3, "m");
  judgement.note(toText(ever_m) + " m in 0.3 s");
  return judgement;
}

std::string nameOfCopy(double value) {
  return copies()[static_cast<std::size_t>(value)].name;
}

}  // namespace

std::vector<Row> restRows() {
  return {
      {"long_rest", "time at rest [s; thorough: 1000 s]", "drift, rest", {10}, 1, restLong},
      {"copies",
       "the same scene moved, turned, mirrored",
       "the same path",
       {0, 1, 2, 3, 4},
       5,
       compareCopy,
       {99, 99},
       nameOfCopy},
  };
}

}  // namespace vps::stability

// SPDX-License-Identifier: BSD-3-Clause
// Rows with extreme shapes and fits: edges, tips, initial overlaps, fits, long bores.
#include <algorithm>
#include <cmath>

#include "drop.h"
#include "rows.h"
#include "support/lathe.h"
#include "vps/feature_motion.h"
#include "vps_bullet/convert.h"
#include "watch.h"

namespace vps::stability {

namespace {

// A wedge with this angle at its edge, which lies along y at z = 0; 10 mm high, 20 mm long.
Mesh wedge(double angle_rad) {
  const double half_m = 10e-3 * std::tan(angle_rad / 2);
  Mesh mesh = makeBox(Vec3(2 * half_m, 20e-3, 10e-3));
  for (Vec3& p : mesh.vertices) {
    if (p.z() < 0) p.x() = 0;
    p.z() += 5e-3;
  }
  return welded(mesh);
}

// A cone with its tip down at z = 0.
Mesh cone(double angle_rad) {
  return test::lathe({{0, 0}, {10e-3 * std::tan(angle_rad / 2), 10e-3}, {0, 10e-3}}, 64);
}

// Depth in penalty contact of a part that falls on an edge or tip: a point there has at least a quarter of
// its area, and k A d^2 / 2 is the energy E.
double pierced_m(Mode mode, double energy_J) {
  return 1e-6 + (mode == Mode::Penalty ? std::sqrt(2 * energy_J / (1e12 * 1e-6 / 4)) : 0);
}

// The part falls by 1 mm, edge or tip first, and topples.
Judgement fallOn(const Run& run, const Mesh& sharp) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  const Placed floor = world.add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const Placed part =
      world.add(makePart(sharp), Pose(rotationFromVector(Vec3(0.02, 0.03, 0)), Vec3(0, 0, 1.5e-3)));
  const double weight_N = part.part.frame.mass_kg * kGravity_m_s2;
  const Watched watched = watch(world, {floor, part}, {.steps = 1000, .measure_every = 2});
  Judgement judgement;
  const double turned_m = watched.fastest_m_s * watched.fastest_m_s * 1e-6 / 10e-3;
  // After it topples, the part may fall from its height of 10 mm.
  judgeRun(judgement, watched, weight_N, turned_m + pierced_m(run.mode, weight_N * 11e-3), 1e-3);
  return judgement;
}

Judgement fallOnKnife(const Run& run) {
  return fallOn(run, wedge(run.value * M_PI / 180));
}
Judgement fallOnTip(const Run& run) {
  return fallOn(run, cone(run.value * M_PI / 180));
}

// A knife falls across another knife whose edge is up; the edges cross between their sample points.
Judgement crossKnives(const Run& run) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  const PartMesh knife = makePart(wedge(run.value * M_PI / 180));
  const Placed lower =
      world.add(knife, Pose(rotationFromVector(Vec3(M_PI, 0, 0)), Vec3(0.3e-3, 0.2e-3, 0)), true);
  const Placed upper = world.add(knife, Pose(rotationFromVector(Vec3(0, 0, M_PI / 2)), Vec3(0, 0, 0.5e-3)));
  double lowest_m = 1e300;
  Watching watching;
  watching.steps = 60;
  watching.before_step = [&](int) { lowest_m = std::min(lowest_m, upper.pose().p.z()); };
  const Watched watched = watch(world, {lower, upper}, watching);
  Judgement judgement;
  const double weight_N = upper.part.frame.mass_kg * kGravity_m_s2;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgement.atMost("energy gained", watched.gained_J, weight_N * (0.5e-3 + watched.fastest_m_s * 0.5e-3),
                   "J");
  // Edges are sampled every half spacing: a point is at most a quarter of a spacing from the crossing, and so
  // is the flank of the other knife.
  judgement.atMost("one edge below the other", -lowest_m, 0.5e-3 + pierced_m(run.mode, weight_N * 0.5e-3),
                   "m");
  return judgement;
}

// Blocks of equal size in a tower, with coincident faces, edges and corners.
Judgement tower(const Run& run) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  const PartMesh cube = block();
  std::vector<Placed> parts{world.add(cube, Pose::translation(Vec3(0, 0, -5e-3)), true)};
  for (int i = 0; i < static_cast<int>(run.value); ++i)
    parts.push_back(world.add(cube, Pose::translation(Vec3(0, 0, 5e-3 + i * 10e-3))));
  const Watched watched = watch(world, parts, {.steps = 500, .measure_every = 20});
  const double weight_N = run.value * parts[1].part.frame.mass_kg * kGravity_m_s2;
  const double sunk_m = 1e-6 + (run.mode == Mode::Penalty ? 2 * weight_N / (1e12 * 300e-6) : 0);
  Judgement judgement;
  // The blocks start without gaps. The push lifts each block by the gap at which sharp edges rest, so the
  // i-th block by i gaps.
  const double lifted_m = run.mode == Mode::Penalty ? 0 : run.value * FeatureMotion::kRest_m;
  judgeRun(judgement, watched, weight_N, sunk_m + lifted_m, 1e-3);
  judgeRest(judgement, watched, 1e-3);
  judgement.atMost("moved", (parts.back().pose().p - Vec3(0, 0, run.value * 10e-3 - 5e-3)).norm(),
                   run.value * sunk_m, "m");
  return judgement;
}

// Each point of bodies that start inside each other separates at 0.05 m/s (settings.h). If the points of a
// rotated part separate in different directions, its far end moves faster by the ratio of length to width, at
// most 3 here.
constexpr double kLeaving_m_s = 0.05, kLeavingAtMost_m_s = 3 * kLeaving_m_s;

// A block that is created at this depth in another one, without gravity, must separate slowly or stay.
Judgement createInside(const Run& run, const Vec3& size_m, const Pose& X_WB) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  world.setGravity(Vec3::Zero());
  const Placed fixed = world.add(makePart(makeBox(Vec3(20e-3, 15e-3, 10e-3))), Pose(), true);
  const Placed inside = world.add(makePart(makeBox(size_m)), X_WB);
  const Watched watched = watch(world, {fixed, inside}, {.steps = 1000});
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgement.atMost("energy gained", watched.gained_J,
                   inside.part.frame.mass_kg * kLeavingAtMost_m_s * kLeavingAtMost_m_s / 2, "J");
  judgement.note("overlap " + toText(std::max(0.0, watched.final_m)) + " m left after a second");
  return judgement;
}

Judgement startDeep(const Run& run) {
  const Mat3 R = rotationFromVector(Vec3(0.05, 0.03, 0.2));
  return createInside(run, kBlock_m, Pose(R, Vec3(2e-3, 1e-3, 10e-3 - 1e-3 * run.value)));
}

// A cube of 2 mm starts completely inside; at 0 it is in the centre, where no direction is shorter.
Judgement startWithin(const Run& run) {
  return createInside(run, Vec3::Constant(2e-3), Pose::translation(Vec3(0, 0, 5e-3 - 1e-3 * run.value)));
}

constexpr double kPeg_m = 5e-3;

PartMesh bored(double radius_m, double length_m) {
  return makePart(test::lathe(
      {{radius_m, -length_m}, {radius_m + 7e-3, -length_m}, {radius_m + 7e-3, 0}, {radius_m, 0}}, 128));
}

// A peg is 10 mm deep in a bore with this diametral clearance [um]. A negative value is an interference fit,
// which has no position at rest and must not fly apart.
Judgement fit(const Run& run) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  const Placed bore = world.add(bored(kPeg_m + 0.5e-6 * run.value, 20e-3), Pose(), true, 0.15);
  const PartMesh peg = makePart(test::lathe({{0, 0}, {kPeg_m, 0}, {kPeg_m, 30e-3}, {0, 30e-3}}, 128));
  const Placed part = world.add(peg, Pose::translation(Vec3(0, 0, -10e-3)), false, 0.15);
  const Watched watched = watch(world, {bore, part}, {.steps = 300, .measure_every = 20});
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  // The peg must never be faster than in free fall; separation from an overlap may also lift the peg.
  const double mass_kg = part.part.frame.mass_kg, duration_s = 0.3;
  judgement.atMost("speed", watched.fastest_m_s, kGravity_m_s2 * duration_s + kLeavingAtMost_m_s, "m/s");
  judgement.atMost(
      "energy gained", watched.gained_J,
      mass_kg * (kLeavingAtMost_m_s * kLeavingAtMost_m_s / 2 + kGravity_m_s2 * kLeaving_m_s * duration_s),
      "J");
  judgement.note("went down " + toText(-10e-3 - part.pose().p.z()) + " m");
  return judgement;
}

// A rod slides down a bore of its own length without friction, pressed to the wall by a tenth of its weight.
// The row's value is length over diameter.
Judgement slideInBore(const Run& run) {
  const double length_m = run.value * 2 * kPeg_m;
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  world.setGravity(Vec3(0.1 * kGravity_m_s2, 0, -kGravity_m_s2));
  const Placed bore = world.add(bored(kPeg_m + 5e-6, length_m), Pose(), true, 0);
  const PartMesh rod = makePart(test::lathe({{0, 0}, {kPeg_m, 0}, {kPeg_m, length_m}, {0, length_m}}, 128));
  const Placed part = world.add(rod, Pose::translation(Vec3(0, 0, -length_m)), false, 0);
  const int steps = 50;
  const Watched watched = watch(world, {bore, part}, {.steps = steps, .measure_every = 10});
  const double weight_N = part.part.frame.mass_kg * kGravity_m_s2;
  // In penalty contact half of the rod's length and a tenth of its width carry the load.
  const double sunk_m =
      2e-6 + (run.mode == Mode::Penalty ? 2 * 0.1 * weight_N / (1e12 * length_m * 1e-3) : 0);
  Judgement judgement;
  judgeRun(judgement, watched, weight_N, sunk_m, 1e-3);
  const double fallen_m_s = kGravity_m_s2 * steps * 1e-3;
  judgement.atMost("speed off by", std::abs(part.body->getLinearVelocity().z() + fallen_m_s),
                   0.01 * fallen_m_s, "m/s");
  return judgement;
}

}  // namespace

std::vector<Row> shapeRows() {
  return {
      {"knife",
       "angle of an edge that falls on a plate [degrees]",
       "",
       {90, 30, 10, 3, 1, 0.3},
       3,
       fallOnKnife},
      {"cone", "angle of a cone that falls on its tip [degrees]", "", {90, 30, 10, 3, 1}, 3, fallOnTip},
      {"crossed_knives",
       "angle of two edges that cross [degrees]",
       "half a point spacing",
       {90, 60, 30, 10, 3},
       3,
       crossKnives,
       {99, 2}},
      {"coincident",
       "blocks in a tower with coincident faces, edges and corners",
       "rest, place",
       {1, 2, 5, 8, 10, 20, 40},
       6,
       tower,
       {99, 99},
       toText},
      {"start_deep",
       "depth in another at the start [mm]",
       "leaves at 0.05 m/s",
       {0.01, 1, 4, 5, 8, 10},
       6,
       startDeep},
      {"start_within",
       "depth below the surface of a part that is completely inside another [mm]",
       "leaves at 0.05 m/s",
       {1.5, 3, 5},
       3,
       startWithin},
      {"fit",
       "clearance of a peg in its bore [um], negative: interference",
       "no burst",
       {50, 0, -1, -10, -50, -200, -1000},
       5,
       fit},
      {"long_bore",
       "length of a bore of 10 um clearance [diameters]",
       "slides with g",
       {1, 5, 20, 50},
       3,
       slideInBore},
  };
}

}  // namespace vps::stability

// SPDX-License-Identifier: BSD-3-Clause
// Rows with extreme speeds: impacts, thin walls, fast spin.
#include <algorithm>
#include <cmath>

#include "drop.h"
#include "rows.h"
#include "support/lathe.h"
#include "vps_bullet/convert.h"
#include "watch.h"

namespace vps::stability {

namespace {

enum class First { Face, Edge, Corner };

// Rotation with a corner, or an edge along z, in front. The block is rotated slightly further, so that it
// topples.
Mat3 turned(First first) {
  const Vec3 corner = first == First::Corner ? kBlock_m : Vec3(kBlock_m.x(), kBlock_m.y(), 0);
  if (first == First::Face) return Mat3::Identity();
  return rotationFromVector(Vec3(0.02, 0.03, 0.01)) *
         Quat::FromTwoVectors(corner, Vec3::UnitX()).toRotationMatrix();
}

// A block flies along x at a wall whose face is x = 0, without gravity.
Judgement shoot(const Run& run, First first, double wall_m, double speed_m_s) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  world.setGravity(Vec3::Zero());
  const Placed wall = world.add(makePart(makeBox(Vec3(wall_m, 60e-3, 60e-3))),
                                Pose::translation(Vec3(wall_m / 2, 0, 0)), true);
  const Placed block = world.add(makePart(makeBox(kBlock_m)), Pose(turned(first), Vec3(-0.1, 1e-3, 2e-3)));
  block.body->setLinearVelocity(btVector3(btScalar(speed_m_s), 0, 0));
  double farthest_m = -1e300;
  Watching watching;
  watching.steps = static_cast<int>(std::ceil(0.1 / speed_m_s / watching.dt_s)) + 100;
  watching.measure_every = 1;
  watching.before_step = [&](int) { farthest_m = std::max(farthest_m, block.pose().p.x()); };
  const Watched watched = watch(world, {wall, block}, watching);
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  // The centre of the block is never nearer to the wall than half of its shortest side, with a tolerance of a
  // tenth.
  judgement.atMost("centre past the wall's face by", farthest_m, -0.9 * kBlock_m.minCoeff() / 2, "m");
  judgement.atMost("energy gained", watched.gained_J, 1e-9 * watched.start_J, "J");
  // At the end the block has left the wall or touches it. The allowed overlap is a micrometre, or the depth
  // at which penalty contact stops the block in one step.
  const double pressed_m = block.part.frame.mass_kg * speed_m_s / (watching.dt_s * 1e12 * 150e-6);
  judgement.atMost("overlap at the end", watched.final_m, 1e-6 + (run.mode == Mode::Penalty ? pressed_m : 0),
                   "m");
  return judgement;
}

Judgement shootFace(const Run& run) {
  return shoot(run, First::Face, 2e-3, run.value);
}
Judgement shootEdge(const Run& run) {
  return shoot(run, First::Edge, 2e-3, run.value);
}
Judgement shootCorner(const Run& run) {
  return shoot(run, First::Corner, 2e-3, run.value);
}
Judgement shootThinWall(const Run& run) {
  return shoot(run, First::Face, run.value * kVoxel_m, 5);
}
Judgement shootThinWallByCorner(const Run& run) {
  return shoot(run, First::Corner, run.value * kVoxel_m, 5);
}

// A shaft in a bore that is 0.1 mm wider, without friction or gravity, must keep its spin and stay centred.
Judgement spin(const Run& run, double dt_s) {
  World world({run.mode, true, dynamics::vpsEngine(kCoarse)});
  world.setGravity(Vec3::Zero());
  const PartMesh ring = makePart(makeTube(15e-3, 5.05e-3, 10e-3, 128));
  const PartMesh shaft = makePart(makeCylinder(5e-3, 30e-3, 128));
  const double spin_rad_s = run.value * 2 * M_PI / 60;
  const Placed outer = world.add(ring, Pose(), true, 0);
  const Placed inner = world.add(shaft, Pose::translation(Vec3(20e-6, 0, 0)), false, 0);
  inner.body->setAngularVelocity(btVector3(0, 0, btScalar(spin_rad_s)));
  inner.body->setLinearVelocity(btVector3(btScalar(5e-3), 0, 0));
  double turned_rad = 0;
  Mat3 R_before = inner.pose().R;
  Watching watching;
  watching.dt_s = dt_s;
  watching.steps = static_cast<int>(std::lround(0.1 / dt_s));
  watching.before_step = [&](int i) {
    const Mat3 R = inner.pose().R;
    if (i > 0) turned_rad += std::abs(rotationVector(R * R_before.transpose()).z());
    R_before = R;
  };
  const Watched watched = watch(world, {outer, inner}, watching);
  const double wanted_rad = spin_rad_s * (watching.steps - 1) * dt_s;
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgement.atMost("angle error", std::abs(turned_rad - wanted_rad), 1e-3 * wanted_rad, "rad");
  judgement.atMost("spin lost", std::abs(inner.body->getAngularVelocity().length() - spin_rad_s),
                   1e-2 * spin_rad_s, "rad/s");
  judgement.atMost("energy gained", watched.gained_J, 1e-9 * watched.start_J, "J");
  // The corners of 128 facets pass each other; the facets are up to 1.5 um inside their circle.
  judgement.atMost("overlap", watched.deepest_m, 5e-6, "m");
  return judgement;
}

Judgement spinAt1kHz(const Run& run) {
  return spin(run, 1e-3);
}
Judgement spinAt4kHz(const Run& run) {
  return spin(run, 0.25e-3);
}

}  // namespace

std::vector<Row> impactRows() {
  const std::vector<double> speeds{1, 10, 50, 100, 200, 500, 1000, 5000, 2e4};
  const std::vector<double> walls{4, 1, 0.5, 0.2, 0.1, 0.02, 0.004, 0.0004};
  return {
      {"impact_face", "speed at a wall of 2 mm [m/s], a face first", "stays before it", speeds, 3, shootFace},
      {"impact_edge", "speed at a wall of 2 mm [m/s], an edge first", "stays before it", speeds, 3,
       shootEdge},
      {"impact_corner", "speed at a wall of 2 mm [m/s], a corner first", "stays before it", speeds, 3,
       shootCorner},
      {"thin_wall", "thickness of a wall [voxels], a face first at 5 m/s", "stays before it", walls, 4,
       shootThinWall},
      {"thin_wall_corner", "thickness of a wall [voxels], a corner first at 5 m/s", "stays before it", walls,
       4, shootThinWallByCorner},
      {"spin",
       "spin of a shaft in a bore [rpm], steps of 1 ms",
       "angle, spin",
       {100, 1e3, 5e3, 7e3, 1e4},
       5,
       spinAt1kHz,
       {4, 2}},
      {"spin_substeps",
       "spin of a shaft in a bore [rpm], steps of 0.25 ms",
       "angle, spin",
       {100, 1e3, 1e4, 2e4, 5e4, 1e5},
       3,
       spinAt4kHz,
       {3, 2}},
  };
}

}  // namespace vps::stability

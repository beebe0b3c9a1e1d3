// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>

#include "support/lathe.h"

namespace vps::dynamics {

namespace {

// Facets are 5 mm (1 - cos(pi / 256)) = 0.4 um inside their circle, for peg and bore alike.
constexpr int kSegments = 256;

PartMesh makeBore(double clearance_m) {
  constexpr double outside_m = 12e-3, floor_m = 5e-3, chamfer_m = 0.5e-3;
  const double r = kPegRadius_m + clearance_m / 2;
  return makePart(test::lathe({{0, -kBoreDepth_m - floor_m},
                               {outside_m, -kBoreDepth_m - floor_m},
                               {outside_m, 0},
                               {r + chamfer_m, 0},
                               {r, -chamfer_m},
                               {r, -kBoreDepth_m},
                               {0, -kBoreDepth_m}},
                              kSegments));
}

}  // namespace

const PartMesh& pegPart() {
  static const PartMesh part = [] {
    constexpr double r = kPegRadius_m, chamfer_m = 1e-3;
    return makePart(test::lathe(
        {{0, 0}, {r - chamfer_m, 0}, {r, chamfer_m}, {r, kPegLength_m}, {0, kPegLength_m}}, kSegments));
  }();
  return part;
}

const PartMesh& borePart(double clearance_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return keptPart(parts, {clearance_m}, [&] { return makeBore(clearance_m); });
}

PegDropResult dropPeg(const SceneSettings& settings, const PegDrop& drop) {
  constexpr double kSeated_m = 10e-6;
  World world(settings);
  const Placed bore = world.add(borePart(drop.clearance_m), Pose(), true, drop.friction);
  // The peg is tilted about another axis than the one along which it is shifted.
  const Pose start(rotationFromVector(drop.tilt_rad * Vec3(0.8, 0.6, 0)),
                   Vec3(drop.offset_m * 0.6, drop.offset_m * 0.8, drop.height_m));
  const Placed peg = world.add(pegPart(), start, false, drop.friction);
  PegDropResult result;
  result.seated_s = -1;
  result.deepest_m = -1e300;
  const int settle = settings.is_short ? 800 : 2000, watched = settings.is_short ? 400 : 2000;
  double contact_time_s = 0;
  int contact_steps = 0;
  Pose rest;
  for (int i = 0; i < settle + watched; ++i) {
    world.step();
    if (world.contactCount() > 0) contact_time_s += world.times().step_s.back(), ++contact_steps;
    const Pose X = peg.pose();
    const double above_m = X.p.z() + kBoreDepth_m;
    if (result.seated_s < 0 && std::abs(above_m) <= kSeated_m) result.seated_s = i * World::kStep_s;
    // Measuring the penetration in each step of the fall would take longer than the fall.
    if (i % (i < settle ? 5 : 50) == 0)
      result.deepest_m = std::max(result.deepest_m, penetration_m(bore.part, Pose(), peg.part, X));
    if (i == settle) rest = X;
    if (i < settle) continue;
    result.jitter_m_s = std::max(result.jitter_m_s, peg.speed_m_s());
    result.drift_m = std::max(result.drift_m, (X.p - rest.p).norm());
  }
  result.height_error_m = peg.pose().p.z() + kBoreDepth_m;
  if (std::abs(result.height_error_m) > kSeated_m) result.seated_s = -1;
  result.step_ms = contact_steps ? 1e3 * contact_time_s / contact_steps : 0;
  return result;
}

LongRestResult restPeg(const SceneSettings& settings) {
  World world(settings);
  world.add(borePart(50e-6), Pose(), true);
  const Placed peg = world.add(pegPart(), Pose::translation(Vec3(3e-6, 2e-6, -kBoreDepth_m)));
  world.step(1000);
  const Pose rest = peg.pose();
  LongRestResult result;
  const int steps = settings.is_short ? 10'000 : 600'000;
  result.rest_s = steps * World::kStep_s;
  double time_s = 0;
  for (int i = 0; i < steps; ++i) {
    world.step();
    time_s += world.times().step_s.back();
    world.resetTimes();
    const Pose X = peg.pose();
    const double turned_m = (X.R - rest.R).norm() * kPegLength_m;
    result.drift_m = std::max(result.drift_m, (X.p - rest.p).norm() + turned_m);
  }
  result.step_ms = 1e3 * time_s / steps;
  return result;
}

HeavyBlockResult loadPeg(const SceneSettings& settings, const HeavyBlock& load) {
  constexpr double kEdge_m = 40e-3, kClearance_m = 50e-6;
  World world(settings);
  const Placed bore = world.add(borePart(kClearance_m), Pose(), true);
  const Placed peg = world.add(pegPart(), Pose::translation(Vec3(3e-6, 2e-6, -kBoreDepth_m)));
  world.step(500);  // the peg comes to rest before the block arrives
  world.resetTimes();
  const double top_m = peg.pose().p.z() + kPegLength_m;
  const double fall_m = load.speed_m_s > 0 ? 2e-3 : 0;
  const PartMesh cube =
      withMass(makePart(makeBox(Vec3::Constant(kEdge_m))), load.ratio * peg.part.frame.mass_kg);
  const Placed block =
      world.add(cube, Pose::translation(Vec3(load.offset_m, 0, top_m + kEdge_m / 2 + fall_m)));
  block.body->setLinearVelocity(btVector3(0, 0, btScalar(-load.speed_m_s)));

  const auto energy_J = [&] {
    double sum_J = 0;
    for (const Placed& p : {peg, block}) sum_J += kineticEnergy_J(*p.body) + heightEnergy_J(*p.body);
    return sum_J;
  };
  HeavyBlockResult result;
  result.deepest_m = -1e300;
  const double start_J = energy_J();
  const int steps = settings.is_short ? 500 : 3000;
  for (int i = 0; i < steps; ++i) {
    world.step();
    result.energy_gained_J = std::max(result.energy_gained_J, energy_J() - start_J);
    if (i % 5 == 0 || i == steps - 1) {
      result.final_m = std::max(penetration_m(bore.part, Pose(), peg.part, peg.pose()),
                                penetration_m(peg.part, peg.pose(), block.part, block.pose()));
      result.deepest_m = std::max(result.deepest_m, result.final_m);
    }
    if (i < steps - steps / 6) continue;  // the block has landed by then
    for (const Placed& p : {peg, block}) result.speed_m_s = std::max(result.speed_m_s, p.speed_m_s());
    result.kinetic_J = std::max(result.kinetic_J, kineticEnergy_J(*peg.body) + kineticEnergy_J(*block.body));
  }
  result.peg_height_m = peg.pose().p.z() + kBoreDepth_m;
  result.block_height_m = block.pose().p.z() - kEdge_m / 2 - (kPegLength_m - kBoreDepth_m);
  result.step_ms = 1e3 * world.times().mean_s();
  return result;
}

}  // namespace vps::dynamics

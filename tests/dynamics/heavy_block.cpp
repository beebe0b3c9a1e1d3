// SPDX-License-Identifier: BSD-3-Clause
#include "heavy_block.h"

#include <algorithm>

#include "peg.h"

namespace vps::dynamics {

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
    if (i < steps - steps / 6) continue;  // it has landed by then
    for (const Placed& p : {peg, block}) result.speed_m_s = std::max(result.speed_m_s, p.speed_m_s());
    result.kinetic_J = std::max(result.kinetic_J, kineticEnergy_J(*peg.body) + kineticEnergy_J(*block.body));
  }
  result.peg_height_m = peg.pose().p.z() + kBoreDepth_m;
  result.block_height_m = block.pose().p.z() - kEdge_m / 2 - (kPegLength_m - kBoreDepth_m);
  result.step_ms = 1e3 * world.times().mean_s();
  return result;
}

}  // namespace vps::dynamics

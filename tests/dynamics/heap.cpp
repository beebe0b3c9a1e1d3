// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>

#include "support/gear.h"
#include "support/lathe.h"
#include "vps_bullet/convert.h"

namespace vps::dynamics {

namespace {

constexpr double kInside_m = 90e-3, kWall_m = 20e-3, kHeight_m = 500e-3;  // the box, open at the top

// A flanged bushing with a flange of 30 mm: a hole and an inner corner.
PartMesh makeBushing() {
  return makePart(
      test::lathe({{6e-3, 0}, {15e-3, 0}, {15e-3, 4e-3}, {9e-3, 4e-3}, {9e-3, 20e-3}, {6e-3, 20e-3}}, 96));
}
const PartMesh& heapPart(int i) {
  static const PartMesh parts[2] = {makeBushing(), makeHeapGear()};
  return parts[i % 2];
}

void addBox(World& world) {
  const auto addWall = [&](const Vec3& half_m, const Vec3& center) {
    world.addShape(std::make_shared<btBoxShape>(bullet::toBt(half_m)), {}, Pose::translation(center));
  };
  const double half = kInside_m / 2, w = kWall_m / 2;
  addWall({half + kWall_m, half + kWall_m, w}, {0, 0, -w});
  for (const double side : {-1.0, 1.0}) {
    addWall({w, half + kWall_m, kHeight_m / 2}, {side * (half + w), 0, kHeight_m / 2});
    addWall({half, w, kHeight_m / 2}, {0, side * (half + w), kHeight_m / 2});
  }
}

}  // namespace

PartMesh makeHeapGear() {
  test::GearShape gear;
  gear.module_m = 1.25e-3;
  gear.teeth = 20;
  gear.width_m = 8e-3;
  gear.other_radius_m = 4e-3;
  gear.points_per_tooth = 16;
  gear.axial_steps = 4;
  gear.radial_steps = 4;
  return makePart(test::makeSpurGear(gear));
}

Engine heapEngine() {
  const auto engines = std::make_shared<std::vector<Engine>>();
  for (int i = 0; i < 2; ++i) {
    // Edges have additional points, so the spacing for 5,000 points is slightly more than sqrt(area / 5,000).
    const double spacing_m = 1.15 * std::sqrt(area(heapPart(i).mesh) / 5000);
    engines->push_back(vpsEngine({0.5e-3, spacing_m}));
  }
  Engine engine = (*engines)[0];
  engine.makeShape = [engines](const PartMesh& part, bool is_fixed) {
    return (*engines)[part.exact == heapPart(0).exact ? 0 : 1].makeShape(part, is_fixed);
  };
  return engine;
}

HeapResult dropHeap(const SceneSettings& settings) {
  World world(settings);
  addBox(world);
  HeapResult result;
  result.bodies = settings.is_short ? 10 : 50;
  std::vector<Placed> parts;
  for (int i = 0; i < result.bodies; ++i) {
    // Parts lie two by two in layers, each part at another orientation; multiples of the golden angle do not
    // repeat.
    const double angle_rad = 2.399963 * i;
    const Vec3 at(i & 1 ? 20e-3 : -20e-3, i & 2 ? 20e-3 : -20e-3, 25e-3 + 35e-3 * (i / 4));
    const Mat3 R = rotationFromVector(Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.3) * (0.2 + 0.11 * i));
    parts.push_back(world.add(heapPart(i), Pose(R, at), false, 0.3));
    btRigidBody& body = *parts.back().body;
    body.forceActivationState(ACTIVE_TAG);
    body.setSleepingThresholds(btScalar(5e-3), btScalar(0.2));
    const auto* shape = dynamic_cast<const bullet::Shape*>(body.getCollisionShape());
    if (shape) result.points += static_cast<double>(shape->models().shell->size()) / result.bodies;
  }
  result.asleep_s = -1;
  const int steps = settings.is_short ? 8000 : 20'000;
  const auto asleep = [&] {
    return static_cast<int>(
        std::count_if(parts.begin(), parts.end(), [](const Placed& p) { return !p.body->isActive(); }));
  };
  for (int i = 0; i < steps; ++i) {
    world.step();
    if (asleep() == result.bodies) {
      if (result.asleep_s < 0) result.asleep_s = i * World::kStep_s;
    } else {
      result.asleep_s = -1;
    }
  }
  result.asleep = asleep();
  result.final_m = -1e300;
  for (std::size_t a = 0; a < parts.size(); ++a) {
    const Vec3 center = bullet::fromBt(parts[a].body->getWorldTransform().getOrigin());
    const Vec3 past =
        (center - Vec3(0, 0, kHeight_m / 2)).cwiseAbs() - Vec3(kInside_m, kInside_m, kHeight_m) / 2;
    if (past.maxCoeff() > 0) ++result.escaped;
    for (std::size_t b = 0; b < a; ++b)
      if ((center - bullet::fromBt(parts[b].body->getWorldTransform().getOrigin())).norm() < 40e-3)
        result.final_m = std::max(
            result.final_m, penetration_m(parts[a].part, parts[a].pose(), parts[b].part, parts[b].pose()));
  }
  const StepTimes& times = world.times();
  for (int k = 0; k < 3; ++k) result.step_ms[k] = 1e3 * times.percentile_s(k == 0 ? 0.5 : k == 1 ? 0.99 : 1);
  result.our_share =
      (times.narrow_s + times.solve_s) / (times.mean_s() * static_cast<double>(times.step_s.size()));
  return result;
}

}  // namespace vps::dynamics

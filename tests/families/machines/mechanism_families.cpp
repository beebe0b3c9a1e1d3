// SPDX-License-Identifier: BSD-3-Clause
// N: a motor turns gears or a screw against a load. The driven part must move in every step. If the solution
// of a step has not converged, the driven part nearly stands still in this step.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/gear.h"
#include "support/random_draw.h"
#include "support/screw.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;

constexpr double kPi = std::numbers::pi;
constexpr double kSlow = 0.8;  ///< steps below this share of the speed are counted

// --- Gears

constexpr double kModule_m = 2e-3;

const PartMesh& gearPart(int teeth, double width_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {double(teeth), width_m}, [&] {
    test::GearShape gear;
    gear.module_m = kModule_m;
    gear.teeth = teeth;
    gear.width_m = width_m;
    gear.backlash_m = 0.05e-3;
    gear.other_radius_m = 5e-3;
    gear.points_per_tooth = 32;
    gear.axial_steps = 3;
    gear.radial_steps = 3;
    return dynamics::makePart(test::makeSpurGear(gear));
  });
}

std::unique_ptr<btHingeConstraint> hingeOf(const Placed& gear) {
  const Pose X_BP = gear.part.frame.X_PB.inverse();
  return std::make_unique<btHingeConstraint>(*gear.body, bullet::toBt(X_BP.p),
                                             bullet::toBt(Vec3(X_BP.R.col(2))));
}

struct Pair {
  int driver = 17, driven = 41;
  double speed_rad_s = 2 * kPi, brake_Nm = 1, mu = 0;
};

// Member 0 is the pair with which the fault was found.
Pair pairOf(int member) {
  Pair pair;
  if (member == 0) return pair;
  test::Random random(static_cast<std::uint64_t>(member));
  constexpr int kTeeth[][2] = {{17, 41}, {20, 30}, {23, 23}};
  const auto& teeth = kTeeth[member % 3];
  pair.driver = teeth[0];
  pair.driven = teeth[1];
  pair.speed_rad_s = random.logUniform(1, 40);
  pair.brake_Nm = random.logUniform(0.05, 5);
  pair.mu = random.chance(0.5) ? 0 : random.uniform(0.02, 0.2);
  return pair;
}

std::string describePair(int member) {
  const Pair p = pairOf(member);
  char text[96];
  std::snprintf(text, sizeof text, "%d:%d, %.2f rad/s, brake %.2f Nm, friction %.2f", p.driver, p.driven,
                p.speed_rad_s, p.brake_Nm, p.mu);
  return text;
}

double slowGearSteps(int member) {
  static const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  const Pair pair = pairOf(member);
  const int steps = member == 0 ? 1950 : 250, settling = 50;
  World world({dynamics::Mode::Constraint, false, engine});
  world.setGravity(Vec3::Zero());
  const double distance_m = kModule_m * (pair.driver + pair.driven) / 2;
  // Tooth 0 of the driver points at the axis of the driven gear. A gear with an odd number of teeth has a gap
  // opposite to its tooth 0.
  const double turn_rad = pair.driven % 2 == 0 ? kPi / pair.driven : 0;
  const Placed driver = world.add(gearPart(pair.driver, 12e-3), Pose(), false, pair.mu);
  const Placed driven =
      world.add(gearPart(pair.driven, 10e-3),
                Pose(rotationFromVector({0, 0, turn_rad}), Vec3(distance_m, 0, 0)), false, pair.mu);
  auto motor = hingeOf(driver);
  motor->enableAngularMotor(true, btScalar(pair.speed_rad_s), btScalar(100));
  world.addConstraint(std::move(motor));
  world.addConstraint(hingeOf(driven));
  const double wanted_rad_s = -pair.speed_rad_s * pair.driver / pair.driven;
  driver.body->setAngularVelocity(btVector3(0, 0, btScalar(pair.speed_rad_s)));
  driven.body->setAngularVelocity(btVector3(0, 0, btScalar(wanted_rad_s)));
  int slow = 0;
  for (int i = 0; i < steps; ++i) {
    driven.body->applyTorque(btVector3(0, 0, btScalar(pair.brake_Nm)));
    world.step();
    slow +=
        i >= settling && static_cast<double>(driven.body->getAngularVelocity().z()) / wanted_rad_s < kSlow;
  }
  return slow;
}

// --- A screw that a motor turns; the nut slides along the screw against a load

struct Screw {
  double speed_rad_s = 10, load_N = 50, mu = 0.1;
};

Screw screwOf(int member) {
  Screw screw;
  if (member == 0) return screw;
  test::Random random(static_cast<std::uint64_t>(member));
  screw.speed_rad_s = (random.chance(0.5) ? 1 : -1) * random.logUniform(1, 40);
  screw.load_N = random.logUniform(1, 200);
  screw.mu = random.chance(0.3) ? 0 : random.uniform(0.02, 0.2);
  return screw;
}

std::string describeScrew(int member) {
  const Screw s = screwOf(member);
  char text[96];
  std::snprintf(text, sizeof text, "%.2f rad/s, %.1f N, friction %.2f", s.speed_rad_s, s.load_N, s.mu);
  return text;
}

test::ThreadShape threadOf(double length_m, double clearance_m) {
  test::ThreadShape thread;
  thread.major_m = 6e-3;
  thread.pitch_m = 3e-3;
  thread.length_m = length_m;
  thread.clearance_m = clearance_m;
  thread.columns = 96;
  thread.rows_per_pitch = 16;
  thread.face_steps = thread.side_steps = 3;
  return thread;
}

double slowScrewSteps(int member) {
  static const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  static const PartMesh rod_part = dynamics::makePart(test::makeThreadedRod(threadOf(30e-3, 0)));
  static const PartMesh nut_part = dynamics::makePart(test::makeNut(threadOf(9e-3, 0.1e-3), 11e-3));
  const Screw screw = screwOf(member);
  constexpr int kSteps = 150, kSettling = 50;
  World world({dynamics::Mode::Constraint, false, engine});
  world.setGravity(Vec3::Zero());
  const Placed rod = world.add(rod_part, Pose(), false, screw.mu);
  const Placed nut = world.add(nut_part, Pose(), false, screw.mu);
  auto motor = hingeOf(rod);
  motor->enableAngularMotor(true, btScalar(screw.speed_rad_s), btScalar(100));
  world.addConstraint(std::move(motor));
  // The nut slides along z. A slider constraint moves along the x axis of its frame.
  const Mat3 z_is_x = rotationFromVector({0, -0.5 * kPi, 0});
  auto slider = std::make_unique<btSliderConstraint>(
      *nut.body, bullet::toBt(nut.part.frame.X_PB.inverse() * Pose(z_is_x, Vec3::Zero())), true);
  slider->setLowerLinLimit(-1);
  slider->setUpperLinLimit(1);
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  world.addConstraint(std::move(slider));
  // A rod that turns about +z in a nut that does not turn moves the nut down.
  const double wanted_m_s = -screw.speed_rad_s * 3e-3 / (2 * kPi);
  rod.body->setAngularVelocity(btVector3(0, 0, btScalar(screw.speed_rad_s)));
  int slow = 0;
  for (int i = 0; i < kSteps; ++i) {
    nut.body->applyCentralForce(btVector3(0, 0, btScalar(wanted_m_s < 0 ? screw.load_N : -screw.load_N)));
    world.step();
    slow += i >= kSettling && static_cast<double>(nut.body->getLinearVelocity().z()) / wanted_m_s < kSlow;
  }
  return slow;
}

}  // namespace

std::vector<Family> mechanismFamilies() {
  Family gears;
  gears.key = "N_gears";
  gears.measure = "steps in which the driven gear is over 20 % slow";
  gears.bar = 0;
  gears.members = 50;
  gears.every = 10;
  gears.measured = slowGearSteps;
  gears.describe = describePair;
  Family screw = gears;
  screw.key = "N_screw";
  screw.measure = "steps in which the driven nut is over 20 % slow";
  screw.members = 50;
  screw.expected_failure = 6;
  screw.every = 16;
  screw.measured = slowScrewSteps;
  screw.describe = describeScrew;
  return {gears, screw};
}

}  // namespace vps::families

// SPDX-License-Identifier: BSD-3-Clause
// D: rotation that is too fast for one step, with whole steps and with steps divided as vps_bullet/turn.h
// advises.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/gear.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/turn.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;
using test::Random;

constexpr double kPi = std::numbers::pi, kStep_s = World::kStep_s;

dynamics::SceneSettings settings(const dynamics::Resolution& resolution) {
  bullet::Settings quiet;
  quiet.warns_of_turns = false;
  dynamics::SceneSettings settings;
  settings.engine = dynamics::vpsEngine(resolution, quiet);
  return settings;
}

/// Makes steps of a millisecond, whole or divided, and keeps whether the library reported one of these steps
/// as too long.
class Stepper {
 public:
  Stepper(World& world, bool is_divided) : world_(world), is_divided_(is_divided) {}

  /// @param after_each  called after each part of the step
  template <typename AfterEach>
  void step(const AfterEach& after_each) {
    const int parts = is_divided_ ? bullet::substepsFor(world_.bullet(), kStep_s, 10'000) : 1;
    for (int k = 0; k < parts; ++k) {
      world_.step(1, kStep_s / parts);
      turns_.clear();
      bullet::findTurns(world_.bullet(), turns_);
      for (const bullet::BodyTurn& turn : turns_)
        is_said_ |= turn.w_rad_s * kStep_s / parts > turn.limit_rad();
      after_each();
    }
  }
  [[nodiscard]] bool isSaid() const { return is_said_; }

 private:
  World& world_;
  bool is_divided_, is_said_ = false;
  std::vector<bullet::BodyTurn> turns_;
};

// --- Two gears on hinges: a motor turns the first, a brake holds the second

struct Gears {
  int teeth[2] = {0, 0};
  double module_m = 0, w_rad_s = 0;
};

Gears gearsOf(int member) {
  // In the cases in which the fault was found, gears of 20 and 30 teeth, the driven gear turned at 54 and 26
  // % of its right speed.
  if (member < 2) return {{20, 30}, 1e-3, member == 0 ? 200.0 : 300.0};
  Random random(4000 + static_cast<std::uint64_t>(member));
  Gears gears;
  for (int& teeth : gears.teeth) teeth = 12 + random.index(49);
  gears.module_m = random.uniform(0.5e-3, 1e-3);
  gears.w_rad_s = random.logUniform(50, 600);
  // Every third member lies on either side of the limit that contact can hold in a whole step.
  if (member % 3 == 2)
    gears.w_rad_s = random.uniform(0.4, 1.2) * bullet::kContactTurn_rad / kStep_s /
                    (1 + static_cast<double>(gears.teeth[0]) / gears.teeth[1]);
  return gears;
}

PartMesh gearPart(const Gears& gears, int i) {
  test::GearShape shape;
  shape.module_m = gears.module_m;
  shape.teeth = gears.teeth[i];
  shape.width_m = i == 0 ? 4e-3 : 3e-3;
  shape.backlash_m = 0.05 * gears.module_m;
  shape.other_radius_m = 0.25 * gears.module_m * gears.teeth[i];
  shape.points_per_tooth = 16;
  shape.axial_steps = shape.radial_steps = 2;
  return dynamics::makePart(test::makeSpurGear(shape));
}

std::unique_ptr<btHingeConstraint> hingeOf(const Placed& gear) {
  const Pose X_BP = gear.part.frame.X_PB.inverse();
  return std::make_unique<btHingeConstraint>(*gear.body, bullet::toBt(X_BP.p),
                                             bullet::toBt(Vec3(X_BP.R.col(2))));
}

/// Speed of the driven gear over its right speed, less 1; 0 if the library reported a step as too long.
double gearError(int member, bool is_divided) {
  const Gears gears = gearsOf(member);
  const double ratio = static_cast<double>(gears.teeth[0]) / gears.teeth[1], w_rad_s = gears.w_rad_s;
  World world(settings({0.25e-3, 0.5e-3}));
  world.setGravity(Vec3::Zero());
  // Tooth 0 of the driver points at the axis of the driven gear and meets a gap between its teeth.
  const double distance_m = gears.module_m * (gears.teeth[0] + gears.teeth[1]) / 2;
  const Placed driver = world.add(gearPart(gears, 0), Pose(), false, 0);
  const Placed driven = world.add(
      gearPart(gears, 1),
      Pose(rotationFromVector(Vec3(0, 0, kPi + kPi / gears.teeth[1])), Vec3(distance_m, 0, 0)), false, 0);
  auto hinge = hingeOf(driver);
  constexpr double kStrong_Nms = 1e3;
  hinge->enableAngularMotor(true, bullet::toBt(w_rad_s), bullet::toBt(kStrong_Nms));
  world.addConstraint(std::move(hinge));
  world.addConstraint(hingeOf(driven));
  driver.body->setAngularVelocity({0, 0, bullet::toBt(w_rad_s)});
  driven.body->setAngularVelocity({0, 0, bullet::toBt(-ratio * w_rad_s)});
  // The driver turns by 3 rad until the flanks carry the load, and then by 6 rad while the speed is measured.
  const int settle = static_cast<int>(std::ceil(3 / (w_rad_s * kStep_s))), steps = 3 * settle;
  const double brake_Nm = driven.part.frame.inertia_kg_m2.maxCoeff() * ratio * w_rad_s / (steps * kStep_s);
  dynamics::TurnCounter turn(driven);
  Stepper stepper(world, is_divided);
  double from_rad = 0, at_rad = 0;
  for (int i = 0; i < steps; ++i) {
    if (i == settle) from_rad = at_rad;
    driven.body->applyTorque({0, 0, bullet::toBt(brake_Nm)});
    stepper.step([&] { at_rad = turn.update(); });
  }
  const double share = (from_rad - at_rad) / (ratio * w_rad_s * kStep_s * (steps - settle));
  return stepper.isSaid() ? 0 : std::abs(share - 1);
}

std::string inWords(const Gears& gears) {
  char words[100];
  std::snprintf(words, sizeof words, "%d:%d teeth of module %.3g mm, %.4g rad/s", gears.teeth[0],
                gears.teeth[1], 1e3 * gears.module_m, gears.w_rad_s);
  return words;
}

// --- A shaft without friction and weight, free or in a bore

struct Shaft {
  double radius_m = 0, clearance_m = 0, rpm = 0;
  bool is_in_bore = false;
  int facets = 0;
};

Shaft shaftOf(int member) {
  if (member < 2) return {5e-3, 50e-6, 10'000, member == 1, 64};
  Random random(5000 + static_cast<std::uint64_t>(member));
  Shaft shaft;
  shaft.radius_m = random.uniform(2e-3, 8e-3);
  shaft.clearance_m = random.logUniform(20e-6, 200e-6);
  shaft.rpm = random.logUniform(1000, 60'000);
  shaft.is_in_bore = random.chance(0.6);
  shaft.facets = 32 + 16 * random.index(5);
  return shaft;
}

/// The greater of the relative errors of speed and of the angle turned in 0.2 s; 0 if the library reported a
/// step as too long.
double shaftError(int member, bool is_divided) {
  const Shaft shaft = shaftOf(member);
  World world(settings({0.5e-3, 1e-3}));
  // There is no weight: a polygon that lies in a polygon would be slowed by its corners.
  world.setGravity(Vec3::Zero());
  if (shaft.is_in_bore) {
    // The corners of the bore's facets lie on its circle, so the flats between them are nearer to the axis.
    const double bore_m = (shaft.radius_m + shaft.clearance_m / 2) / std::cos(kPi / 96);
    world.add(dynamics::makePart(makeTube(bore_m + 3e-3, bore_m, 6e-3, 96)), Pose(), true, 0);
  }
  const Placed placed =
      world.add(dynamics::makePart(makeCylinder(shaft.radius_m, 10e-3, shaft.facets)), Pose(), false, 0);
  const double w_rad_s = shaft.rpm * kPi / 30, time_s = 0.2;
  placed.body->setAngularVelocity({0, 0, bullet::toBt(w_rad_s)});
  dynamics::TurnCounter turn(placed);
  Stepper stepper(world, is_divided);
  double at_rad = 0;
  for (int i = 0; i < std::lround(time_s / kStep_s); ++i) {
    stepper.step([&] { at_rad = turn.update(); });
    if (stepper.isSaid()) return 0;
  }
  const double end_rad_s = placed.body->getAngularVelocity().z();
  return std::max(std::abs(end_rad_s / w_rad_s - 1), std::abs(at_rad / (w_rad_s * time_s) - 1));
}

std::string inWords(const Shaft& shaft) {
  char words[150];
  std::snprintf(words, sizeof words, "%.0f rpm, r %.3g mm, %d facets, %s, clearance %.3g um", shaft.rpm,
                1e3 * shaft.radius_m, shaft.facets, shaft.is_in_bore ? "in a bore" : "free",
                1e6 * shaft.clearance_m);
  return words;
}

}  // namespace

std::vector<Family> fastRotationFamilies() {
  const auto familyOf = [](const char* key, const char* measure, int every, auto error, bool is_divided,
                           auto memberOf) {
    Family family{key, measure, 0.01,
                  50,  every,   [error, is_divided](int member) { return error(member, is_divided); }};
    family.describe = [memberOf](int member) { return inWords(memberOf(member)); };
    return family;
  };
  return {
      familyOf("D_gears", "error of the driven gear's speed, steps divided", 12, gearError, true, gearsOf),
      familyOf("D_gears_said", "the same with whole steps, unless they are reported as too long", 12,
               gearError, false, gearsOf),
      familyOf("D_shafts", "error of a shaft's speed or angle, steps divided", 12, shaftError, true, shaftOf),
      familyOf("D_shafts_said", "the same with whole steps, unless they are reported as too long", 4,
               shaftError, false, shaftOf)};
}

}  // namespace vps::families

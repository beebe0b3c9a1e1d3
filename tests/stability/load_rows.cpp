// SPDX-License-Identifier: BSD-3-Clause
// Rows with extreme masses, stiffness, friction and numbers of contacts.
#include <algorithm>
#include <cmath>

#include "drop.h"
#include "rows.h"
#include "vps/feature_motion.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::stability {

namespace {

World makeWorld(Mode mode, const bullet::Settings& settings = {}) {
  return World({mode, true, dynamics::vpsEngine(kCoarse, settings)});
}

// Depth in penalty contact under a weight on the area A: W / (k A), twice that while the weight is placed.
double sunk_m(Mode mode, double weight_N, double area_m2, double k_N_per_m3 = 1e12) {
  return 1e-6 + (mode == Mode::Penalty ? 2 * weight_N / (k_N_per_m3 * area_m2) : 0);
}

// A light block on a plate, and a heavy block on the light one, off centre, with a common face of 19 x 14.5
// mm.
Judgement stack(Mode mode, double light_kg, double heavy_kg) {
  World world = makeWorld(mode);
  const Placed floor = world.add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const PartMesh light_part = dynamics::withMass(block(), light_kg);
  const PartMesh heavy_part = dynamics::withMass(block(), heavy_kg);
  const Placed light = world.add(light_part, Pose::translation(Vec3(0, 0, 5e-3)));
  const Placed heavy = world.add(heavy_part, Pose::translation(Vec3(1e-3, 0.5e-3, 15.1e-3)));
  Judgement judgement;
  const Watched watched = watch(world, {floor, light, heavy}, {.steps = 800});
  const double weight_N = (light_kg + heavy_kg) * kGravity_m_s2;
  // With an eccentricity e the pressure at an edge is 1 + 6 e / side times the mean, 1.5 here.
  judgeRun(judgement, watched, weight_N, 1.5 * sunk_m(mode, weight_N, 19e-3 * 14.5e-3), 1e-3);
  judgeRest(judgement, watched, 1e-3);
  judgement.atMost("height error", std::abs(heavy.pose().p.z() - 15e-3),
                   2 * sunk_m(mode, weight_N, 19e-3 * 14.5e-3), "m");
  return judgement;
}

// The geometric mean of both masses is that of a steel block, 23.6 g. For a ratio of a million, 23.6 mg are
// under 23.6 kg.
Judgement stackOfRatio(const Run& run) {
  return stack(run.mode, 23.6e-3 / std::sqrt(run.value), 23.6e-3 * std::sqrt(run.value));
}

// A mass on a steel block of 23.6 g.
Judgement stackOfMass(const Run& run) {
  return stack(run.mode, 23.6e-3, 23.6e-3 * run.value);
}

// Two free blocks collide off centre at 1 m/s; nothing else acts.
Judgement collide(const Run& run) {
  World world = makeWorld(run.mode);
  world.setGravity(Vec3::Zero());
  const Placed light =
      world.add(block(), Pose(rotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(40e-3, 3e-3, 2e-3)));
  const PartMesh heavy_part = dynamics::withMass(block(), run.value * light.part.frame.mass_kg);
  const Placed heavy = world.add(heavy_part, Pose());
  heavy.body->setLinearVelocity(btVector3(1, 0, 0));
  const Vec3 p = momentum_Ns({light, heavy}), L = angularMomentum_Nms({light, heavy});
  const Watched watched = watch(world, {light, heavy}, {.steps = 200, .measure_every = 1});
  const Vec3 dp = momentum_Ns({light, heavy}) - p, dL = angularMomentum_Nms({light, heavy}) - L;
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  const double slope_m = 1e-6 + (run.mode == Mode::Penalty ? 1e-3 : 0);
  judgement.atMost("overlap", watched.final_m, slope_m, "m");
  // The light block gains the momentum that the heavy one loses, up to rounding.
  const double light_Ns = light.part.frame.mass_kg * 2;
  judgement.atMost("momentum lost", dp.norm(), 1e-9 * light_Ns + 1e-15 * p.norm() * 200, "N s");
  // A step applies rotation and translation to first order: the lever arm has an error of one step's travel.
  judgement.atMost("angular momentum lost", dL.norm(), light_Ns * 1e-3, "N m s");
  judgement.atMost("energy gained", watched.gained_J, 1e-9 * watched.start_J, "J");
  return judgement;
}

// A block is placed on penalty contact that yields by sunk_wanted_m at rest, and at first by twice as much.
Judgement restOnCompliantContact(Mode mode, double k_N_per_m, double sunk_wanted_m) {
  bullet::Settings settings;
  settings.stiffness_N_per_m3 = k_N_per_m / (kBlock_m.x() * kBlock_m.y());
  World world = makeWorld(mode, settings);
  const double weight_N = k_N_per_m * sunk_wanted_m;
  const Placed floor = world.add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const PartMesh part = dynamics::withMass(block(), weight_N / kGravity_m_s2);
  const Placed lying = world.add(part, Pose::translation(Vec3(0, 0, 5e-3)));
  // Implicit steps of dt damp an oscillation with the rate w^2 dt / 2, w^2 = g / depth: 20 time constants.
  const double rest_s = std::max(0.5, 20 * 2 * sunk_wanted_m / (kGravity_m_s2 * 1e-3));
  const Watched watched = watch(world, {floor, lying}, {.steps = static_cast<int>(rest_s / 1e-3)});
  const double sunk_m = 5e-3 - lying.pose().p.z();
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgeRest(judgement, watched, 1e-3);
  // Points represent the face except for half a spacing along its border, and the side walls below the
  // surface press too, with half the depth on average.
  const double border_m = 2 * (kBlock_m.x() + kBlock_m.y()), face_m2 = kBlock_m.x() * kBlock_m.y();
  const double off = border_m * (0.25e-3 + sunk_wanted_m / 2) / face_m2;
  // In constraint contact the block rests at the gap of sharp edges.
  const double wanted_m = mode == Mode::Penalty ? sunk_wanted_m : -FeatureMotion::kRest_m;
  judgement.atMost("error of weight / k", std::abs(sunk_m - wanted_m),
                   (mode == Mode::Penalty ? off * sunk_wanted_m : 0) + 1e-9, "m");
  judgement.atMost("energy gained", watched.gained_J, weight_N * 1e-6, "J");
  return judgement;
}

// The block has the mass that sinks by a tenth of a millimetre.
Judgement restOnStiffness(const Run& run) {
  return restOnCompliantContact(run.mode, run.value, 0.1e-3);
}

// The contact has 10 kN/m and the block the mass that sinks to this depth. The map's band is 2 mm.
Judgement restInDepth(const Run& run) {
  return restOnCompliantContact(run.mode, 1e4, run.value * 2e-3);
}

// A coupling of this stiffness pulls a block from 1 mm above a plate towards a target at this depth in it.
Judgement pressByCoupling(Mode mode, double k_N_per_m, double deep_m) {
  World world = makeWorld(mode);
  const Placed floor = world.add(plate(), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const Placed part = world.add(block(), Pose::translation(Vec3(0, 0, 6e-3)));
  CouplingGains gains;
  gains.k_N_per_m = k_N_per_m;
  gains.k_Nm_per_rad = k_N_per_m * 1e-4;  // the same spring at a lever arm of a centimetre
  gains.b_Ns_per_m = gains.b_Nms_per_rad = 0;
  gains.max_force_N = gains.max_torque_Nm = 1e12;
  auto coupling =
      std::make_unique<bullet::CouplingConstraint>(*part.body, part.part.frame.X_PB.inverse(), gains);
  CouplingState target;
  target.X_W = Pose::translation(Vec3(0, 0, 5e-3 - deep_m));
  target.is_coupled = true;
  coupling->setTarget(target);
  world.addConstraint(std::move(coupling));
  // In penalty contact the block comes to rest at the rate w^2 dt / 2 of the implicit steps.
  const double w2 = k_N_per_m / part.part.frame.mass_kg;
  const int steps = std::clamp(static_cast<int>(40 / (w2 * 1e-6)), 500, 20'000);
  const Watched watched = watch(world, {floor, part}, {.steps = steps});
  const double pull_N = k_N_per_m * deep_m + part.part.frame.mass_kg * kGravity_m_s2;
  const double sunk = sunk_m(mode, pull_N, kBlock_m.x() * kBlock_m.y());
  Judgement judgement;
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  judgeRest(judgement, watched, 1e-3);
  judgement.atMost("overlap at rest", watched.final_m, sunk, "m");
  judgement.atMost("height error", std::abs(part.pose().p.z() - 5e-3), sunk, "m");
  return judgement;
}

Judgement pressByStiffness(const Run& run) {
  return pressByCoupling(run.mode, run.value, 2e-3);
}

Judgement pressDeep(const Run& run) {
  return pressByCoupling(run.mode, 1e6, 1e-3 * run.value);
}

// On a slope of 20 degrees a block slides with g (sin - mu cos) below mu = tan 20 = 0.364, and sticks above.
Judgement slideDown(const Run& run) {
  constexpr double slope_rad = 20 * M_PI / 180;
  World world = makeWorld(run.mode);
  world.setGravity(kGravity_m_s2 * Vec3(std::sin(slope_rad), 0, -std::cos(slope_rad)));
  const Placed floor = world.add(plate(0.2), Pose::translation(Vec3(0.06, 0, -5e-3)), true, run.value);
  const Placed part = world.add(block(), Pose::translation(Vec3(0, 0, 5e-3)), false, run.value);
  const Watched watched = watch(world, {floor, part}, {.steps = 200});
  const double net_m_s2 =
      kGravity_m_s2 * std::max(0.0, std::sin(slope_rad) - run.value * std::cos(slope_rad));
  Judgement judgement;
  const double weight_N = part.part.frame.mass_kg * kGravity_m_s2;
  judgeRun(judgement, watched, weight_N, sunk_m(run.mode, weight_N, kBlock_m.x() * kBlock_m.y()), 1e-3);
  // The speed gained by half a step before contact; and the bristle of the friction model first bends by
  // micrometres.
  judgement.atMost("speed error", std::abs(part.body->getLinearVelocity().x() - net_m_s2 * 0.2),
                   1e-3 * net_m_s2 * 0.2 + 1e-5, "m/s");
  if (net_m_s2 == 0) judgement.atMost("slipped", std::abs(part.pose().p.x()), 5e-6, "m");
  return judgement;
}

// A tilted drop with this friction, in which points stick and slip at the same time.
Judgement dropWithFriction(const Run& run) {
  Drop what;
  what.friction = run.value;
  return judgeDrop(run.mode, what);
}

// Without friction no horizontal force acts: at the end the block rests except for the error of Bullet's
// integration in both modes: a step that rotates the block by w dt changes its angular momentum by a share w
// dt.
Judgement dropWithoutFriction(const Run& run) {
  Drop what;
  what.friction = run.value;
  const Dropped dropped = drop(run.mode, what);
  Judgement judgement;
  judgeRun(judgement, dropped.watched, dropped.weight_N, allowedDepth_m(run.mode, what, dropped), what.dt_s);
  const double fastest_m_s = dropped.watched.fastest_m_s;
  judgement.atMost("speed at rest", dropped.watched.speed_m_s,
                   fastest_m_s * fastest_m_s * what.dt_s / kBlock_m.minCoeff(), "m/s");
  return judgement;
}

// A plate on a plate: every point of both faces touches.
Judgement pressFaces(const Run& run) {
  const double side_m = 1e-3 * std::sqrt(run.value);  // points 1 mm apart
  World world = makeWorld(run.mode);
  const PartMesh part = makePart(makeBox(Vec3(side_m, side_m, 10e-3)));
  const Placed floor = world.add(part, Pose::translation(Vec3(0, 0, -5e-3)), true);
  const Placed top = world.add(part, Pose::translation(Vec3(0, 0, 5.1e-3)));
  const Watched watched = watch(world, {floor, top}, {.steps = 100});
  const double weight_N = top.part.frame.mass_kg * kGravity_m_s2;
  Judgement judgement;
  judgeRun(judgement, watched, weight_N, sunk_m(run.mode, weight_N, side_m * side_m), 1e-3);
  judgeRest(judgement, watched, 1e-3);
  return judgement;
}

// A lid on a square grid of pins, of which all but three are redundant.
Judgement lidOnPins(const Run& run) {
  World world = makeWorld(run.mode);
  const PartMesh pin = makePart(makeCylinder(1e-3, 10e-3, 24));
  const int count = static_cast<int>(run.value), columns = static_cast<int>(std::ceil(std::sqrt(run.value)));
  const double pitch_m = 8e-3, half_m = columns * pitch_m / 2;
  std::vector<Placed> parts;
  for (int i = 0; i < count; ++i)
    parts.push_back(world.add(pin,
                              Pose::translation(Vec3((i % columns + 0.5) * pitch_m - half_m,
                                                     (i / columns + 0.5) * pitch_m - half_m, -5e-3)),
                              true));
  const PartMesh lid_part = makePart(makeBox(Vec3(2 * half_m, 2 * half_m, 5e-3)));
  const Placed lid = world.add(lid_part, Pose::translation(Vec3(0, 0, 2.5e-3 + 0.1e-3)));
  parts.push_back(lid);
  const Watched watched = watch(world, parts, {.steps = 300, .measure_every = 20});
  const double weight_N = lid.part.frame.mass_kg * kGravity_m_s2;
  Judgement judgement;
  judgeRun(judgement, watched, weight_N, sunk_m(run.mode, weight_N, count * M_PI * 1e-6), 1e-3);
  judgeRest(judgement, watched, 1e-3);
  return judgement;
}

}  // namespace

std::vector<Row> loadRows() {
  return {
      {"mass_ratio",
       "mass of a block over that of the block below it, 23.6 g in the geometric mean",
       "rest, height",
       {1, 1e3, 1e6, 1e8, 1e10, 1e12},
       3,
       stackOfRatio,
       {99, 99}},
      {"load",
       "mass of a block over that of the block below it, of 23.6 g",
       "rest, height",
       {1, 1e3, 1e4, 1e5, 1e6},
       5,
       stackOfMass,
       {99, 3}},
      {"collision",
       "mass of a block over that of the block it strikes at 1 m/s",
       "momentum, overlap at the end",
       {1, 1e3, 1e6, 1e8, 1e10, 1e12},
       3,
       collide},
      {"soft_contact",
       "stiffness of contact [N/m], of a face that sinks 0.1 mm",
       "rest, weight / k",
       {1e4, 100, 1, 1e-3, 1e-6},
       3,
       restOnStiffness},
      {"stiff_contact",
       "stiffness of contact [N/m], of a face that sinks 0.1 mm",
       "rest, weight / k",
       {1e4, 1e7, 1e9, 1e12, 1e15},
       2,
       restOnStiffness},
      {"sunk",
       "depth of penalty contact under a part's weight [bands of the map]",
       "rest, weight / k",
       {0.01, 0.1, 0.3, 0.5, 0.7, 1, 2},
       3,
       restInDepth},
      {"coupling",
       "stiffness of the coupling that pulls a block 2 mm into a plate [N/m]",
       "rest, height",
       {1, 100, 1e4, 1e6, 1e7, 1e8, 1e9, 1e10, 1e12},
       5,
       pressByStiffness},
      {"coupling_deep",
       "depth to which a coupling of 1 MN/m pulls a block into a plate of 10 mm [mm]",
       "rest, height",
       {1, 2, 4, 6, 8},
       3,
       pressDeep},
      {"slope",
       "friction, on a slope of 20 degrees",
       "g (sin - mu cos), or sticks",
       {0, 0.2, 0.36, 0.37, 1, 100, 1e6, 1e9},
       7,
       slideDown},
      {"friction", "friction of a block that topples", "rest", {0.15, 1, 100, 1e6, 1e9}, 4, dropWithFriction},
      {"no_friction", "friction of a block that topples", "rest", {0.01, 1e-6, 0}, 3, dropWithoutFriction},
      {"many",
       "points that touch at once, of each part",
       "rest",
       {100, 1e3, 4e3, 1.6e4, 6.4e4},
       3,
       pressFaces},
      {"pins", "pins under one lid", "rest", {4, 10, 40, 100, 400}, 3, lidOnPins, {99, 99}, toText},
  };
}

}  // namespace vps::stability

// SPDX-License-Identifier: BSD-3-Clause
// Rows in which each quantity is not a number, infinite, or denormal: the call throws an error with a
// message, or the body does not affect others. The program never crashes.
#include <cmath>
#include <limits>

#include "drop.h"
#include "rows.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"
#include "watch.h"

namespace vps::stability {

namespace {

// The scene that receives a bad value.
struct Scene {
  World& world;
  Placed bad;  ///< the body with the bad value, on the plate, far from others
  double& dt_s;
};

struct Quantity {
  const char* name;
  std::function<void(Scene&, double)> give;
};

Mesh boxWith(double value) {
  Mesh mesh = makeBox(kBlock_m);
  mesh.vertices[3].y() = value;
  return mesh;
}

VoxMapSettings voxels(double voxel_m, double band_voxels = 4) {
  VoxMapSettings settings;
  settings.voxel_m = voxel_m;
  settings.band_voxels = band_voxels;
  return settings;
}

void couple(Scene& scene, const CouplingGains& gains, double at_m = 0) {
  auto coupling = std::make_unique<bullet::CouplingConstraint>(*scene.bad.body, Pose(), gains);
  CouplingState target;
  target.X_W = Pose::translation(Vec3(at_m, 0, 10e-3));
  target.is_coupled = true;
  coupling->setTarget(target);
  scene.world.addConstraint(std::move(coupling));
}

void install(Scene& scene, double bullet::Settings::*member, double value) {
  bullet::Settings settings;
  settings.*member = value;
  bullet::install(*static_cast<btCollisionDispatcher*>(scene.world.bullet().getDispatcher()), settings);
}

bullet::Shape& shapeOf(Scene& scene) {
  return *static_cast<bullet::Shape*>(scene.bad.body->getCollisionShape());
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all{
      {"a corner, of a map", [](Scene&, double x) { buildVoxMap(boxWith(x), voxels(0.5e-3)); }},
      {"a corner, of a shell", [](Scene&, double x) { buildPointShell(boxWith(x), {}); }},
      {"a corner, of a body", [](Scene&, double x) { makePart(boxWith(x)); }},
      {"voxel size", [](Scene&, double x) { buildVoxMap(makeBox(kBlock_m), voxels(x)); }},
      {"band", [](Scene&, double x) { buildVoxMap(makeBox(kBlock_m), voxels(0.5e-3, x)); }},
      {"point spacing",
       [](Scene&, double x) {
         buildPointShell(makeBox(kBlock_m), {x, 0.35});
       }},
      {"density", [](Scene&, double x) { makePart(makeBox(kBlock_m), x); }},
      {"pose of a shape's models",
       [](Scene& s, double x) { bullet::Shape(shapeOf(s).models(), Pose::translation(Vec3(0, x, 0))); }},
      {"scale of a shape",
       [](Scene& s, double x) {
         shapeOf(s).setLocalScaling(btVector3(bullet::toBt(x), bullet::toBt(x), bullet::toBt(x)));
       }},
      {"margin of a shape", [](Scene& s, double x) { shapeOf(s).setMargin(bullet::toBt(x)); }},
      {"mass for an inertia",
       [](Scene& s, double x) {
         btVector3 inertia;
         shapeOf(s).calculateLocalInertia(bullet::toBt(x), inertia);
       }},
      {"stiffness of contact",
       [](Scene& s, double x) { install(s, &bullet::Settings::stiffness_N_per_m3, x); }},
      {"contact margin", [](Scene& s, double x) { install(s, &bullet::Settings::contact_margin_m, x); }},
      {"spring of a coupling",
       [](Scene& s, double x) {
         CouplingGains gains;
         gains.k_N_per_m = x;
         couple(s, gains);
       }},
      {"damper of a coupling",
       [](Scene& s, double x) {
         CouplingGains gains;
         gains.b_Nms_per_rad = x;
         couple(s, gains);
       }},
      {"greatest force of a coupling",
       [](Scene& s, double x) {
         CouplingGains gains;
         gains.max_force_N = x;
         couple(s, gains);
       }},
      {"target of a coupling", [](Scene& s, double x) { couple(s, {}, x); }},
      {"velocity of a body",
       [](Scene& s, double x) { s.bad.body->setLinearVelocity(btVector3(0, bullet::toBt(x), 0)); }},
      {"spin of a body",
       [](Scene& s, double x) { s.bad.body->setAngularVelocity(btVector3(0, bullet::toBt(x), 0)); }},
      {"place of a body",
       [](Scene& s, double x) {
         btTransform X = s.bad.body->getWorldTransform();
         X.getOrigin().setY(bullet::toBt(x));
         s.bad.body->setWorldTransform(X);
       }},
      {"force on a body",
       [](Scene& s, double x) { s.bad.body->applyCentralForce(btVector3(bullet::toBt(x), 0, 0)); }},
      {"torque on a body",
       [](Scene& s, double x) { s.bad.body->applyTorque(btVector3(bullet::toBt(x), 0, 0)); }},
      {"friction of a body", [](Scene& s, double x) { s.bad.body->setFriction(bullet::toBt(x)); }},
      {"restitution of a body", [](Scene& s, double x) { s.bad.body->setRestitution(bullet::toBt(x)); }},
      {"mass of a body",
       [](Scene& s, double x) {
         s.bad.body->setMassProps(bullet::toBt(x),
                                  btVector3(bullet::toBt(1e-6), bullet::toBt(1e-6), bullet::toBt(1e-6)));
       }},
      {"inertia of a body",
       [](Scene& s, double x) {
         s.bad.body->setMassProps(bullet::toBt(0.02),
                                  btVector3(bullet::toBt(x), bullet::toBt(1e-6), bullet::toBt(1e-6)));
         s.bad.body->updateInertiaTensor();
       }},
      {"damping of a body",
       [](Scene& s, double x) { s.bad.body->setDamping(bullet::toBt(x), bullet::toBt(x)); }},
  };
  return all;
}

bool isInWords(const std::string& text) {
  return text.size() > 20 && text.find(' ') != std::string::npos;
}

// Sets one quantity to the value; a neighbour on the same plate must not be affected.
void judgeValue(Judgement& judgement, Mode mode, const Quantity& quantity, double value) {
  const std::string told = toText(value);
  World world({mode, true, dynamics::vpsEngine(kCoarse)});
  const PartMesh part = block();
  world.add(makePart(makeBox(Vec3(120e-3, 60e-3, 10e-3))), Pose::translation(Vec3(0, 0, -5e-3)), true);
  const Placed neighbour = world.add(part, Pose::translation(Vec3(40e-3, 0, 5e-3)));
  double dt_s = 1e-3;
  // The body gets its own mesh, since engines share the shapes of equal meshes.
  Scene scene{world, world.add(block(), Pose::translation(Vec3(-40e-3, 0, 5e-3))), dt_s};
  world.step(5);
  const Pose before = neighbour.pose();
  try {
    quantity.give(scene, value);
  } catch (const std::exception& error) {
    judgement.require(isInWords(error.what()), told + ": refused without a message");
    judgement.note(told + " is refused");
    return;
  }
  world.step(50);
  const Pose after = neighbour.pose();
  judgement.require(after.isFinite(), told + ": the pose of its neighbour is not a number any more");
  // The neighbour rests in contact, for which a micrometre is allowed.
  if (after.isFinite()) judgement.atMost("neighbour moved", (after.p - before.p).norm(), 1e-6, "m");
}

Judgement giveNonsense(const Run& run) {
  Judgement judgement;
  const Quantity& quantity = quantities()[static_cast<std::size_t>(run.value)];
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {std::nan(""), infinite, -infinite})
    judgeValue(judgement, run.mode, quantity, value);
  return judgement;
}

Judgement giveDenormal(const Run& run) {
  Judgement judgement;
  const Quantity& quantity = quantities()[static_cast<std::size_t>(run.value)];
  for (const double value : {5e-324, 1e-310, -1e-310}) judgeValue(judgement, run.mode, quantity, value);
  return judgement;
}

std::string nameOfQuantity(double value) {
  return quantities()[static_cast<std::size_t>(value)].name;
}

std::vector<double> allQuantities() {
  std::vector<double> indices;
  for (std::size_t i = 0; i < quantities().size(); ++i) indices.push_back(static_cast<double>(i));
  return indices;
}

}  // namespace

std::vector<Row> inputRows() {
  const std::vector<double> all = allQuantities();
  return {
      {"not_finite",
       "each of " + std::to_string(all.size()) + " quantities not a number and infinite",
       "message, or no effect on a neighbour",
       all,
       all.size(),
       giveNonsense,
       {99, 99},
       nameOfQuantity},
      {"denormal",
       "each of " + std::to_string(all.size()) + " quantities at 5e-324 and 1e-310",
       "message, or no effect on a neighbour",
       all,
       all.size(),
       giveDenormal,
       {99, 99},
       nameOfQuantity},
  };
}

}  // namespace vps::stability

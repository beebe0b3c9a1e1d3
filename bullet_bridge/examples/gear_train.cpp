// SPDX-License-Identifier: BSD-3-Clause
// A motor turns the first of three gears; the others turn because their teeth touch.
#include <btBulletDynamicsCommon.h>
#include <vps_bullet/body.h>
#include <vps_bullet/convert.h>
#include <vps_bullet/install.h>
#include <vps_bullet/solver.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

using vps::bullet::toBt;

namespace {

constexpr double kPi = std::numbers::pi, kModule_m = 2e-3, kSpeed_rad_s = 2 * kPi;
constexpr int kTeeth[3] = {20, 30, 15};

/// Radius and angle of the points around a gear, counter-clockwise. Tooth 0 is centred on angle 0. A flank is
/// an involute with a pressure angle of 20 degrees: the teeth then turn each other at a constant ratio.
std::vector<std::pair<double, double>> outlineOf(int teeth) {
  constexpr double kPressure_rad = 20 * kPi / 180, kBacklash_m = 0.05e-3;
  constexpr int kFlankPoints = 18;
  const double pitch_m = kModule_m * teeth / 2, base_m = pitch_m * std::cos(kPressure_rad);
  const double root_m = pitch_m - 1.25 * kModule_m, tip_m = pitch_m + kModule_m;
  const auto involute = [](double angle_rad) { return std::tan(angle_rad) - angle_rad; };
  const auto halfTooth = [&](double r_m) {  // half of a tooth's angle at a radius
    const double at_pitch_rad = (kPi * kModule_m / 2 - kBacklash_m) / (2 * pitch_m);
    const double by_involute_rad = r_m > base_m ? involute(std::acos(base_m / r_m)) : 0;
    // The involute ends at the base circle. Below the base circle the flank is nearly radial.
    return at_pitch_rad + involute(kPressure_rad) - by_involute_rad +
           0.05 * std::fmax(0, base_m - r_m) / pitch_m;
  };
  std::vector<std::pair<double, double>> outline;
  for (int tooth = 0; tooth < teeth; ++tooth)
    for (const int side : {-1, 1})
      for (int k = 0; k <= kFlankPoints; ++k) {
        const double share = static_cast<double>(side < 0 ? k : kFlankPoints - k) / kFlankPoints;
        const double r_m = root_m + (tip_m - root_m) * share;
        outline.emplace_back(r_m, 2 * kPi * tooth / teeth + side * halfTooth(r_m));
      }
  return outline;
}

/// A gear of 10 mm width with a bore of 10 mm, as a closed mesh whose facets face outward. Your own meshes
/// come from CAD.
vps::Mesh makeGear(int teeth) {
  constexpr double kBore_m = 5e-3, kHalfWidth_m = 5e-3;
  const auto outline = outlineOf(teeth);
  const auto count = static_cast<std::uint32_t>(outline.size());
  vps::Mesh mesh;
  for (const auto& [r_m, angle_rad] : outline) {
    // Corners of a section of the ring: outside at the bottom and top, bore at the top and bottom.
    const vps::Vec3 ray(std::cos(angle_rad), std::sin(angle_rad), 0), up(0, 0, kHalfWidth_m);
    mesh.vertices.insert(mesh.vertices.end(),
                         {r_m * ray - up, r_m * ray + up, kBore_m * ray + up, kBore_m * ray - up});
  }
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t next = (i + 1) % count, l = (k + 1) % 4;
      const std::uint32_t a = 4 * i + k, b = 4 * next + k, c = 4 * next + l, d = 4 * i + l;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

/// A gear on a fixed axle along z at `x_m`.
struct Gear {
  vps::bullet::Body body;
  std::unique_ptr<btHingeConstraint> axle;

  Gear(int teeth, double x_m, double turned_rad) {
    vps::bullet::BodySettings settings;
    settings.material.friction = 0.1;
    settings.X_WP = vps::Pose(vps::rotationFromVector({0, 0, turned_rad}), {x_m, 0, 0});
    body = vps::bullet::makeBody(makeGear(teeth), settings);
    const vps::Pose X_BP = body.frame.X_PB.inverse();  // the axle in the body's frame
    axle = std::make_unique<btHingeConstraint>(*body.rigid, toBt(X_BP.p), toBt(vps::Vec3(X_BP.R.col(2))));
  }
};

}  // namespace

int main() {
  // An ordinary Bullet world with the solver of this library, without gravity.
  btDefaultCollisionConfiguration config;
  btCollisionDispatcher dispatcher(&config);
  btDbvtBroadphase broadphase;
  vps::bullet::Solver solver;  // joints and contacts in one solve
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
  world.setGravity(btVector3(0, 0, 0));
  vps::bullet::install(dispatcher);

  // A tooth of the first gear points at the second gear, which is turned by half a tooth, so that a space
  // between its teeth receives that tooth. The second gear also has a space on its far side. The third gear
  // has an odd number of teeth and is turned by half a tooth, so that one of its teeth points into the second
  // gear's space.
  const double x1_m = kModule_m * (kTeeth[0] + kTeeth[1]) / 2,
               x2_m = x1_m + kModule_m * (kTeeth[1] + kTeeth[2]) / 2;
  Gear gears[3] = {{kTeeth[0], 0, 0}, {kTeeth[1], x1_m, kPi / kTeeth[1]}, {kTeeth[2], x2_m, kPi / kTeeth[2]}};
  for (Gear& gear : gears) {
    world.addRigidBody(gear.body.rigid.get());
    world.addConstraint(gear.axle.get(), true);
  }
  // Bullet's parameters for small parts. The gears turn slowly and must not fall asleep.
  vps::bullet::tuneWorld(world);
  for (Gear& gear : gears) gear.body.rigid->setActivationState(DISABLE_DEACTIVATION);
  gears[0].axle->enableAngularMotor(true, toBt(kSpeed_rad_s), toBt(1e-3));  // greatest impulse a step: 1 Nm

  // 0.3 s in steps of one millisecond.
  double turned_rad[3] = {0, 0, 0};
  for (int i = 0; i < 300; ++i) {
    world.stepSimulation(toBt(1e-3), 0);
    for (int k = 0; k < 3; ++k) turned_rad[k] += 1e-3 * gears[k].body.rigid->getAngularVelocity().z();
  }
  std::printf("the gears turned by %.4f, %.4f and %.4f revolutions in 0.3 s\n", turned_rad[0] / (2 * kPi),
              turned_rad[1] / (2 * kPi), turned_rad[2] / (2 * kPi));
  for (Gear& gear : gears) {
    world.removeConstraint(gear.axle.get());
    world.removeRigidBody(gear.body.rigid.get());
  }
  vps::bullet::uninstall(dispatcher);
  // All gears have turned by the same number of teeth, apart from the backlash: at each pair of gears 0.1 mm
  // of the tooth pitch of 6.28 mm.
  const auto teeth = [&](int k) { return std::abs(turned_rad[k]) / (2 * kPi) * kTeeth[k]; };
  return teeth(0) > 5.9 && std::abs(teeth(1) - teeth(0)) < 0.04 && std::abs(teeth(2) - teeth(0)) < 0.06 ? 0
                                                                                                        : 1;
}

// SPDX-License-Identifier: BSD-3-Clause
// D: free rotation, fast rotation.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"
#include "vps_scenes/run/simulate.h"

namespace vps::families {
namespace {

using test::Random;

/// A box in free space that nothing touches: its angular momentum and its energy are conserved.
struct Spin {
  Vec3 size_m = Vec3(20e-3, 30e-3, 60e-3);
  Vec3 w_B = Vec3(0.02, 20, 0.01);  // near the middle principal axis, about which rotation is unstable
  double dt_s = 1e-3, duration_s = 10;
  Mat3 R = Mat3::Identity();
  dynamics::Mode mode = dynamics::Mode::Constraint;

  explicit Spin(int member) {
    if (member == 0) return;
    Random random(0xd0 + static_cast<std::uint64_t>(member));
    if (member >= 4) {
      constexpr std::array<double, 4> kSizes_m{10e-3, 20e-3, 30e-3, 60e-3};
      for (int i = 0; i < 3; ++i) size_m[i] = kSizes_m[static_cast<std::size_t>(random.index(4))];
      R = random.rotation();
      constexpr std::array<double, 5> kSteps_s{0.25e-3, 0.5e-3, 1e-3, 2e-3, 4e-3};
      dt_s = kSteps_s[static_cast<std::size_t>(random.index(5))];
      if (random.chance(0.3)) mode = dynamics::Mode::Penalty;
    }
    // Up to Bullet's limit of an eighth of a turn in a step.
    const double speed_rad_s = member < 4 ? 20 : random.logUniform(1, 0.7 / dt_s);
    const Vec3 axis =
        member % 2 ? Vec3(Vec3::Unit(random.index(3)) + 1e-3 * random.direction()) : random.direction();
    w_B = speed_rad_s * axis.normalized();
    duration_s = 10000 * dt_s;
  }
  /// The greatest relative change of energy or angular momentum.
  [[nodiscard]] double error() const {
    ImpactWorld scene(mode);
    scene.world.setGravity(Vec3::Zero());
    const dynamics::Placed body = scene.add(boxPart(size_m), Pose(R, Vec3::Zero()), 0, 0);
    setVelocity(body, Vec3::Zero(), R * w_B);
    const double start_J = scene.energy_J(false);
    const Vec3 start_Nms = scene.momentum().angular;
    double worst = 0;
    const int steps = static_cast<int>(std::lround(duration_s / dt_s));
    for (int k = 0; k < steps; ++k) {
      scene.world.step(1, dt_s);
      worst = std::max({worst, std::abs(scene.energy_J(false) / start_J - 1),
                        (scene.momentum().angular - start_Nms).norm() / start_Nms.norm()});
    }
    return worst;
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text, "box %.0fx%.0fx%.0f mm, %.3g %.3g %.3g rad/s, %.2g ms, %s",
                  1e3 * size_m.x(), 1e3 * size_m.y(), 1e3 * size_m.z(), w_B.x(), w_B.y(), w_B.z(), 1e3 * dt_s,
                  dynamics::nameOf(mode));
    return text;
  }
};

/// A disc or plate that spins about its own axis turns by w t, without a phase error that depends on the
/// step.
double angleError(int member) {
  Random random(0xd1 + static_cast<std::uint64_t>(member));
  ImpactWorld scene;
  scene.world.setGravity(Vec3::Zero());
  const int axis = random.index(3);
  const Mat3 R = random.rotation();
  const dynamics::Placed body = scene.add(boxPart(Vec3(20e-3, 30e-3, 60e-3)), Pose(R, Vec3::Zero()), 0, 0);
  const double dt_s = 1e-3, speed_rad_s = member == 0 ? 20 : random.logUniform(1, 700);
  // The principal axes of the body are the axes of the box.
  const Mat3 R_WB = bullet::fromBt(body.body->getWorldTransform().getBasis());
  const Vec3 w_W = speed_rad_s * Vec3(R_WB.col(axis));
  setVelocity(body, Vec3::Zero(), w_W);
  const int steps = 20;
  scene.world.step(steps, dt_s);
  const Mat3 wanted = rotationFromVector(w_W * (steps * dt_s)) * R_WB;
  const Mat3 turned = bullet::fromBt(body.body->getWorldTransform().getBasis());
  return rotationVector(turned * wanted.transpose()).norm() / (speed_rad_s * steps * dt_s);
}

/// The greatest relative change of the angular momentum of a part of a scene that is rotated at the start and
/// spins.
double sceneError(int member) {
  Random random(0xd2 + static_cast<std::uint64_t>(member));
  const Vec3 size_m(20e-3, 30e-3, 60e-3);
  const double x2 = size_m.x() * size_m.x(), y2 = size_m.y() * size_m.y(), z2 = size_m.z() * size_m.z();
  const Vec3 inertia(y2 + z2, x2 + z2, x2 + y2);
  scenes::ScenePart part;
  part.part.name = part.file = "box";
  part.part.mesh = makeBox(size_m);
  if (member > 0) part.X_WP.R = random.rotation();
  part.V_WP_W.w = member == 0 ? Vec3(20, 0, 0) : Vec3(random.uniform(5, 50) * random.direction());
  scenes::Scene scene;
  scene.file = scene.name = "spin";
  scene.fidelity.voxel_m = 1e-3;
  scene.fidelity.spacing_m = 2e-3;
  scene.parts.push_back(part);
  const auto momentum = [&](const Mat3& R, const Vec3& w) {
    return Vec3(R * inertia.cwiseProduct(R.transpose() * w));
  };
  const Vec3 start = momentum(part.X_WP.R, part.V_WP_W.w);
  double worst = 0;
  scenes::SimulateOptions options;
  options.trace = [&](double, const std::vector<scenes::BodyState>& bodies, double) {
    const scenes::BodyState& body = bodies.front();
    worst = std::max(worst, (momentum(body.X_WP.R, body.V_WP_W.w) - start).norm() / start.norm());
  };
  scenes::simulate(scene, 0.05, options);
  return worst;
}

std::vector<Family> freeRotationFamilies() {
  return {
      {"D_torque_free", "change of energy or angular momentum, relative", 1e-4, 60, 6,
       [](int i) { return Spin(i).error(); }, [](int i) { return Spin(i).words(); }},
      {"D_scene_spin", "change of angular momentum of a scene's part, relative", 1e-6, 50, 10, sceneError},
      {"D_principal_axis", "error of the angle turned, relative", 1e-9, 50, 5, angleError},
  };
}

}  // namespace

std::vector<Family> rotationFamilies() {
  std::vector<Family> all = freeRotationFamilies();
  for (Family& family : fastRotationFamilies()) all.push_back(std::move(family));
  for (Family& family : flatSpinFamilies()) all.push_back(std::move(family));
  return all;
}

}  // namespace vps::families

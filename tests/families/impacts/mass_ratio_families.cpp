// SPDX-License-Identifier: BSD-3-Clause
// B: a row of equal bodies and one body whose mass is a millionth to a million times that of the others.
//
// Without gravity and friction, the first body flies at the others, which are at rest. Momentum is conserved.
// Energy is conserved for e = 1 and never rises for a lesser restitution. A light body between two heavy
// bodies passes an impact on in some pi sqrt(ratio / 2) bounces.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "families/family.h"
#include "families/impacts/impact_world.h"
#include "support/random_draw.h"

namespace vps::families {
namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using test::Random;

struct MassRow {
  int count = 3, place = 1;  ///< number of bodies, and the place of the body with another mass
  double ratio = 1e-5, e = 1, gap_m = 0.1e-3, speed_m_s = 1, dt_s = 1e-3;
  Mat3 R = Mat3::Identity();

  /// Member 0 is the case in which the fault was found. Each place of each row has several ratios and all
  /// restitutions.
  explicit MassRow(int member) {
    if (member == 0) return;
    constexpr std::array<double, 3> kRestitutions{1, 0.8, 0.5};
    constexpr std::array<double, 3> kSteps_s{0.25e-3, 1e-3, 4e-3};
    Random random(0xb6 + static_cast<std::uint64_t>(member));
    const int which = member % 12;  // 3 + 4 + 5 places
    count = which < 3 ? 3 : which < 7 ? 4 : 5;
    place = which - (which < 3 ? 0 : which < 7 ? 3 : 7);
    e = kRestitutions[static_cast<std::size_t>(member / 12 % 3)];
    ratio = random.logUniform(1e-6, 1e6);
    // Half of the ratios are near either end of the range.
    if (random.chance(0.5)) ratio = ratio < 1 ? random.logUniform(1e-6, 1e-4) : random.logUniform(1e4, 1e6);
    gap_m = random.chance(0.3) ? 0 : random.logUniform(1e-6, 0.3e-3);
    speed_m_s = random.logUniform(0.5, 5);
    dt_s = kSteps_s[static_cast<std::size_t>(random.index(3))];
    if (random.chance(0.5)) R = random.rotation();
  }

  struct Errors {
    double energy = 0;    ///< relative change; with e < 1 the gain
    double momentum = 0;  ///< relative
    double turn = 0;  ///< speed by rotation of the bodies of equal mass, as a share of the first body's speed
  };
  [[nodiscard]] Errors errors() const {
    static const Vec3 kCube_m(20e-3, 20e-3, 10e-3);
    static const PartMesh part = dynamics::makePart(makeBox(kCube_m));
    ImpactWorld scene;
    scene.world.setGravity(Vec3::Zero());
    // The velocities that a light body gives to the others are below Bullet's threshold of restitution.
    scene.world.bullet().getSolverInfo().m_restitutionVelocityThreshold = 0;
    for (int i = 0; i < count; ++i) {
      const double mass_kg = part.frame.mass_kg * (i == place ? ratio : 1);
      const Placed body = scene.add(dynamics::withMass(part, mass_kg),
                                    Pose(R, R * Vec3(i * (kCube_m.x() + gap_m), 0, 0)), 1, 0);
      body.body->setRestitution(std::sqrt(e));
      setVelocity(body, i == 0 ? Vec3(R * Vec3(speed_m_s, 0, 0)) : Vec3(0, 0, 0));
    }
    const double start_J = scene.energy_J(false), scale = scene.momentumScale().first;
    const Vec3 start = scene.momentum().linear;
    Errors worst;
    const int steps = 40 + static_cast<int>(2 * count * gap_m / (speed_m_s * dt_s));
    for (int k = 0; k < steps; ++k) {
      scene.world.step(1, dt_s);
      const double change = scene.energy_J(false) / start_J - 1;
      worst.energy = std::max(worst.energy, e < 1 ? change : std::abs(change));
      for (int i = 0; i < count; ++i)
        if (i != place)
          worst.turn =
              std::max(worst.turn,
                       15e-3 * scene.bodies[static_cast<std::size_t>(i)].body->getAngularVelocity().length() /
                           speed_m_s);
      worst.momentum = std::max(worst.momentum, (scene.momentum().linear - start).norm() / scale);
    }
    return worst;
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d cubes, number %d has %.3g of the others' mass, e %.1f, %.3g m/s, gap %.3g mm, %.2g ms",
                  count, place, ratio, e, speed_m_s, 1e3 * gap_m, 1e3 * dt_s);
    return text;
  }
};

// All families measure the same runs, so results are kept.
const MassRow::Errors& errorsOf(int member) {
  static std::map<int, MassRow::Errors> known;
  const auto it = known.find(member);
  return it != known.end() ? it->second : known.emplace(member, MassRow(member).errors()).first->second;
}

}  // namespace

std::vector<Family> massRatioFamilies() {
  const auto words = [](int i) { return MassRow(i).words(); };
  return {{"B_mass_ratios", "change of energy (e < 1: gain), relative", 1e-3, 216, 17,
           [](int i) { return errorsOf(i).energy; }, words},
          {"B_mass_ratio_momentum", "change of momentum, relative", 1e-9, 216, 17,
           [](int i) { return errorsOf(i).momentum; }, words},
          {"B_mass_ratio_turns", "speed by rotation of the equal bodies, over the first body's speed", 0.01,
           216, 2, [](int i) { return errorsOf(i).turn; }, words}};
}

}  // namespace vps::families

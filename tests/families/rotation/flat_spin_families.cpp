// SPDX-License-Identifier: BSD-3-Clause
// D: a body that lies flat on a plate without friction, or lands flat on it, and spins about the vertical.
//
// The plate pushes evenly and along the vertical only. The body therefore keeps its height, its place and its
// spin, however far it turns in a step. If Bullet turns a body by less than its angular velocity, which is
// reported, the corners are not where the velocity would take them; then only the energy is judged, which
// must not grow.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/turn.h"

namespace vps::families {
namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;
using test::Random;

constexpr double kThick_m = 6e-3, kStep_s = World::kStep_s;

struct FlatSpin {
  int sides = 0;  ///< sides of a prism; 0: a box
  Vec3 size_m{10e-3, 10e-3, 10e-3};
  double turn_rad = 0.15, drop_m = 0, heading_rad = 0;  ///< rotation in a step of 1 ms
  Vec3 place_m = Vec3::Zero();
  bool is_divided = false;

  /// In members 0 and 1 the fault was found. Every third body lands; for every other body the steps are
  /// divided.
  explicit FlatSpin(int member) {
    if (member == 0) return;
    is_divided = member % 2 == 1;
    if (member == 1) {
      turn_rad = 0.5;
      drop_m = 0.1e-3;
      return;
    }
    Random random(0xd5 + static_cast<std::uint64_t>(member));
    constexpr std::array<int, 4> kSides{0, 0, 6, 48};
    sides = kSides[static_cast<std::size_t>(member % 4)];
    const double x_m = random.logUniform(4e-3, 30e-3);
    const bool is_cube = member % 4 == 0;
    size_m = is_cube ? Vec3::Constant(x_m)
                     : Vec3(x_m, x_m * random.uniform(0.4, 1.5), random.uniform(3e-3, 20e-3));
    turn_rad = random.logUniform(0.05, 1.5);
    if (member % 3 == 0) drop_m = random.logUniform(2e-6, 3e-3);
    heading_rad = random.uniform(0, 6.2);
    place_m = random.inBox(Vec3(20e-3, 20e-3, 0));
  }
  [[nodiscard]] PartMesh part() const {
    if (sides == 0) return dynamics::makePart(makeBox(size_m));
    return dynamics::makePart(makeCylinder(0.5 * size_m.x(), size_m.z(), sides));
  }
  [[nodiscard]] double rim_m() const { return 0.5 * (sides == 0 ? size_m.head<2>().norm() : size_m.x()); }

  /// Greatest errors of all steps.
  struct Errors {
    double height_m =
        0;  ///< deviation of the height of any of its points; before it has landed: height above the start
    double sideways = 0;  ///< speed along the plate, as a share of the rim's
    double spin = 0;      ///< relative change of the spin
    double energy = 0;    ///< gain beyond the energy of 1 um of height, as a share of the kinetic energy
  };
  [[nodiscard]] Errors errors() const {
    bullet::Settings quiet;
    quiet.warns_of_turns = false;
    static const dynamics::Engine engine = dynamics::vpsEngine({0.25e-3, 0.5e-3}, quiet);
    World world({dynamics::Mode::Constraint, false, engine});
    static const PartMesh plate = dynamics::makePart(makeBox(Vec3(120e-3, 120e-3, kThick_m)));
    world.add(plate, Pose::translation({0, 0, -0.5 * kThick_m}), true, 0);
    const double low_m = 0.5 * size_m.z(), w_rad_s = turn_rad / kStep_s;
    const Vec3 at = place_m + Vec3(0, 0, low_m + drop_m);
    const Placed body = world.add(part(), Pose(rotationFromVector({0, 0, heading_rad}), at), false, 0);
    body.body->setAngularVelocity({0, 0, bullet::toBt(w_rad_s)});
    const auto energy_J = [&] {
      return dynamics::kineticEnergy_J(*body.body) + dynamics::heightEnergy_J(*body.body);
    };
    const double kinetic_J = dynamics::kineticEnergy_J(*body.body);
    const double most_J = energy_J() + 1e-6 * World::kGravity_m_s2 / body.body->getInvMass();
    // The body has landed after twice the time of its fall.
    const double land_s = drop_m > 0 ? 2 * std::sqrt(2 * drop_m / World::kGravity_m_s2) + 2e-3 : 0;
    Errors worst;
    for (int k = 0; k < 60 + static_cast<int>(land_s / kStep_s); ++k) {
      const int parts = is_divided ? bullet::substepsFor(world.bullet(), kStep_s, 10'000) : 1;
      world.step(parts, kStep_s / parts);
      const Pose X_WP = body.pose();
      const Vec3 v = bullet::fromBt(body.body->getLinearVelocity());
      const double height_m = X_WP.p.z() - low_m, tilt_m = rim_m() * X_WP.R.col(2).head<2>().norm();
      const bool has_landed = k * kStep_s >= land_s;
      worst.height_m =
          std::max(worst.height_m, tilt_m + (has_landed ? std::abs(height_m) : height_m - drop_m));
      worst.sideways = std::max(worst.sideways, v.head<2>().norm() / (rim_m() * w_rad_s));
      worst.spin = std::max(worst.spin, std::abs(body.body->getAngularVelocity().z() / w_rad_s - 1));
      worst.energy = std::max(worst.energy, (energy_J() - most_J) / kinetic_J);
    }
    return worst;
  }
  [[nodiscard]] std::string words() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%d sides (0: box), %.3g x %.3g x %.3g mm, %.3g rad a step%s, dropped %.3g mm", sides,
                  1e3 * size_m.x(), 1e3 * size_m.y(), 1e3 * size_m.z(), turn_rad,
                  is_divided ? ", divided" : "", 1e3 * drop_m);
    return text;
  }
};

// All families measure the same runs, so results are kept.
const FlatSpin::Errors& errorsOf(int member) {
  static std::map<int, FlatSpin::Errors> known;
  const auto it = known.find(member);
  return it != known.end() ? it->second : known.emplace(member, FlatSpin(member).errors()).first->second;
}

Family familyOf(const char* key, const char* measure, double bar, double FlatSpin::Errors::*error) {
  Family family{key, measure, bar, 60, 11, [error](int member) { return errorsOf(member).*error; }};
  family.describe = [](int member) { return FlatSpin(member).words(); };
  return family;
}

}  // namespace

std::vector<Family> flatSpinFamilies() {
  return {familyOf("D_flat_spin_height", "change of height of any point of a body that spins on a plate [m]",
                   1e-6, &FlatSpin::Errors::height_m),
          familyOf("D_flat_spin_sideways", "its speed along the plate over the speed of its rim", 1e-3,
                   &FlatSpin::Errors::sideways),
          familyOf("D_flat_spin_speed", "relative change of its spin", 1e-6, &FlatSpin::Errors::spin),
          familyOf("D_flat_spin_energy", "energy gained beyond 1 um of height, share", 1e-9,
                   &FlatSpin::Errors::energy)};
}

}  // namespace vps::families

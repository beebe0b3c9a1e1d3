// SPDX-License-Identifier: BSD-3-Clause
// K: a part spins on a flat face. Coulomb friction of a pressure p at the radius r has the moment mu p r. A
// pressure that is even over the face brakes with mu m g times the mean radius of the face, at any speed. The
// mean radius of a disc is 2/3 R, so a disc slows down by 4/3 mu g / R. If all pressure is at the rim, a disc
// is braked one and a half times as much.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "search/prism.h"
#include "support/lathe.h"
#include "support/random_draw.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::World;

constexpr int kParts = 12;

Mesh meshOf(int part) {
  using search::makePrism;
  using search::regularPolygon;
  constexpr double kHeight_m = 5e-3;
  const auto prism = [](const search::Polygon& outline) { return makePrism(outline, {}, 0, kHeight_m); };
  const auto disc = [](double r_m, int sides) {
    return test::lathe({{0, 0}, {r_m, 0}, {r_m, kHeight_m}, {0, kHeight_m}}, sides);
  };
  const auto ring = [](double inner_m, double outer_m, int sides) {
    return test::lathe({{inner_m, 0}, {outer_m, 0}, {outer_m, kHeight_m}, {inner_m, kHeight_m}}, sides);
  };
  switch (part) {
    case 0:
      return disc(10e-3, 128);
    case 1:
      return prism(search::rectangle({-10e-3, -10e-3}, {10e-3, 10e-3}));
    case 2:
      return disc(4e-3, 64);
    case 3:
      return disc(20e-3, 48);
    case 4:
      return ring(9e-3, 10e-3, 96);
    case 5:
      return ring(4e-3, 12e-3, 128);
    case 6:
      return prism(search::rectangle({-15e-3, -5e-3}, {15e-3, 5e-3}));
    case 7:
      return prism(regularPolygon(6, 8e-3));
    case 8:
      return prism(regularPolygon(3, 5e-3));
    case 9:
      return ring(2e-3, 20e-3, 32);
    case 10:
      return prism(search::rectangle({-4e-3, -4e-3}, {4e-3, 4e-3}));
    default:
      return disc(15e-3, 256);
  }
}

// A standing part, which is too low to tip; the face that touches is at z = 0.
const PartMesh& partOf(int part) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {double(part)}, [&] { return dynamics::makePart(meshOf(part)); });
}

// Mean distance of the face at z = 0 from the axis, by the midpoints of small triangles.
double meanRadius_m(const Mesh& mesh) {
  constexpr int kSplit = 24;
  double area_m2 = 0, moment_m3 = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    if (std::max({std::abs(a.z()), std::abs(b.z()), std::abs(c.z())}) > 1e-9) continue;
    const Vec3 u = (b - a) / kSplit, v = (c - a) / kSplit;
    const double piece_m2 = 0.5 * u.cross(v).norm();
    for (int i = 0; i < kSplit; ++i)
      for (int j = 0; i + j < kSplit; ++j)
        for (const double third : {1.0 / 3, 2.0 / 3}) {
          if (third > 0.5 && i + j + 1 >= kSplit) continue;
          area_m2 += piece_m2;
          moment_m3 += piece_m2 * (a + (i + third) * u + (j + third) * v).head<2>().norm();
        }
  }
  return moment_m3 / area_m2;
}

double inertiaAboutAxis(const PartMesh& part) {
  const Mat3 R = part.frame.X_PB.R;
  return (R * part.frame.inertia_kg_m2.asDiagonal() * R.transpose())(2, 2);
}

struct Spin {
  int part = 0;
  double mu = 0.15, dt_s = 1e-3, heading_rad = 0;
};

// In members 0 and 1 the fault was found.
Spin spinOf(int member) {
  Spin spin;
  spin.part = member % kParts;
  if (member < 2) return spin;
  test::Random random(static_cast<std::uint64_t>(member));
  spin.mu = random.uniform(0.05, 0.5);
  spin.dt_s = random.chance(0.75) ? 1e-3 : 0.25e-3;
  spin.heading_rad = random.uniform(0, 2 * std::numbers::pi);
  return spin;
}

std::string describe(int member) {
  const Spin s = spinOf(member);
  const Box box = bounds(partOf(s.part).mesh);
  char text[128];
  std::snprintf(text, sizeof text, "part %d, %.0fx%.0f mm, friction %.3f, dt %g ms", s.part,
                1e3 * box.size().x(), 1e3 * box.size().y(), s.mu, 1e3 * s.dt_s);
  return text;
}

// Relative difference between the deceleration and that of an even pressure.
double error(dynamics::Mode mode, int member) {
  constexpr double kGap_m = 0.1e-6, kWhole_s = 0.1, kFrom_s = 0.01, kTo_s = 0.05;
  static const dynamics::Engine engine = dynamics::vpsEngine();
  static const PartMesh plate = dynamics::makePart(makeBox({50e-3, 50e-3, 4e-3}));
  const Spin spin = spinOf(member);
  const PartMesh& part = partOf(spin.part);
  const double theory_rad_s2 =
      spin.mu * World::kGravity_m_s2 * part.frame.mass_kg * meanRadius_m(part.mesh) / inertiaAboutAxis(part);
  World world({mode, false, engine});
  world.add(plate, Pose::translation({0, 0, -2e-3}), true, spin.mu);
  const dynamics::Placed placed =
      world.add(part, Pose(rotationFromVector({0, 0, spin.heading_rad}), Vec3(0, 0, kGap_m)), false, spin.mu);
  // The part would stop after kWhole_s, and not before kTo_s even if all pressure were at the rim.
  placed.body->setAngularVelocity(btVector3(0, 0, btScalar(theory_rad_s2 * kWhole_s)));
  const auto speedAfter = [&](double duration_s) {
    world.step(static_cast<int>(std::lround(duration_s / spin.dt_s)), spin.dt_s);
    return static_cast<double>(placed.body->getAngularVelocity().z());
  };
  const double from_rad_s = speedAfter(kFrom_s), to_rad_s = speedAfter(kTo_s - kFrom_s);
  return std::abs((from_rad_s - to_rad_s) / (kTo_s - kFrom_s) / theory_rad_s2 - 1);
}

}  // namespace

std::vector<Family> spinningFaceFamilies() {
  Family constraint;
  constraint.key = "K_constraint";
  constraint.measure = "error of the deceleration by even pressure";
  constraint.bar = 0.05;
  constraint.members = 60;
  constraint.every = 7;  // coprime to the number of parts
  constraint.measured = [](int member) { return error(dynamics::Mode::Constraint, member); };
  constraint.describe = describe;
  Family penalty = constraint;
  penalty.key = "K_penalty";
  penalty.measured = [](int member) { return error(dynamics::Mode::Penalty, member); };
  return {constraint, penalty};
}

}  // namespace vps::families

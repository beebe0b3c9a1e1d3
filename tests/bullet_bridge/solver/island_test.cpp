// SPDX-License-Identifier: BSD-3-Clause
// Bodies of a shortened step continue as one body; tested by conservation laws.
#include "solver/island/island.h"

#include <gtest/gtest.h>

#include "support/random_draw.h"

namespace vps::bullet {
namespace {

struct Sums {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy_J = 0;

  explicit Sums(std::span<const BodyEnd> ends) {
    for (const BodyEnd& end : ends) {
      const Vec6 p = end.mass * end.v;
      linear += p.tail<3>();
      angular += p.head<3>() + end.X_WB.p.cross(Vec3(p.tail<3>()));
      energy_J += 0.5 * p.dot(end.v);
    }
  }
};

std::vector<BodyEnd> anyBodies(test::Random& random) {
  std::vector<BodyEnd> ends(static_cast<std::size_t>(2 + random.index(4)));
  for (BodyEnd& end : ends) {
    const double mass_kg = random.logUniform(0.01, 1);
    end.X_WB = Pose(random.rotation(), random.inBox(Vec3::Constant(0.1)));
    const Vec3 inertia =
        mass_kg * 1e-4 * Vec3(random.uniform(1, 2), random.uniform(1, 2), random.uniform(1, 2));
    end.mass.topLeftCorner<3, 3>() = end.X_WB.R * inertia.asDiagonal() * end.X_WB.R.transpose();
    end.mass.bottomRightCorner<3, 3>() = mass_kg * Mat3::Identity();
    end.v = stacked(20 * random.direction(), random.uniform(0, 2) * random.direction());
  }
  return ends;
}

TEST(CommonTurn, BodiesThatStopRelativeToEachOtherKeepTheMomentaAndLoseEnergy) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    test::Random random(seed);
    std::vector<BodyEnd> ends = anyBodies(random);
    const Sums before(ends);
    std::vector<Vec6> momenta;
    double mass_kg = 0;
    for (const BodyEnd& end : ends) {
      momenta.push_back(end.mass * end.v);
      mass_kg += end.mass(3, 3);
    }
    const Vec6 common = stacked(Vec3::Zero(), before.linear / mass_kg);
    const double kept = random.chance(0.3) ? 0 : random.uniform(0, 1);
    for (BodyEnd& end : ends) end.v = common + kept * (end.v - common);
    addTurn((1 - kept) * commonTurn(momenta, ends), ends);
    const Sums after(ends);
    EXPECT_LE((after.linear - before.linear).norm(), 1e-12 * before.linear.norm()) << seed;
    EXPECT_LE((after.angular - before.angular).norm(), 1e-12 * before.angular.norm()) << seed;
    EXPECT_LE(after.energy_J, before.energy_J) << seed;
  }
}

TEST(CommonTurn, OfABodyThatIsRigidIsItsOwn) {
  test::Random random(1);
  std::vector<BodyEnd> ends = anyBodies(random);
  const Vec3 w(3, -5, 7);
  std::vector<Vec6> momenta;
  for (BodyEnd& end : ends) {
    end.v = stacked(w, Vec3(1, 2, 3) + w.cross(end.X_WB.p));
    momenta.push_back(end.mass * end.v);
  }
  EXPECT_LE((commonTurn(momenta, ends) - w).norm(), 1e-12 * w.norm());
}

}  // namespace
}  // namespace vps::bullet

// SPDX-License-Identifier: BSD-3-Clause Between the shell points of a curved face gaps are smaller than at
// the points, by at most the bound.
#include "narrowphase/refinement/curved_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bullet_bridge/world.h"
#include "search/random.h"

namespace vps::bullet {
namespace {

TEST(Curvature, IsThatOfBothPrincipalDirections) {
  search::Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Mat3 R = random.rotation();
    const double a = random.uniform(-500, 500), b = random.uniform(-500, 500);
    const Curvature found(R * Vec3(a, b, 0).asDiagonal() * R.transpose());
    EXPECT_NEAR(found.most_per_m, std::max(a, b), 1e-9);
    EXPECT_NEAR(found.least_per_m, std::min(a, b), 1e-9);
  }
  EXPECT_EQ(Curvature(Mat3::Zero()).most_per_m, 0);
}

// Two touching balls: for any rotation, the gap at one of the points near the contact is at most the bound.
TEST(SamplingError, BoundsTheReadingOfTheNearestPoint) {
  static const test::Built big = test::build(makeSphere(8e-3, 5), 7850, 0.5e-3, 1e-3),
                           small = test::build(makeSphere(4e-3, 4), 7850, 0.5e-3, 1e-3);
  search::Random random(2);
  double most_m = 0;
  for (int i = 0; i < 100; ++i) {
    test::World world;
    btRigidBody& low = world.add(big, Pose(random.rotation(), Vec3::Zero()));
    btRigidBody& high = world.add(small, Pose(random.rotation(), Vec3(0, 0, 12e-3)));
    const btTransform X[2] = {low.getWorldTransform(), high.getWorldTransform()};
    const btCollisionObjectWrapper wrapper0(nullptr, big.shape.get(), &low, X[0], -1, -1),
        wrapper1(nullptr, small.shape.get(), &high, X[1], -1, -1);
    const PairView pair(&wrapper0, &wrapper1);
    std::vector<Candidate> near;
    for (int side = 0; side < 2; ++side) {
      const PointShell& shell = *pair.shape[side]->models().shell;
      for (std::uint32_t id = 0; id < shell.size(); ++id) {
        Candidate c;
        c.side = static_cast<std::uint8_t>(side);
        c.id = id;
        c.p_W = pair.side(side).X_WM * shell.points[id];
        c.distance_m = side == 0 ? (c.p_W - Vec3(0, 0, 12e-3)).norm() - 4e-3 : c.p_W.norm() - 8e-3;
        if (c.distance_m < 0.3e-3) near.push_back(c);
      }
    }
    const SamplingError error(pair, near);
    for (int side = 0; side < 2; ++side) {
      double least_m = 1;
      for (const Candidate& c : near)
        if (c.side == side) {
          least_m = std::min(least_m, c.distance_m - error.of_m(c));
          most_m = std::max(most_m, error.of_m(c));
        }
      EXPECT_LE(least_m, 0) << i;
    }
  }
  // (1 mm)^2 / 2 (1 / 4 mm + 1 / 8 mm), plus the error of the facets.
  EXPECT_NEAR(most_m, 187.5e-6, 25e-6);
}

TEST(SamplingError, IsZeroOnFlatFaces) {
  test::World world;
  static const test::Built box = test::steelBox(), plate = test::plate();
  btRigidBody& low = world.add(plate, Pose());
  btRigidBody& high = world.add(box, Pose::translation({0, 0, 10e-3}));
  const btTransform X[2] = {low.getWorldTransform(), high.getWorldTransform()};
  const btCollisionObjectWrapper wrapper0(nullptr, plate.shape.get(), &low, X[0], -1, -1),
      wrapper1(nullptr, box.shape.get(), &high, X[1], -1, -1);
  const PairView pair(&wrapper0, &wrapper1);
  std::vector<Candidate> near;
  for (std::uint32_t id = 0; id < box.shape->models().shell->size(); ++id) {
    Candidate c;
    c.side = 1;
    c.id = id;
    near.push_back(c);
  }
  const SamplingError error(pair, near);
  for (const Candidate& c : near) EXPECT_EQ(error.of_m(c), 0);
}

}  // namespace
}  // namespace vps::bullet

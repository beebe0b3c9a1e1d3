// SPDX-License-Identifier: BSD-3-Clause
// The lever of a contact's row in a step: wheels that roll, bodies that turn about a corner, impacts.
#include "narrowphase/check/step_path.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vps::bullet {
namespace {

constexpr double kRadius_m = 10e-3, kMass_kg = 0.1, kInertia_kg_m2 = 5e-6, kPathStep_s = 1e-3;

/// A body above a plate, and both ends of a step.
struct PathScene {
  btSphereShape shape{btScalar(kRadius_m)};
  btRigidBody body{btRigidBody::btRigidBodyConstructionInfo(
      btScalar(kMass_kg), nullptr, &shape,
      btVector3(btScalar(kInertia_kg_m2), btScalar(kInertia_kg_m2), btScalar(kInertia_kg_m2)))};
  btRigidBody plate{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape)};
  Pose start[2], end[2];

  [[nodiscard]] StepPath path() {
    const btCollisionObject* const objects[2] = {&body, &plate};
    return {objects, start, end, kPathStep_s};
  }
  /// Displacement of the body along z, as measured by a row at p.
  [[nodiscard]] double way_m(const Vec3& p) const {
    const Vec3 turn = rotationVector(end[0].R * start[0].R.transpose());
    return (end[0].p - start[0].p + turn.cross(p - start[0].p)).z();
  }
};

Candidate at(const Vec3& p, double distance_m) {
  Candidate c;
  c.p_W = p;
  c.n_W = Vec3::UnitZ();
  c.distance_m = distance_m;
  return c;
}

/// A wheel rolls along x by a tenth of a radian; the contact is the place that is lowest at the end.
TEST(StepPath, TheLeverOfAWheelIsBelowItsCentre) {
  PathScene scene;
  const double angle_rad = 0.1;
  scene.start[0].p = Vec3(0, 0, kRadius_m);
  scene.end[0] = Pose(rotationFromVector({0, angle_rad, 0}), Vec3(angle_rad * kRadius_m, 0, kRadius_m));
  const Vec3 lowest(angle_rad * kRadius_m, 0, 0);
  const Vec3 before = scene.start[0] * (scene.end[0].inverse() * lowest);
  const Candidate acting = scene.path().acting(at(before, before.z()), at(lowest, 0));
  // The gap at the start is that of the arc to second order in the angle.
  EXPECT_NEAR(acting.p_W.x(), 0, 0.01 * lowest.x());
  EXPECT_NEAR(scene.way_m(acting.p_W), 0, 0.01 * before.z());
  EXPECT_EQ(acting.distance_m, before.z());
}

/// A body turns about a corner that stays where it is, and passes over it.
TEST(StepPath, ABodyThatTurnsAboutACornerDoesNoWorkThere) {
  PathScene scene;
  const double half_rad = 0.03;
  const Vec3 corner = Vec3::Zero(), arm(0, 0, kRadius_m);
  for (const double side : {-1.0, 0.3}) {
    const Mat3 R[2] = {rotationFromVector({0, side * half_rad, 0}),
                       rotationFromVector({0, (side + 2) * half_rad, 0})};
    scene.start[0] = Pose(R[0], R[0] * arm);
    scene.end[0] = Pose(R[1], R[1] * arm);
    const Candidate acting = scene.path().acting(at(corner, 0), at(corner, 0));
    const double lever_m = acting.p_W.x() - scene.start[0].p.x();
    EXPECT_NEAR(lever_m, -kRadius_m * std::sin((side + 1) * half_rad), 1e-3 * half_rad * kRadius_m);
    // The lever at the start would raise the body, and the lever at the end would lower it, by a second-order
    // displacement.
    const double bend_m = 0.5 * kRadius_m * 4 * half_rad * half_rad;
    EXPECT_NEAR(scene.way_m(acting.p_W), 0, 0.01 * bend_m);
  }
}

/// The contact of a body that approaches faster than its weight moves it in a step acts where the body lands.
TEST(StepPath, AnImpactActsWhereItLands) {
  PathScene scene;
  scene.body.applyCentralForce(btVector3(0, 0, btScalar(-9.81 * kMass_kg)));
  scene.start[0].p = Vec3(0, 0, kRadius_m + 1e-3);
  scene.end[0] = Pose(rotationFromVector({0, 0.02, 0}), Vec3(0.1e-3, 0, kRadius_m));
  const Vec3 corner(3e-3, 0, 0);
  const Candidate acting = scene.path().acting(at(corner + Vec3(0, 0, 1e-3), 1e-3), at(corner, 0));
  EXPECT_NEAR((acting.p_W - (corner - (scene.end[0].p - scene.start[0].p))).norm(), 0, 1e-12);
}

/// A corner lands within the step after another corner carried the weight. The effective lever lies between
/// the levers of both corners.
TEST(StepPath, ACornerThatLandsSlowlyDoesNoWork) {
  PathScene scene;
  scene.body.applyCentralForce(btVector3(0, 0, btScalar(-9.81 * kMass_kg)));
  const double angle_rad = 0.01, side_m = 1e-3;
  scene.start[0].p = Vec3(0, 0, kRadius_m);
  scene.end[0] = Pose(rotationFromVector({0, angle_rad, 0}), Vec3(angle_rad * kRadius_m, 0, kRadius_m));
  const Vec3 corner(angle_rad * kRadius_m + 0.5 * side_m, 0, 0);
  const Vec3 before = scene.start[0] * (scene.end[0].inverse() * corner);
  ASSERT_LT(before.z(), 9.81 * kPathStep_s * kPathStep_s);
  Candidate landed = at(corner, 0);
  landed.crossed = 1;  // a corner on a facet of the plate
  landed.plane_of = 1;
  const Candidate acting = scene.path().acting(at(before, before.z()), landed);
  EXPECT_NEAR(scene.way_m(acting.p_W), 0, 0.02 * before.z());
  EXPECT_LT(acting.p_W.x(), 0.5 * side_m);
  // A point of a face acts where it lands.
  EXPECT_NEAR(scene.path().acting(at(before, before.z()), at(corner, 0)).p_W.x(), 0.5 * side_m, 1e-12);
}

/// Both bodies' levers pass through one point, for any rotation of the bodies.
TEST(StepPath, TheActingPointGoesWithTheBodyThatTurnsMoreEasily) {
  PathScene scene;
  scene.start[0].p = Vec3(0, 0, kRadius_m);
  scene.end[0].p = Vec3(0.2e-3, 0, kRadius_m);
  scene.end[1].p = Vec3(5e-3, 0, 0);  // a body that contact does not move
  const Candidate acting = scene.path().acting(at(Vec3(0, 0, 1e-3), 1e-3), at(Vec3(0.2e-3, 0, 0), 0));
  EXPECT_NEAR(acting.p_W.x(), 0, 1e-12);
}

}  // namespace
}  // namespace vps::bullet

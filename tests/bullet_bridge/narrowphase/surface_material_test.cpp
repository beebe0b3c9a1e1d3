// SPDX-License-Identifier: BSD-3-Clause
// A merged body whose parts have materials of their own.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "bullet_bridge/world.h"

namespace vps::bullet {
namespace {

using test::Built;
using test::SolverKind;
using test::World;

constexpr double kPlaceY_m = 0.03;

/// Two plates side by side as one body, with their tops at z = 0; plate i has its middle at y = i kPlaceY_m.
class TwoPlates {
 public:
  explicit TwoPlates(const std::array<SurfaceMaterial, 2>& materials, bool has_map = true) {
    const Mesh mesh = makeBox({0.06, 0.02, 0.006});
    VoxMapSettings voxels;
    voxels.voxel_m = 0.5e-3;
    PointShellSettings points;
    points.spacing_m = 1e-3;
    const auto part = buildPartModel("plate", mesh, voxels, points);
    ShapeModels models;
    const Pose at[2] = {place(0), place(1)};
    if (has_map)
      models.map = std::make_shared<VoxMap>(
          cookVoxMap({{part->solid.get(), at[0]}, {part->solid.get(), at[1]}}, voxels));
    models.shell =
        std::make_shared<PointShell>(mergedShells({part->shell.get(), part->shell.get()}, {at[0], at[1]}));
    for (const std::size_t i : {0U, 1U})
      models.surfaces.push_back({part->solid, at[i], nullptr, materials[i]});
    shape = std::make_shared<Shape>(std::move(models));
  }
  static Pose place(int i) { return Pose::translation({0, i * kPlaceY_m, -0.003}); }

  std::shared_ptr<Shape> shape;
};

const Built& block() {
  static const Built built = test::build(makeBox({0.01, 0.008, 0.006}), 7850, 0.5e-3, 1e-3);
  return built;
}

/// Distance that blocks slide on each plate in 60 ms, starting at 0.5 m/s; the blocks' own friction factor is
/// 1.
std::array<double, 2> slid(World& world, const TwoPlates& plates) {
  world.addShape(*plates.shape, 0, Vec3::Zero(), Pose()).setFriction(toBt(0.5));
  for (const int i : {0, 1}) {
    btRigidBody& body = world.add(block(), Pose::translation({-0.02, i * kPlaceY_m, 0.003}), false, 1);
    body.setLinearVelocity({toBt(0.5), 0, 0});
  }
  world.step(60);
  std::array<double, 2> slid_m{};
  for (const std::size_t i : {0U, 1U}) slid_m[i] = test::partPose(*world.bodies[i + 1], block()).p.x() + 0.02;
  return slid_m;
}

double expected_m(double mu) {
  double x_m = 0;
  for (int k = 1; k <= 60; ++k) x_m += 1e-3 * std::max(0.0, 0.5 - k * 1e-3 * mu * test::kGravity);
  return x_m;
}

SurfaceMaterial withFriction(double factor) {
  SurfaceMaterial material;
  material.friction = factor;
  return material;
}

class SurfaceMaterials : public testing::TestWithParam<std::tuple<SolverKind, bool>> {};

// Friction factors of 0.2 and 0.7, and the body's own value of 0.5.
TEST_P(SurfaceMaterials, EachContactHasTheFrictionOfTheSurfaceThatItTouches) {
  const auto [solver, has_map] = GetParam();
  for (const bool is_second_own : {true, false}) {
    World world(solver);
    const TwoPlates plates({withFriction(0.2), is_second_own ? withFriction(0.7) : SurfaceMaterial()},
                           has_map);
    const auto slid_m = slid(world, plates);
    EXPECT_NEAR(slid_m[0], expected_m(0.2), 0.01 * expected_m(0.2));
    const double second = is_second_own ? 0.7 : 0.5;
    EXPECT_NEAR(slid_m[1], expected_m(second), 0.01 * expected_m(second));
  }
}

INSTANTIATE_TEST_SUITE_P(All, SurfaceMaterials,
                         testing::Combine(testing::Values(SolverKind::Constraint, SolverKind::Penalty,
                                                          SolverKind::Stock),
                                          testing::Bool()),
                         [](const auto& info) {
                           return nameOf(std::get<0>(info.param)) +
                                  (std::get<1>(info.param) ? "WithMap" : "WithoutMap");
                         });

TEST(SurfaceMaterial, APointOfTheContactNamesTheSurface) {
  World world;
  const TwoPlates plates({withFriction(0.2), withFriction(0.7)});
  slid(world, plates);
  int contacts = 0;
  for (int i = 0; i < world.dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *world.dispatcher.getManifoldByIndexInternal(i);
    const bool is_first = manifold.getBody0() == world.bodies[0].get();
    const auto* other =
        static_cast<const btCollisionObject*>(is_first ? manifold.getBody1() : manifold.getBody0());
    for (int k = 0; k < manifold.getNumContacts(); ++k, ++contacts) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      EXPECT_EQ(is_first ? point.m_partId0 : point.m_partId1, other == world.bodies[1].get() ? 0 : 1);
      EXPECT_EQ(is_first ? point.m_partId1 : point.m_partId0, 0);
    }
  }
  EXPECT_GT(contacts, 0);
}

// Measured by the speed after a fall from 10 mm. In Bullet, impacts slower than 0.2 m/s do not bounce. Bullet
// multiplies the bodies' values.
TEST(SurfaceMaterial, EachContactHasTheRestitutionOfTheSurfaceThatItTouches) {
  SurfaceMaterial materials[2];
  materials[0].restitution = 0.3;
  materials[1].restitution = 0.8;
  const TwoPlates plates({materials[0], materials[1]});
  World world;
  world.addShape(*plates.shape, 0, Vec3::Zero(), Pose());
  for (const int i : {0, 1})
    world.add(block(), Pose::translation({0, i * kPlaceY_m, 0.013})).setRestitution(1);
  double fall_m_s[2] = {0, 0}, rise_m_s[2] = {0, 0};
  for (int step = 0; step < 500; ++step) {
    world.step(1, 1e-4);
    for (const std::size_t i : {0U, 1U}) {
      const double v_m_s = world.bodies[i + 1]->getLinearVelocity().z();
      fall_m_s[i] = std::max(fall_m_s[i], -v_m_s);
      rise_m_s[i] = std::max(rise_m_s[i], v_m_s);
    }
  }
  const double gravity_m_s = test::kGravity * 1e-4;
  EXPECT_NEAR(rise_m_s[0], 0.3 * fall_m_s[0], 2 * gravity_m_s);
  EXPECT_NEAR(rise_m_s[1], 0.8 * fall_m_s[1], 2 * gravity_m_s);
}

// A block sinks by its weight divided by stiffness and area; the softer side acts.
TEST(SurfaceMaterial, APenaltyContactHasTheStiffnessOfTheSofterSide) {
  SurfaceMaterial soft, hard;
  soft.stiffness_N_per_m3 = 1e8;
  hard.stiffness_N_per_m3 = 1e12;
  const TwoPlates plates({soft, hard});
  Settings settings;
  settings.stiffness_N_per_m3 = 4e8;  // of the blocks
  World world(SolverKind::Penalty, settings);
  world.addShape(*plates.shape, 0, Vec3::Zero(), Pose());
  for (const int i : {0, 1}) world.add(block(), Pose::translation({0, i * kPlaceY_m, 0.003}));
  world.step(500);
  const double weight_N = block().frame.mass_kg * test::kGravity, area_m2 = 0.01 * 0.008;
  for (const int i : {0, 1}) {
    const double sinks_m =
        0.003 - test::partPose(*world.bodies[static_cast<std::size_t>(i) + 1], block()).p.z();
    const double expected_m = weight_N / ((i == 0 ? 1e8 : 4e8) * area_m2);
    EXPECT_NEAR(sinks_m, expected_m, 0.1 * expected_m) << "the areas of both sides' points differ by a tenth";
  }
}

btScalar alwaysHalf(const btCollisionObject*, const btCollisionObject*) {
  return toBt(0.5);
}

// As in Bullet's own algorithms, the host's rule is called for each contact.
TEST(SurfaceMaterial, AHostsRuleOfFrictionTakesPrecedence) {
  const auto before = gCalculateCombinedFrictionCallback;
  gCalculateCombinedFrictionCallback = alwaysHalf;
  World world;
  const auto slid_m = slid(world, TwoPlates({withFriction(0.2), withFriction(0.7)}));
  gCalculateCombinedFrictionCallback = before;
  for (const double each_m : slid_m) EXPECT_NEAR(each_m, expected_m(0.5), 0.01 * expected_m(0.5));
}

TEST(SurfaceMaterial, IsKeptByAShapeThatIsScaled) {
  TwoPlates plates({withFriction(0.2), withFriction(0.7)});
  plates.shape->setLocalScaling({2, 2, 2});
  EXPECT_EQ(plates.shape->models().surfaces[0].material.friction, 0.2);
  EXPECT_EQ(plates.shape->models().surfaces[1].material.friction, 0.7);
}

// Nothing changes for a body that has materials equal to its own values.
TEST(SurfaceMaterial, EqualToTheBodysGivesTheSameBits) {
  btVector3 end[2];
  for (const bool is_own : {false, true}) {
    World world;
    const SurfaceMaterial own = withFriction(toBt(0.5));
    const TwoPlates plates(is_own ? std::array{own, own} : std::array{SurfaceMaterial(), SurfaceMaterial()});
    slid(world, plates);
    end[is_own ? 1 : 0] = world.bodies[2]->getWorldTransform().getOrigin();
  }
  EXPECT_EQ(end[0], end[1]);
}

TEST(SurfaceMaterial, WhatIsNoMaterialIsRefusedInWords) {
  const double nan = std::nan(""), infinite = HUGE_VAL;
  const auto refused = [](std::optional<double> friction, std::optional<double> restitution,
                          std::optional<double> stiffness) -> std::string {
    try {
      TwoPlates({SurfaceMaterial{}, SurfaceMaterial{friction, restitution, stiffness}}, false);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  for (const double bad : {-0.1, nan, infinite}) {
    EXPECT_NE(refused(bad, {}, {}).find("friction"), std::string::npos) << bad;
    EXPECT_NE(refused({}, bad, {}).find("restitution"), std::string::npos) << bad;
    EXPECT_NE(refused({}, {}, bad).find("stiffness"), std::string::npos) << bad;
  }
  EXPECT_NE(refused({}, 1.1, {}).find("restitution"), std::string::npos);
  EXPECT_NE(refused({}, {}, 0.0).find("stiffness"), std::string::npos);
  EXPECT_EQ(refused(0.0, 0.0, 1.0), "");
  EXPECT_EQ(refused(2.0, 1.0, {}), "");
}

// The surfaces are moved away from the shell's points, as mesh repair may move a surface.
TEST(SurfaceMaterial, APointBesideItsSurfaceBelongsToTheNearest) {
  const TwoPlates plates({SurfaceMaterial{}, SurfaceMaterial{}}, false);
  ShapeModels models = plates.shape->models();
  for (Surface& surface : models.surfaces) surface.X_MP.p.z() -= 5e-6;
  const Shape moved(std::move(models));
  const PointShell& shell = *moved.models().shell;
  for (std::uint32_t i = 0; i < shell.size(); ++i)
    EXPECT_EQ(moved.surfaceAt(i), shell.points[i].y() > kPlaceY_m / 2 ? 1 : 0) << i;
}

}  // namespace
}  // namespace vps::bullet

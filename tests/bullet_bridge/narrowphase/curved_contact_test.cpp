// SPDX-License-Identifier: BSD-3-Clause
// The nearest places of curved faces, compared with formulas for balls and cylinders; and the bound of the
// gap between shell points.
#include "narrowphase/refinement/curved_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "bullet_bridge/world.h"
#include "support/lathe.h"
#include "support/random_draw.h"

namespace vps::bullet {
namespace {

using test::Built;

constexpr double kMaxGain_m = 20e-6;  // as Settings::contact_margin_m
constexpr double kSpacing_m = 0.5e-3, kBall_m = 5e-3, kBelow_m = 20e-3;

const Built& ball() {
  static const Built built = test::build(makeSphere(kBall_m, 5), 7850, 0.25e-3, kSpacing_m);
  return built;
}

SideView viewOf(const Built& part, const Pose& X_WP, int side) {
  return {part.shape.get(), X_WP, static_cast<std::uint8_t>(side)};
}

struct FlushPoint {
  Candidate point;
  FacePoint foot;

  bool move(const SideView (&sides)[2]) {
    return moveToNearest(point, sides[point.side], sides[1 - point.side], foot, kMaxGain_m);
  }
};

// A shell point as refine() leaves it when it touches a face flush.
std::optional<FlushPoint> corrected(const SideView& side, const SideView& other, std::uint32_t id) {
  const ShapeModels& models = side.shape->models();
  const Surface& surface = other.shape->models().surfaces[0];
  const Solid& theirs = *surface.distance;
  const Vec3 p_W = side.X_WM * models.shell->points[id];
  const MeshDistance::Closest closest = theirs.closest(other.X_WM.inverse() * p_W, 0.1e-3);
  if (!closest.found) return {};
  const Vec3 n_W = other.X_WM.R * theirs.smoothNormal(closest.triangle, closest.q);
  if (n_W.dot(side.X_WM.R * models.shell->inward[id]) < 0.94) return {};
  Candidate c;
  c.id = id;
  c.side = side.side;
  c.p_W = p_W;
  c.n_W = (side.side == 0 ? 1 : -1) * n_W;
  c.distance_m = n_W.dot(p_W - other.X_WM * closest.q);
  return FlushPoint{c, {other.X_WM * closest.q, n_W, &surface, other.X_WM.R, closest.triangle}};
}

/// Nearest place of two faces, from a formula.
struct Truth {
  Vec3 p_W, n_W;  ///< n_W points from the part below to the ball
  double gap_m = 0;
};

struct Found {
  int moved = 0;
  double off_m = 0, gap_off_m = 0, tilt_rad = 0;  ///< greatest errors of the moved points
  double least_gap_m = 1e300;                     ///< smallest gap of all points
};

// Checks all points of both shells within one spacing of the place where the faces touch.
Found find(const Built& below, const Pose& X_WBall, const Truth& truth) {
  const SideView sides[2] = {viewOf(ball(), X_WBall, 0), viewOf(below, Pose(), 1)};
  Found found;
  for (const SideView& side : sides)
    for (std::uint32_t id = 0; id < side.shape->models().shell->size(); ++id) {
      const Vec3 p_W = side.X_WM * side.shape->models().shell->points[id];
      if ((p_W - truth.p_W).norm() > kSpacing_m || side.shape->isEdgePoint(id)) continue;
      std::optional<FlushPoint> flush = corrected(side, sides[1 - side.side], id);
      if (!flush) continue;
      const bool has_moved = flush->move(sides);
      const Candidate* c = &flush->point;
      found.least_gap_m = std::min(found.least_gap_m, c->distance_m);
      if (!has_moved) continue;
      ++found.moved;
      found.off_m = std::max(found.off_m, (c->p_W - truth.p_W).norm());
      found.gap_off_m = std::max(found.gap_off_m, std::abs(c->distance_m - truth.gap_m));
      found.tilt_rad = std::max(found.tilt_rad, c->n_W.cross(truth.n_W).norm());
    }
  return found;
}

// Facets of the ball are sqrt(4 pi / 20480 * 4 / sqrt(3)) r = 0.19 mm wide and up to a third of its square
// over 2 r inside the ball, 1.2 um; the same holds for facets of the parts below.
constexpr double kFacets_m = 2.4e-6;
// Newton's steps end within 5e-3 of the spacing, divided by the smaller radius; the same again for
// interpolated normals.
constexpr double kTilt_rad = 2 * 5e-3 * kSpacing_m / kBall_m;

// A ball slightly above, or slightly inside, ten places of a part: all points near the contact move to it.
void expectFound(const Built& below, const std::function<Truth(int)>& at) {
  for (int i = 0; i < 10; ++i) {
    const Truth truth = at(i);
    const Vec3 center = truth.p_W + (truth.gap_m + kBall_m) * truth.n_W;
    const Found found = find(below, Pose(rotationFromVector(Vec3(0.3 * i, 0.5, 0.7 * i)), center), truth);
    EXPECT_GE(found.moved, 2) << i;
    EXPECT_LE(found.tilt_rad, kTilt_rad) << i;
    EXPECT_LE(found.off_m, kTilt_rad * kBall_m + kFacets_m) << i;
    EXPECT_LE(found.gap_off_m, kFacets_m) << i;
  }
}

double gapAt(int i) {
  return (i - 5) * 1e-6;
}

// At the pole of a lathe's mesh 144 facets meet in a fan, whose normals differ from the ball's normals.
TEST(CurvedContact, PointsBesideTheHubOfAFanFindIt) {
  constexpr double kPi = std::numbers::pi, kRadius_m = 0.5e-3;
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= 72; ++i) {
    const double a_rad = (i / 72.0 - 0.5) * kPi;
    profile.push_back({i == 0 || i == 72 ? 0 : kRadius_m * std::cos(a_rad), kRadius_m * std::sin(a_rad)});
  }
  const Built fan = test::build(test::lathe(profile, 144), 7850, 0.05e-3, 0.1e-3);
  const Built plate = test::build(makeBox(Vec3(4e-3, 4e-3, 1e-3)), 7850, 0.1e-3, 0.2e-3);
  const SideView sides[2] = {viewOf(fan, Pose::translation({0, 0, 0.5e-3 + kRadius_m}), 0),
                             viewOf(plate, Pose(), 1)};
  int near = 0;
  for (std::uint32_t id = 0; id < fan.shape->models().shell->size(); ++id) {
    const Vec3 p_W = sides[0].X_WM * fan.shape->models().shell->points[id];
    if ((p_W - Vec3(0, 0, 0.5e-3)).norm() > 0.08e-3) continue;
    std::optional<FlushPoint> flush = corrected(sides[0], sides[1], id);
    if (!flush) continue;
    ++near;
    flush->move(sides);
    EXPECT_LE(flush->point.distance_m, 0.2e-6) << id;
  }
  EXPECT_GE(near, 2);
}

TEST(CurvedContact, PointsOfABallAndAPlateFindTheLowestPoint) {
  const Built plate = test::build(makeBox(Vec3(0.06, 0.06, 0.01)), 7850, 0.25e-3, kSpacing_m);
  expectFound(plate, [](int i) {
    return Truth{Vec3(1.7e-3 * i, -0.9e-3 * i, 5e-3), Vec3::UnitZ(), gapAt(i)};
  });
}

TEST(CurvedContact, PointsOfABallAndACylinderFindTheLineOfCentres) {
  const Built cylinder =
      test::build(transformed(makeCylinder(kBelow_m, 60e-3, 512),
                              Pose(rotationFromVector(Vec3(std::numbers::pi / 2, 0, 0)), Vec3::Zero())),
                  7850, 0.25e-3, kSpacing_m);
  expectFound(cylinder, [](int i) {
    const Vec3 n(std::sin(0.0377 * i), 0, std::cos(0.0377 * i));
    return Truth{kBelow_m * n + Vec3(0, 0.33e-3 * i, 0), n, gapAt(i)};
  });
}

TEST(CurvedContact, PointsOfTwoBallsFindTheLineOfCentres) {
  const Built large = test::build(makeSphere(kBelow_m, 6), 7850, 0.25e-3, kSpacing_m);
  expectFound(large, [](int i) {
    const Vec3 n = Vec3(0.3 * i - 1, 0.4, 1).normalized();
    return Truth{kBelow_m * n, n, gapAt(i)};
  });
}

TEST(CurvedContact, PointsOfABallInAHollowFindItsBottom) {
  const Built tube = test::build(makeTube(30e-3, 10e-3, 40e-3, 512), 7850, 0.25e-3, kSpacing_m);
  expectFound(tube, [](int i) {
    const Vec3 n(std::sin(0.0377 * i), std::cos(0.0377 * i), 0);
    return Truth{-10e-3 * n + Vec3(0, 0, 0.33e-3 * i), n, gapAt(i)};
  });
}

// The plate ends at x = 30 mm, where the ball overhangs: beyond the edge no point may act as if the face
// continued.
TEST(CurvedContact, APointDoesNotLeaveItsFaceOverTheEdge) {
  const Built plate = test::build(makeBox(Vec3(0.06, 0.06, 0.01)), 7850, 0.25e-3, kSpacing_m);
  for (int i = 0; i < 10; ++i) {
    const double over_m = 0.05e-3 * i;
    const Vec3 edge(30e-3, 0.77e-3 * i, 5e-3), center = edge + Vec3(over_m, 0, kBall_m);
    const double gap_m = (center - edge).norm() - kBall_m;
    const Found found = find(plate, Pose::translation(center), {edge, Vec3::UnitZ(), gap_m});
    EXPECT_LT(found.least_gap_m, 1);
    EXPECT_GE(found.least_gap_m, gap_m - kFacets_m) << i;
  }
}

// A ball of 1 mm with points 0.5 mm apart is up to 125 um deeper between its points, far more than the
// contact margin: contacts there would appear and disappear, and the ball would bounce.
TEST(CurvedContact, ASmallBallLiesStill) {
  const Built plate = test::build(makeBox(Vec3(0.06, 0.06, 0.01)), 7850, 0.25e-3, kSpacing_m);
  for (const double radius_m : {1e-3, 1.5e-3, 2e-3, 3e-3}) {
    const Built small = test::build(makeSphere(radius_m, 4), 7850, 0.1e-3, kSpacing_m);
    test::World world;
    world.add(plate, Pose(), true);
    btRigidBody& body = world.add(
        small, Pose(rotationFromVector(Vec3(0.4, 0.3, 0.2)), Vec3(0.3e-3, 0.1e-3, 5e-3 + radius_m)));
    world.step(500);
    double fastest_m_s = 0;
    for (int i = 0; i < 200; ++i) {
      world.step();
      fastest_m_s = std::max<double>(fastest_m_s, std::abs(body.getLinearVelocity().z()));
    }
    // The ball may roll sideways. Gravity adds 1e-2 m/s in a step.
    EXPECT_LE(fastest_m_s, 1e-3) << radius_m;
    EXPECT_GE(body.getWorldTransform().getOrigin().z(), 5e-3 + radius_m - 0.13e-3) << radius_m;
  }
}

// Without exact surfaces the face of a shell point is unknown.
TEST(CurvedContact, ABodyWithoutSurfacesRestsOnOneThatHasThem) {
  const Built plate = test::build(makeBox(Vec3(0.03, 0.03, 0.01)), 7850, 0.25e-3, kSpacing_m);
  Built bare = test::build(makeBox(Vec3::Constant(5e-3)), 7850, 0.25e-3, kSpacing_m);
  ShapeModels models = bare.shape->models();
  models.surfaces.clear();
  bare.shape->setModels(std::move(models));
  test::World world;
  world.add(plate, Pose(), true);
  btRigidBody& body = world.add(bare, Pose::translation({0, 0, 7.5e-3}));
  world.step(200);
  // The plate's points find no face of the body, but the body's points find faces of the plate.
  EXPECT_NEAR(body.getWorldTransform().getOrigin().z(), 7.5e-3, 5e-6);
}

TEST(CurvedContact, AConformingPegIsUnchanged) {
  const Built bore = test::build(makeTube(10e-3, 4.01e-3, 20e-3, 128), 7850, 0.25e-3, kSpacing_m);
  const Built peg = test::build(makeCylinder(4e-3, 20e-3, 128), 7850, 0.25e-3, kSpacing_m);
  const SideView sides[2] = {viewOf(peg, Pose(), 0), viewOf(bore, Pose(), 1)};
  int met = 0;
  for (std::uint32_t id = 0; id < peg.shape->models().shell->size(); ++id) {
    std::optional<FlushPoint> flush = corrected(sides[0], sides[1], id);
    if (!flush || peg.shape->isEdgePoint(id)) continue;
    ++met;
    EXPECT_FALSE(flush->move(sides)) << id;
  }
  EXPECT_GT(met, 100);
}

TEST(Curvature, IsThatOfBothPrincipalDirections) {
  test::Random random(1);
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
  test::Random random(2);
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

// SPDX-License-Identifier: BSD-3-Clause
// Points of edges that the field leaves out although they are inside.
#include "narrowphase/deeper_neighbours.h"

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <algorithm>
#include <vector>

#include "bullet_bridge/world.h"
#include "narrowphase/contact_selection.h"

namespace vps::bullet {
namespace {

using test::Built;

constexpr double kSpacing_m = 1e-3;

const Built& box() {
  static const Built built = test::build(makeBox(Vec3::Constant(0.01)), 7850, 0.25e-3, kSpacing_m);
  return built;
}

TEST(EdgeNeighbours, AreTheNearestEdgePoints) {
  const PointShell& shell = *box().shape->models().shell;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    std::vector<std::pair<double, std::uint32_t>> expected;
    for (std::uint32_t other = 0; other < shell.size() && box().shape->isEdgePoint(id); ++other) {
      const double distance_m = (shell.points[other] - shell.points[id]).norm();
      if (other != id && box().shape->isEdgePoint(other) && distance_m <= 1.5 * shell.spacing_m)
        expected.emplace_back(distance_m, other);
    }
    std::sort(expected.begin(), expected.end());
    const auto got = box().shape->edgeNeighbours().of(id);
    ASSERT_EQ(got.size(), std::min<std::size_t>(expected.size(), 8)) << shell.points[id].transpose();
    for (std::size_t k = 0; k < got.size(); ++k) EXPECT_EQ(got[k], expected[k].second);
  }
}

/// A box whose lower edge slants into the upper face of another, up to 50 um before its rim: two degrees
/// along x, and 30 across.
struct Slanted {
  btCollisionObject upper, lower;
  btCollisionObjectWrapper wrapper0{nullptr, box().shape.get(), &upper, upper.getWorldTransform(), -1, -1};
  btCollisionObjectWrapper wrapper1{nullptr, box().shape.get(), &lower, lower.getWorldTransform(), -1, -1};

  explicit Slanted(double depth_m) {
    const Mat3 R =
        rotationFromVector(Vec3(0, 2.0 / 180 * M_PI, 0)) * rotationFromVector(Vec3(M_PI / 6, 0, 0));
    const Vec3 lowest = R * Vec3(0.005, -0.005, -0.005);
    upper.setWorldTransform(toBt(Pose(R, Vec3(4.95e-3, 0, 0.005 - depth_m) - lowest)));
    lower.setWorldTransform(toBt(Pose()));
    upper.setCollisionShape(box().shape.get());
    lower.setCollisionShape(box().shape.get());
  }
  [[nodiscard]] PairView pair() const { return {&wrapper0, &wrapper1}; }
};

/// Edge points of the upper box whose exact gap is between these, the deepest first.
std::vector<Candidate> edgePoints(const PairView& pair, double least_m, double most_m) {
  const PointShell& shell = *box().shape->models().shell;
  std::vector<Candidate> points;
  for (std::uint32_t id = 0; id < shell.size(); ++id) {
    Candidate c;
    c.id = id;
    c.p_W = pair.side(0).X_WM * shell.points[id];
    c.n_W = Vec3::UnitZ();
    c.distance_m = box().exact->signedDistance(pair.side(1).X_WM.inverse() * c.p_W);
    if (box().shape->isEdgePoint(id) && c.distance_m > least_m && c.distance_m < most_m) points.push_back(c);
  }
  std::sort(points.begin(), points.end(),
            [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  return points;
}

TEST(DeeperNeighbours, AreAddedWhereTheFieldChoseOneThatIsLessDeep) {
  const Slanted boxes(40e-6);
  const PairView pair = boxes.pair();
  RelativeMotion still;
  still.contact_margin_m = 20e-6;
  const Settings settings;
  // The corner is 40 um deep, the next point of the edge 5 um.
  const std::vector<Candidate> edge = edgePoints(pair, -1, 0);
  ASSERT_GE(edge.size(), 2u);
  std::vector<Candidate> refined{edge[1]};
  refineAll(pair, still, settings, refined);
  dropUnreachable(still, refined);
  ASSERT_EQ(refined.size(), 1u);
  addDeeperNeighbours(pair, still, settings, nullptr, refined);
  ASSERT_EQ(refined.size(), 2u);
  EXPECT_EQ(refined[1].id, edge[0].id);
  EXPECT_NEAR(refined[1].distance_m, -40e-6, 1e-9);
  // With the corner there, nothing is missing.
  addDeeperNeighbours(pair, still, settings, nullptr, refined);
  EXPECT_EQ(refined.size(), 2u);
}

TEST(DeeperNeighbours, AreNotAddedWhereNothingOverlaps) {
  const Slanted boxes(-5e-6);
  const PairView pair = boxes.pair();
  RelativeMotion still;
  still.contact_margin_m = 100e-6;
  const Settings settings;
  std::vector<Candidate> refined = edgePoints(pair, 20e-6, 60e-6);
  ASSERT_GE(refined.size(), 1u);
  refineAll(pair, still, settings, refined);
  const std::size_t count = refined.size();
  addDeeperNeighbours(pair, still, settings, nullptr, refined);
  EXPECT_EQ(refined.size(), count);
}

}  // namespace
}  // namespace vps::bullet

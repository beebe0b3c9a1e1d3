// SPDX-License-Identifier: BSD-3-Clause
// When facets of two parts can meet on a screw motion: bounds against sampled points of the facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "motion/screw_sector.h"
#include "support/random_draw.h"
#include "support/units.h"

namespace vps::scenes {
namespace {

constexpr double kWithin_m = 0.2 * kMm;

/// A triangle of some millimetres around a point.
Triangle someTriangle(test::Random& draw, const Vec3& around) {
  const double size_m = draw.logUniform(0.5 * kMm, 8 * kMm);
  return {around + draw.inBox(Vec3::Constant(size_m)), around + draw.inBox(Vec3::Constant(size_m)),
          around + draw.inBox(Vec3::Constant(size_m))};
}

std::vector<Vec3> pointsOf(const Triangle& t) {
  constexpr int kSteps = 8;
  std::vector<Vec3> out;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; i + k <= kSteps; ++k)
      out.push_back((i * t[0] + k * t[1] + (kSteps - i - k) * t[2]) / kSteps);
  return out;
}

/// A small facet at a distance from the z axis, at an angle and a height.
Triangle facetAt(double radius_m, double angle_rad, double z_m) {
  const Mat3 R = rotationFromVector({0, 0, angle_rad});
  return {R * Vec3(radius_m, 0, z_m), R * Vec3(radius_m, 0.1 * kMm, z_m),
          R * Vec3(radius_m, 0, z_m + 0.1 * kMm)};
}

/// A triangle as seen from the axis of a screw.
struct Seen {
  ScrewSector sector;
  double nearest_m;
  Seen(const Triangle& t, const Motion& screw) {
    const Vec3 u = screw.direction.unitOrthogonal(), v = screw.direction.cross(u);
    nearest_m = axisExtent(t, screw.center, screw.direction, u, v).nearest_m;
    sector = screwSector(t, screw, u, v, nearest_m);
  }
};

/// When two triangles can meet, for a motion from the poses at which both are drawn.
MeetingTime timeOf(const Triangle& moving, const Triangle& held, const Motion& screw, double most_rad,
                   double sense = 1) {
  const Seen a(moving, screw), b(held, screw);
  return meetingTime(a.sector, b.sector, screw.forward_m, {0, sense * most_rad}, kWithin_m,
                     std::max(a.nearest_m, b.nearest_m));
}

TEST(ScrewSector, NoPointsMeetOutsideOfTheTime) {
  test::Random draw(1);
  int met = 0, bounded = 0;
  for (int i = 0; i < 400; ++i) {
    Motion screw{draw.direction(), draw.inBox(Vec3::Constant(5 * kMm)), true};
    screw.forward_m = draw.chance(0.2) ? 0 : draw.uniform(-1, 1) * draw.logUniform(0.2 * kMm, 60 * kMm);
    const double sense = draw.chance(0.5) ? 1 : -1, most_rad = draw.uniform(0.5, 15);
    const Triangle moving = someTriangle(draw, draw.inBox(Vec3::Constant(15 * kMm)));
    // Half of the held facets are in the way of the moving one.
    const double at_rad = sense * draw.uniform(0, most_rad);
    const Vec3 around =
        draw.chance(0.5) ? Vec3(screw.at(at_rad) * moving[0]) : draw.inBox(Vec3::Constant(15 * kMm));
    const Triangle held = someTriangle(draw, around);
    const MeetingTime time = timeOf(moving, held, screw, most_rad, sense);
    if (time.isNever() || time.from_rad > 0.01 || time.to_rad < most_rad - 0.01) ++bounded;
    const std::vector<Vec3> of_moving = pointsOf(moving), of_held = pointsOf(held);
    constexpr int kTimes = 80;
    for (int k = 0; k <= kTimes; ++k) {
      const double s = most_rad * k / kTimes;
      if (!time.isNever() && s >= time.from_rad && s <= time.to_rad) continue;
      const Pose X = screw.at(sense * s);
      for (const Vec3& p : of_moving)
        for (const Vec3& q : of_held)
          ASSERT_GT((X * p - q).norm(), kWithin_m) << "case " << i << " at " << s << " rad";
    }
    met += time.isNever() ? 0 : 1;
  }
  EXPECT_GT(met, 150);      // the facets in the way
  EXPECT_GT(bounded, 200);  // the bounds exclude something in most cases
}

TEST(ScrewSector, ATurnMeetsAtTheAngleBetweenTheFacets) {
  const Motion turn{Vec3::UnitZ(), Vec3::Zero(), true};
  const MeetingTime time = timeOf(facetAt(20 * kMm, 0.5, 0), facetAt(20 * kMm, 2, 0), turn, 6);
  // Each facet spans 0.1 mm / 20 mm = 0.005 rad, and the distance adds 0.01 rad to both sides.
  EXPECT_NEAR(time.from_rad, 1.485, 1e-3);
  EXPECT_NEAR(time.to_rad, 1.515, 1e-3);
  EXPECT_TRUE(timeOf(facetAt(20 * kMm, 0.5, 0), facetAt(20 * kMm, 2, 0), turn, 1.4).isNever());
}

TEST(ScrewSector, AScrewMeetsOnlyFacetsOfItsPhase) {
  Motion screw{Vec3::UnitZ(), Vec3::Zero(), true};
  screw.forward_m = 2 * kMm;  // per radian
  const Triangle moving = facetAt(20 * kMm, 0, 0);
  EXPECT_FALSE(timeOf(moving, facetAt(20 * kMm, 1, 2 * kMm), screw, 20).isNever());
  EXPECT_TRUE(timeOf(moving, facetAt(20 * kMm, 1, 3 * kMm), screw, 20).isNever());
  // One turn later, 4 pi mm further along the axis.
  const MeetingTime time = timeOf(moving, facetAt(20 * kMm, 1, (2 + 4 * std::numbers::pi) * kMm), screw, 20);
  EXPECT_NEAR(time.from_rad, 1 + 2 * std::numbers::pi, 0.02);
}

TEST(ScrewSector, ASumOfSectorsMeetsWheneverOneOfThemDoes) {
  test::Random draw(2);
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    Motion screw{Vec3::UnitZ(), Vec3::Zero(), true};
    screw.forward_m = draw.uniform(-1, 1) * draw.logUniform(0.2 * kMm, 60 * kMm);
    const Triangle held = someTriangle(draw, draw.inBox(Vec3::Constant(15 * kMm)));
    const Seen of_held(held, screw);
    ScrewSector sum;
    double nearest_m = 1;
    std::vector<MeetingTime> times;
    // Two facets near each other, on either side of where angles jump by a whole turn.
    const Vec3 around(-12 * kMm, 0, draw.uniform(-5, 5) * kMm);
    for (const double y_m : {-1 * kMm, 1 * kMm}) {
      const Triangle part = facetAt(std::hypot(around.x(), y_m), std::atan2(y_m, around.x()), around.z());
      const Seen seen(part, screw);
      sum.add(seen.sector, screw.forward_m);
      nearest_m = std::min(nearest_m, seen.nearest_m);
      times.push_back(timeOf(part, held, screw, 12));
    }
    EXPECT_LT(sum.to_rad - sum.from_rad, 0.3);
    const MeetingTime of_sum = meetingTime(sum, of_held.sector, screw.forward_m, {0, 12}, kWithin_m,
                                           std::max(nearest_m, of_held.nearest_m));
    for (const MeetingTime& one : times) {
      if (one.isNever()) continue;
      ++met;
      ASSERT_FALSE(of_sum.isNever()) << i;
      EXPECT_LE(of_sum.from_rad, one.from_rad + 1e-9);
      EXPECT_GE(of_sum.to_rad, std::min(12.0, one.to_rad) - 1e-9);
    }
  }
  EXPECT_GT(met, 20);
}

TEST(ScrewSector, AFacetOnTheAxisIsAllAround) {
  const Motion turn{Vec3::UnitZ(), Vec3::Zero(), true};
  const Triangle on_axis = {Vec3(-1 * kMm, -1 * kMm, 0), Vec3(1 * kMm, -1 * kMm, 0), Vec3(0, 1 * kMm, 0)};
  const MeetingTime time = timeOf(on_axis, facetAt(0.5 * kMm, 0, 0), turn, 3);
  EXPECT_EQ(time.from_rad, 0);
  EXPECT_GE(time.to_rad, 3);
}

}  // namespace
}  // namespace vps::scenes

// SPDX-License-Identifier: BSD-3-Clause
// A hand brings one part into another. All sizes are random, in the range of the parts of a hand tool.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "families.h"
#include "prism.h"

namespace vps::search {

namespace {

/// The clearance between the sides of a fit, from tight to loose.
double drawClearance(Random& random) {
  return random.logUniform(20e-6, 500e-6);
}
double drawFitFriction(Random& random) {
  const double values[] = {0, 0.15, 0.5};
  return values[random.index(3)];
}

CaseBody fixedBody(const char* name, Mesh mesh, double friction) {
  CaseBody body{name, std::move(mesh), {}, Pose(), true, friction, {}};
  return body;
}

/// Goals of a hand that pushes a part in along `axis` and pulls it out again. The hand's aim is exact in some
/// of the cases.
/// @param travel_m  positions along the axis between which the part is free to move in its fit
Hand drawHand(Random& random, std::size_t body, const Pose& X_WP, const Vec3& axis, double low_m,
              double high_m) {
  Hand hand;
  hand.body = body;
  const bool is_exact = random.chance(0.2);
  const double aim_m = is_exact ? 0 : random.logUniform(10e-6, 3e-3);
  const double aim_rad = is_exact ? 0 : random.logUniform(1e-3, 0.3);
  for (int i = 0; i < 60; ++i) {
    const Vec3 along = axis * random.uniform(low_m, high_m);
    hand.goals.push_back({{random.tilt(aim_rad) * X_WP.R, X_WP.p + along + aim_m * random.direction()},
                          random.logUniform(0.01, 0.2),
                          random.logUniform(0.1, 5)});
  }
  return hand;
}

/// A part with a profile, and the slot for it, both along x.
/// @param stem  index of the profile's corner at the top right of its stem; the next corner is at the top
/// left
Case slideInSlot(Random& random, const Polygon& profile, std::size_t stem) {
  const double clearance_m = drawClearance(random), friction = drawFitFriction(random);
  const Polygon slot = enlarged(profile, clearance_m / 2);
  const std::size_t n = slot.size();
  const double width_m = 1.5 * profile[1].x() + random.uniform(3e-3, 8e-3);
  // The stem protrudes from the rail.
  const double top_m = profile[stem].y() - random.uniform(1e-3, 3e-3), floor_m = -random.uniform(3e-3, 8e-3);
  Polygon rail{{-width_m, floor_m}, {width_m, floor_m}, {width_m, top_m}, {slot[stem].x(), top_m}};
  for (std::size_t k = 1; k + 1 < n; ++k) rail.push_back(slot[(stem + n - k) % n]);
  rail.emplace_back(slot[(stem + 1) % n].x(), top_m);
  rail.emplace_back(-width_m, top_m);

  const double rail_m = random.uniform(20e-3, 40e-3), block_m = random.uniform(8e-3, 25e-3);
  const double outside_m = (rail_m + block_m) / 2 + random.uniform(0.2e-3, 5e-3);
  const double start_m = random.chance(0.7) ? -outside_m : random.uniform(-rail_m, rail_m) / 2;
  Case made;
  made.bodies.push_back(fixedBody("rail", alongX(makePrism(rail, {}, -rail_m / 2, rail_m / 2)), friction));
  made.bodies.push_back({"block",
                         alongX(makePrism(profile, {}, -block_m / 2, block_m / 2)),
                         {},
                         Pose::translation(Vec3(start_m, 0, 0)),
                         false,
                         friction,
                         {}});
  made.hand = drawHand(random, 1, Pose(), Vec3::UnitX(), -outside_m, outside_m);
  made.hand->goals.front() = {Pose(), random.logUniform(0.02, 0.2), 5};
  made.seconds = random.uniform(0.5, 2);
  return made;
}

/// A prism above a plate with a hole of the prism's shape, along z.
Case insertInHole(Random& random, const Polygon& profile, bool has_floor) {
  const double clearance_m = drawClearance(random), friction = drawFitFriction(random);
  double reach_m = 0;
  for (const Vec2& p : profile) reach_m = std::max(reach_m, p.norm());
  const double half_m = reach_m + random.uniform(3e-3, 8e-3);
  const double plate_m = random.uniform(5e-3, 15e-3), peg_m = random.uniform(8e-3, 25e-3);
  const Polygon hole = enlarged(profile, clearance_m / 2);
  Case made;
  made.bodies.push_back(fixedBody(
      "plate", makePrism(rectangle(Vec2(-half_m, -half_m), Vec2(half_m, half_m)), {hole}, -plate_m, 0),
      friction));
  if (has_floor)
    made.bodies.push_back(fixedBody(
        "floor",
        makePrism(rectangle(Vec2(-half_m, -half_m), Vec2(half_m, half_m)), {}, -plate_m - 5e-3, -plate_m),
        friction));
  const double start_m = random.uniform(0.1e-3, 3e-3);
  made.bodies.push_back({"peg",
                         makePrism(profile, {}, 0, peg_m),
                         {},
                         {random.tilt(random.chance(0.5) ? 0 : 5e-3), Vec3(0, 0, start_m)},
                         false,
                         friction,
                         {}});
  made.hand = drawHand(random, made.bodies.size() - 1, Pose(), Vec3::UnitZ(), -plate_m - 2e-3, 3e-3);
  made.hand->goals.front() = {Pose::translation(Vec3(0, 0, -plate_m)), random.logUniform(0.02, 0.2), 5};
  made.seconds = random.uniform(0.5, 2);
  return made;
}

/// Teeth that point along y from a common back; the first tooth begins at x = 0.
Polygon comb(int teeth, double tooth_m, double gap_m, double length_m, double back_m) {
  Polygon polygon{{0, -back_m}, {teeth * tooth_m + (teeth - 1) * gap_m, -back_m}};
  for (int i = teeth - 1; i >= 0; --i) {
    const double left_m = i * (tooth_m + gap_m), right_m = left_m + tooth_m;
    if (i < teeth - 1) polygon.emplace_back(right_m, 0);
    polygon.emplace_back(right_m, length_m);
    polygon.emplace_back(left_m, length_m);
    if (i > 0) polygon.emplace_back(left_m, 0);
  }
  return polygon;
}

/// A polygon with corners at random radii around the origin.
Polygon star(Random& random, int corners) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * (i + random.uniform(-0.25, 0.25)) / corners;
    polygon.push_back(random.uniform(4e-3, 12e-3) * Vec2(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return polygon;
}

}  // namespace

Case drawTSlot(Random& random) {
  const double stem_m = random.uniform(2e-3, 5e-3), head_m = stem_m + random.uniform(1.5e-3, 5e-3);
  const double height_m = random.uniform(2e-3, 6e-3), top_m = height_m + random.uniform(5e-3, 10e-3);
  const Polygon profile{{-head_m, 0},    {head_m, 0},      {head_m, height_m},  {stem_m, height_m},
                        {stem_m, top_m}, {-stem_m, top_m}, {-stem_m, height_m}, {-head_m, height_m}};
  return slideInSlot(random, profile, 4);
}

Case drawDovetail(Random& random) {
  const double neck_m = random.uniform(2e-3, 5e-3), foot_m = neck_m + random.uniform(1e-3, 4e-3);
  const double height_m = random.uniform(3e-3, 8e-3), top_m = height_m + random.uniform(4e-3, 8e-3);
  const Polygon profile{{-foot_m, 0},    {foot_m, 0},      {neck_m, height_m},
                        {neck_m, top_m}, {-neck_m, top_m}, {-neck_m, height_m}};
  return slideInSlot(random, profile, 3);
}

Case drawKey(Random& random) {
  const Vec2 half(random.uniform(5e-3, 15e-3), random.uniform(1.5e-3, 4e-3));
  return insertInHole(random, rectangle(-half, half), true);
}

Case drawSquarePeg(Random& random) {
  return insertInHole(random, regularPolygon(4, random.uniform(2e-3, 10e-3)), random.chance(0.5));
}

Case drawHexagonalPeg(Random& random) {
  return insertInHole(random, regularPolygon(6, random.uniform(2e-3, 10e-3)), random.chance(0.5));
}

Case drawComb(Random& random) {
  const int teeth = 2 + random.index(4);
  const double tooth_m = random.uniform(1.5e-3, 4e-3), clearance_m = drawClearance(random);
  const double length_m = random.uniform(4e-3, 12e-3), friction = drawFitFriction(random);
  const double gap_m = tooth_m + clearance_m, height_m = random.uniform(4e-3, 12e-3);
  const Polygon polygon = comb(teeth, tooth_m, gap_m, length_m, random.uniform(3e-3, 6e-3));
  Case made;
  made.bodies.push_back(fixedBody("comb", makePrism(polygon, {}, 0, height_m), friction));
  // The other comb is rotated by half a turn about z, so that its teeth point into the gaps of the first one.
  CaseBody other = made.bodies.front();
  other.name = "other";
  other.is_fixed = false;
  const Mat3 R = rotationFromVector(Vec3(0, 0, std::numbers::pi));
  const double across_m = polygon[1].x() + tooth_m + clearance_m / 2;
  const Pose X_home(R, Vec3(across_m, length_m, 0));
  const double outside_m = length_m + random.uniform(0.1e-3, 3e-3);
  other.X_WP = {R, X_home.p + Vec3(0, random.chance(0.7) ? outside_m : length_m / 2, 0)};
  made.bodies.push_back(std::move(other));
  made.hand = drawHand(random, 1, X_home, Vec3::UnitY(), -1e-3, outside_m);
  made.hand->goals.front() = {X_home, random.logUniform(0.02, 0.2), 5};
  made.seconds = random.uniform(0.5, 2);
  return made;
}

Case drawPuzzle(Random& random) {
  const int corners = 6 + 2 * random.index(3);
  const Polygon whole = star(random, corners);
  const double thick_m = random.uniform(3e-3, 8e-3), friction = drawFitFriction(random);
  Case made = insertInHole(random, whole, true);
  const double plate_m = -made.bodies.front().mesh.vertices.front().z();
  // The star is cut from one corner through the origin to the opposite corner, with a clearance.
  const auto half = static_cast<std::ptrdiff_t>(corners / 2);
  Polygon first(whole.begin(), whole.begin() + half + 1), second(whole.begin() + half, whole.end());
  second.push_back(whole.front());
  for (Polygon* piece : {&first, &second}) piece->push_back(Vec2::Zero());
  const double cut_m = -drawClearance(random) / 4;
  first = enlarged(first, cut_m);
  second = enlarged(second, cut_m);
  made.bodies.back() = {"held", makePrism(first, {}, 0, thick_m),
                        {},     Pose::translation(Vec3(0, 0, random.uniform(0.1e-3, 3e-3))),
                        false,  friction,
                        {}};
  made.bodies.push_back({"loose",
                         makePrism(second, {}, 0, thick_m),
                         {},
                         Pose::translation(Vec3(0, 0, -plate_m + random.uniform(10e-6, 1e-3))),
                         false,
                         friction,
                         {}});
  return made;
}

}  // namespace vps::search

// SPDX-License-Identifier: BSD-3-Clause
// Parts that fall at up to 1 m/s with spin, and touch several others at once.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "families.h"
#include "prism.h"

namespace vps::search {

namespace {

double drawFriction(Random& random) {
  const double values[] = {0, 0.15, 0.5};
  return values[random.index(3)];
}

CaseBody fixedBox(const char* name, const Vec3& low, const Vec3& high, double friction) {
  return {name, makeBox(high - low), {}, Pose::translation(0.5 * (low + high)), true, friction, {}};
}

/// A floor whose top is z = 0, and walls around the square |x|, |y| <= half_m.
std::vector<CaseBody> makeTray(double half_m, double height_m, double friction) {
  constexpr double kThick_m = 5e-3;
  const double outer_m = half_m + kThick_m;
  return {
      fixedBox("floor", Vec3(-outer_m, -outer_m, -kThick_m), Vec3(outer_m, outer_m, 0), friction),
      fixedBox("wall_left", Vec3(-outer_m, -outer_m, 0), Vec3(-half_m, outer_m, height_m), friction),
      fixedBox("wall_right", Vec3(half_m, -outer_m, 0), Vec3(outer_m, outer_m, height_m), friction),
      fixedBox("wall_front", Vec3(-half_m, -outer_m, 0), Vec3(half_m, -half_m, height_m), friction),
      fixedBox("wall_back", Vec3(-half_m, half_m, 0), Vec3(half_m, outer_m, height_m), friction),
  };
}

/// The mesh, moved so that its centre of mass is at the origin.
Mesh centred(Mesh mesh) {
  const Vec3 com = massProperties(mesh).com;
  for (Vec3& p : mesh.vertices) p -= com;
  return mesh;
}

Mesh drawTetrahedron(Random& random, double size_m) {
  for (;;) {
    const Vec3 half = Vec3::Constant(size_m / 2);
    const Mesh mesh =
        makeTetrahedron(random.inBox(half), random.inBox(half), random.inBox(half), random.inBox(half));
    // Draws again if the tetrahedron is a sliver.
    if (massProperties(mesh).volume_m3 > 0.02 * size_m * size_m * size_m) return centred(mesh);
  }
}

/// A prism over a convex polygon of three to six sides. In half of the cases it is slanted and tapered, so
/// that few faces are parallel.
Mesh drawPrism(Random& random, double size_m) {
  const int sides = 3 + random.index(4);
  Polygon polygon;
  for (int i = 0; i < sides; ++i) {
    const double angle_rad = 2 * std::numbers::pi * (i + random.uniform(-0.3, 0.3)) / sides;
    polygon.push_back(size_m / 2 * Vec2(std::cos(angle_rad), std::sin(angle_rad)));
  }
  const double half_m = size_m * random.logUniform(0.1, 0.8);
  Mesh mesh = makePrism(polygon, {}, -half_m, half_m);
  if (random.chance(0.5)) {  // slanted and tapered; the sides stay plane
    const Vec3 slant(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 1);
    const double taper = random.uniform(0, 0.4);
    for (Vec3& p : mesh.vertices) {
      const double factor = 1 - taper * (p.z() + half_m) / (2 * half_m);
      p = Vec3(factor * p.x(), factor * p.y(), 0) + p.z() * slant;
    }
  }
  return centred(mesh);
}

/// A pipe of seven to forty sides with sharp rims, whose corners are convex on the outside and concave in the
/// bore.
Mesh drawRing(Random& random, double size_m) {
  const int sides = 7 + random.index(34);
  const double inner = random.uniform(0.4, 0.9);
  Polygon outer, hole;
  for (int i = 0; i < sides; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / sides;
    outer.push_back(size_m / 2 * Vec2(std::cos(angle_rad), std::sin(angle_rad)));
    hole.push_back(inner * outer.back());
  }
  const double half_m = size_m * random.logUniform(0.1, 0.6);
  return centred(makePrism(outer, {hole}, -half_m, half_m));
}

/// Bodies above each other, each with a random rotation and motion, mostly downwards.
void dropAll(Random& random, std::vector<Mesh> meshes, double above_m, double aside_m, double friction,
             std::vector<CaseBody>& out) {
  for (Mesh& mesh : meshes) {
    double radius_m = 0;
    for (const Vec3& p : mesh.vertices) radius_m = std::max(radius_m, p.norm());
    above_m += radius_m + random.logUniform(10e-6, 3e-3);
    CaseBody body;
    body.name = "body" + std::to_string(out.size());
    body.mesh = std::move(mesh);
    body.X_WP = {random.rotation(),
                 Vec3(random.uniform(-aside_m, aside_m), random.uniform(-aside_m, aside_m), above_m)};
    body.friction = friction;
    body.V_WP_W.v = random.uniform(0, 1) * (Vec3(0, 0, -1) + 0.7 * random.direction()).normalized();
    body.V_WP_W.w = random.direction() * random.logUniform(0.1, 30);
    above_m += radius_m;
    out.push_back(std::move(body));
  }
}

struct Range {
  double from, to;
  [[nodiscard]] double draw(Random& random) const { return random.uniform(from, to); }
};

/// Bodies that fall into a tray.
struct Fall {
  Range size_m;         ///< of the greatest body
  Range room;           ///< half the tray's width, in units of size_m
  int fewest, choices;  ///< least number of bodies, and how many numbers are possible
  Range seconds;
};

/// @param drawMesh  called with the size, once for each body
template <typename DrawMesh>
Case drawFall(Random& random, const Fall& fall, const DrawMesh& drawMesh) {
  const double friction = drawFriction(random), size_m = fall.size_m.draw(random);
  Case made;
  made.bodies = makeTray(fall.room.draw(random) * size_m, 3 * size_m, friction);
  std::vector<Mesh> meshes(static_cast<std::size_t>(fall.fewest + random.index(fall.choices)));
  for (Mesh& mesh : meshes) mesh = drawMesh(size_m);
  dropAll(random, std::move(meshes), 0, 0, friction, made.bodies);
  made.seconds = fall.seconds.draw(random);
  return made;
}

}  // namespace

Case drawTetrahedra(Random& random) {
  return drawFall(random, {{10e-3, 40e-3}, {0.6, 1.2}, 1, 3, {0.3, 1}},
                  [&](double size_m) { return drawTetrahedron(random, size_m); });
}

Case drawPrisms(Random& random) {
  return drawFall(random, {{8e-3, 25e-3}, {0.8, 2}, 2, 4, {0.5, 1.5}},
                  [&](double size_m) { return drawPrism(random, random.uniform(0.5, 1) * size_m); });
}

Case drawRings(Random& random) {
  return drawFall(random, {{10e-3, 30e-3}, {0.6, 1.2}, 2, 3, {0.3, 1}},
                  [&](double size_m) { return drawRing(random, random.uniform(0.5, 1) * size_m); });
}

Case drawStairs(Random& random) {
  const double friction = drawFriction(random);
  const double rise_m = random.uniform(3e-3, 10e-3), tread_m = random.uniform(5e-3, 15e-3);
  const int steps = 3 + random.index(4);
  // The profile of the stairs in the (x, z) plane, which go down towards +x.
  const double length_m = steps * tread_m + 20e-3;
  Polygon profile{{0, -5e-3}, {length_m, -5e-3}, {length_m, 0}};
  for (int i = 0; i <= steps; ++i) {
    const double x_m = (steps - i) * tread_m;
    profile.emplace_back(x_m, i * rise_m);
    if (i < steps) profile.emplace_back(x_m, (i + 1) * rise_m);
  }
  const double top_m = steps * rise_m, half_m = random.uniform(10e-3, 20e-3);
  Mesh stairs = makePrism(profile, {}, -half_m, half_m);
  for (Vec3& p : stairs.vertices) p = Vec3(p.x(), -p.z(), p.y());
  const double high_m = top_m + 60e-3;
  Case made;
  made.bodies.push_back({"stairs", stairs, {}, Pose(), true, friction, {}});
  made.bodies.push_back(
      fixedBox("side_left", Vec3(0, half_m, -5e-3), Vec3(length_m, half_m + 5e-3, high_m), friction));
  made.bodies.push_back(
      fixedBox("side_right", Vec3(0, -half_m - 5e-3, -5e-3), Vec3(length_m, -half_m, high_m), friction));
  made.bodies.push_back(
      fixedBox("back", Vec3(-5e-3, -half_m - 5e-3, -5e-3), Vec3(0, half_m + 5e-3, high_m), friction));
  made.bodies.push_back(fixedBox("front", Vec3(length_m, -half_m - 5e-3, -5e-3),
                                 Vec3(length_m + 5e-3, half_m + 5e-3, high_m), friction));
  std::vector<Mesh> meshes(static_cast<std::size_t>(1 + random.index(3)));
  for (Mesh& mesh : meshes) {
    const double size_m = random.uniform(0.4, 0.8) * half_m;
    mesh = random.chance(0.3) ? drawTetrahedron(random, 1.5 * size_m) : drawPrism(random, size_m);
  }
  const std::size_t first = made.bodies.size();
  dropAll(random, std::move(meshes), top_m, 2e-3, friction, made.bodies);
  for (std::size_t i = first; i < made.bodies.size(); ++i) {
    made.bodies[i].X_WP.p.x() += 1.5 * half_m;
    made.bodies[i].V_WP_W.v.x() = std::abs(made.bodies[i].V_WP_W.v.x());
  }
  made.seconds = random.uniform(0.5, 1.5);
  return made;
}

Case drawChain(Random& random) {
  const double bar_m = random.uniform(1.5e-3, 4e-3), length_m = bar_m * random.uniform(5, 8);
  const double width_m = bar_m * (3 + random.logUniform(0.02, 1)), friction = drawFriction(random);
  const double play_m = random.logUniform(20e-6, 0.5 * (length_m - 4 * bar_m));
  const Vec2 outer(width_m / 2, length_m / 2), inner = outer - Vec2::Constant(bar_m);
  Mesh link = makePrism(rectangle(-outer, outer), {rectangle(-inner, inner)}, -bar_m / 2, bar_m / 2);
  for (Vec3& p : link.vertices) p = Vec3(p.x(), -p.z(), p.y());
  Case made;
  const int links = 3 + random.index(5);
  for (int i = 0; i < links; ++i) {
    CaseBody body;
    body.name = "link" + std::to_string(i);
    body.mesh = link;
    body.X_WP.R = rotationFromVector(Vec3(0, 0, i % 2 == 0 ? 0 : std::numbers::pi / 2));
    body.X_WP.p.z() = -i * (length_m - 2 * bar_m - play_m);
    body.is_fixed = i == 0;
    body.friction = friction;
    if (i > 0) {
      body.V_WP_W.v = random.direction() * random.uniform(0, 0.5);
      body.V_WP_W.w = random.direction() * random.uniform(0, 5);
    }
    made.bodies.push_back(std::move(body));
  }
  if (random.chance(0.5)) {  // a hand moves the uppermost link
    made.bodies.front().is_fixed = false;
    Hand hand;
    for (int i = 0; i < 60; ++i)
      hand.goals.push_back({{random.tilt(1), random.inBox(Vec3::Constant(10e-3))},
                            random.logUniform(0.02, 0.2),
                            random.logUniform(0.5, 10)});
    made.hand = std::move(hand);
  }
  made.seconds = random.uniform(0.5, 2);
  return made;
}

}  // namespace vps::search

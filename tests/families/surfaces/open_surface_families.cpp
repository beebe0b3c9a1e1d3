// SPDX-License-Identifier: BSD-3-Clause
// J: a sphere or a cube falls on an open surface, whose mesh has no inside. The body must come to rest on the
// drawn triangles: contact must neither close the surface with a lid nor let the body through. The exact
// distance of the sphere's centre, or of the cube's corners, from the drawn triangles is the measure. The
// same fall on btBvhTriangleMeshShape, in the same world, shows how Bullet's own mesh behaves.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps/solid.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::World;

constexpr double kPi = std::numbers::pi;
enum class Sheet { Channel, Bowl, Terrain, BoxWithAHole, Flat, Moebius };
constexpr int kSheets = 6;

struct Fall {
  Sheet sheet = Sheet::Channel;
  double size_m = 0.2;      ///< the surface's greatest extent
  double radius_m = 10e-3;  ///< of the sphere; half the side of the cube
  bool is_cube = false;
  double drop_m = 30e-3;  ///< height of its lowest point above the surface
  int cells = 40;         ///< cells of the surface's mesh along each side
  double turn_rad = 0;
};

// In members 0 and 1 the fault was found.
Fall fallOf(int member) {
  Fall fall;
  if (member < 2) {
    fall.is_cube = member == 1;
    return fall;
  }
  test::Random random(static_cast<std::uint64_t>(member));
  fall.sheet = static_cast<Sheet>(member % kSheets);
  fall.size_m = fall.sheet == Sheet::Terrain ? random.logUniform(0.5, 60) : random.logUniform(0.05, 1);
  fall.radius_m = (fall.sheet == Sheet::Terrain ? 0.02 : 0.05) * fall.size_m;
  fall.is_cube = random.chance(0.3);
  fall.drop_m = random.uniform(0.2, 1) * std::min(fall.radius_m, 0.05);
  fall.cells = 8 + random.index(fall.sheet == Sheet::Terrain ? 90 : 40);
  fall.turn_rad = random.uniform(0, 2 * kPi);
  return fall;
}

std::string describe(int member) {
  const Fall f = fallOf(member);
  const char* names[] = {"channel", "bowl", "terrain", "box with a hole", "flat sheet", "Moebius strip"};
  char text[128];
  std::snprintf(text, sizeof text, "%s of %.3g m, %s of %.3g mm, %.3g mm high, %d cells",
                names[static_cast<int>(f.sheet)], f.size_m, f.is_cube ? "half cube" : "sphere",
                1e3 * f.radius_m, 1e3 * f.drop_m, f.cells);
  return text;
}

void addQuad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& v : {a, b, c, d}) mesh.vertices.push_back(v);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A grid of points over [0, 1]^2.
template <typename At>
Mesh grid(int nu, int nv, At at) {
  Mesh mesh;
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j)
      addQuad(mesh, at(double(i) / nu, double(j) / nv), at(double(i + 1) / nu, double(j) / nv),
              at(double(i + 1) / nu, double(j + 1) / nv), at(double(i) / nu, double(j + 1) / nv));
  return welded(mesh, 1e-9);
}

// The body falls along z at x = y = 0 towards z = 0, where every surface is level.
Mesh meshOf(const Fall& f) {
  const double s = f.size_m;
  switch (f.sheet) {
    case Sheet::Channel: {
      const double x = 0.5 * s, y = 0.15 * s, z = 0.15 * s;
      Mesh mesh;
      addQuad(mesh, {-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0});
      addQuad(mesh, {-x, y, 0}, {x, y, 0}, {x, y, z}, {-x, y, z});
      addQuad(mesh, {-x, -y, z}, {x, -y, z}, {x, -y, 0}, {-x, -y, 0});
      return welded(mesh);
    }
    case Sheet::Bowl: {  // half a sphere with a flat bottom wide enough for a cube
      const int rings = std::max(4, f.cells / 3);
      const double flat_m = 2.5 * f.radius_m, r_m = 0.5 * s;
      return grid(rings, 2 * f.cells, [&](double u, double v) {
        const double polar_rad = 0.5 * kPi * u,
                     at_m = u == 0 ? 0 : flat_m + (r_m - flat_m) * std::sin(polar_rad);
        const double z =
            u == 0 ? 0 : r_m * (1 - std::cos(polar_rad)) - r_m * (1 - std::cos(0.5 * kPi / rings));
        return Vec3(at_m * std::cos(2 * kPi * v), at_m * std::sin(2 * kPi * v), z);
      });
    }
    case Sheet::Terrain: {  // waves that are level where the body lands
      return grid(f.cells, f.cells, [&](double u, double v) {
        const double x = s * (u - 0.5), y = s * (v - 0.5), from_m = std::hypot(x, y) - 0.15 * s;
        if (from_m < 0) return Vec3(x, y, 0);
        const double fade = std::min(1.0, from_m / (0.1 * s));
        return Vec3(x, y, 0.03 * s * fade * std::sin(25 * x / s) * std::cos(20 * y / s));
      });
    }
    case Sheet::BoxWithAHole: {  // the body falls through the hole in its lid
      Mesh mesh;
      const double h = 0.5 * s, z = 0.15 * s, o = 0.1 * s;
      addQuad(mesh, {-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0});
      for (int k = 0; k < 4; ++k) {
        const Mat3 R = rotationFromVector({0, 0, 0.5 * kPi * k});
        addQuad(mesh, R * Vec3(h, -h, 0), R * Vec3(h, h, 0), R * Vec3(h, h, z), R * Vec3(h, -h, z));
        addQuad(mesh, R * Vec3(o, -o, z), R * Vec3(h, -h, z), R * Vec3(h, h, z), R * Vec3(o, o, z));
      }
      return welded(mesh, 1e-9);
    }
    case Sheet::Flat:
      return grid(f.cells, f.cells,
                  [&](double u, double v) { return Vec3(s * (u - 0.5), s * (v - 0.5), 0); });
    case Sheet::Moebius:
      break;
  }
  // A twist by half a turn over the far half of the length.
  return welded(grid(4 * f.cells, 4,
                     [&](double u, double v) {
                       const double along_rad = 2 * kPi * u, across_m = 0.3 * s * (v - 0.5);
                       const double twist_rad = kPi * std::clamp((u - 0.25) / 0.5, 0.0, 1.0);
                       const double r_m = 0.35 * s + across_m * std::cos(twist_rad);
                       return Vec3(r_m * std::cos(along_rad) - 0.35 * s, r_m * std::sin(along_rad),
                                   across_m * std::sin(twist_rad));
                     }),
                1e-9);
}

/// Distance of the body from the surface: 0 at rest, negative if they overlap.
double gap_m(const Solid& drawn, const Fall& fall, const Pose& X) {
  if (!fall.is_cube) return std::abs(drawn.closest(X.p).distance_m) - fall.radius_m;
  double least_m = 1e300;  // the surface is level below the cube
  for (const Vec3& v : makeBox(Vec3::Constant(2 * fall.radius_m)).vertices)
    least_m = std::min(least_m, (X * v).z());
  return least_m;
}

struct Errors {
  double ours_m = 0, bullets_m = 0;
};

Errors run(const Fall& fall) {
  const Mesh mesh = transformed(meshOf(fall), Pose(rotationFromVector({0, 0, fall.turn_rad}), Vec3::Zero()));
  const auto drawn = std::make_shared<const Solid>(Solid::sheet(mesh));
  const double voxel_m = std::max(0.25e-3, fall.size_m / 200);
  btTriangleMesh triangles;  // outlives the world, whose shape refers to it
  World world({dynamics::Mode::Constraint, false, dynamics::vpsEngine({voxel_m, 2 * voxel_m})});
  world.add({mesh, {}, drawn}, Pose(), true);
  // The same fall on Bullet's own mesh, far to the side.
  const Vec3 aside(0, 10 * fall.size_m, 0);
  for (const auto& t : mesh.triangles)
    triangles.addTriangle(bullet::toBt(mesh.vertices[t[0]]), bullet::toBt(mesh.vertices[t[1]]),
                          bullet::toBt(mesh.vertices[t[2]]));
  const auto bvh = std::make_shared<btBvhTriangleMeshShape>(&triangles, true);
  bvh->setMargin(0);
  world.addShape(bvh, {}, Pose::translation(aside));

  const double r = fall.radius_m;
  const Vec3 start(0, 0, r + fall.drop_m);
  bullet::BodyFrame frame;
  frame.mass_kg = 7850 * (fall.is_cube ? 8 : 4 * kPi / 3) * r * r * r;
  frame.inertia_kg_m2 = Vec3::Constant(frame.mass_kg * r * r * (fall.is_cube ? 2.0 / 3 : 0.4));
  const auto native = [&]() -> dynamics::ShapeHandle {
    if (!fall.is_cube) return std::make_shared<btSphereShape>(btScalar(r));
    return std::make_shared<btBoxShape>(btVector3(btScalar(r), btScalar(r), btScalar(r)));
  };
  btRigidBody* theirs = world.addShape(native(), frame, Pose::translation(start + aside));
  btRigidBody* ours = nullptr;
  if (fall.is_cube)
    ours = world.add(dynamics::makePart(makeBox(Vec3::Constant(2 * r))), Pose::translation(start)).body;
  else
    ours = world.addShape(native(), frame, Pose::translation(start));
  world.step(static_cast<int>(1e3 * std::sqrt(2 * fall.drop_m / World::kGravity_m_s2)) + 150);
  Pose X_theirs = bullet::fromBt(theirs->getWorldTransform());
  X_theirs.p -= aside;
  const Errors errors{std::abs(gap_m(*drawn, fall, bullet::fromBt(ours->getWorldTransform()))),
                      std::abs(gap_m(*drawn, fall, X_theirs))};
  return errors;
}

double error(int member) {
  const Fall fall = fallOf(member);
  const Errors errors = run(fall);
  return errors.ours_m / std::max({10e-6, 1e-6 * fall.size_m, errors.bullets_m});
}

}  // namespace

std::vector<Family> openSurfaceFamilies() {
  Family family;
  family.key = "J_open";
  family.measure = "distance from rest, over 10 um, 1e-6 of the size or Bullet's own";
  family.bar = 1;
  family.members = 60;
  family.every = 7;
  family.measured = error;
  family.describe = describe;
  return {family};
}

}  // namespace vps::families

// SPDX-License-Identifier: BSD-3-Clause
// G: finely meshed round bodies fall on flat faces, into grooves, on an edge and on each other, in any
// orientation.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dynamics/world.h"
#include "families/family.h"
#include "search/prism.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps/mesh_overlap.h"
#include "vps_bullet/convert.h"

namespace vps::families {

namespace {

using dynamics::PartMesh;
using dynamics::Placed;
using dynamics::World;
using Profile = std::vector<std::array<double, 2>>;

constexpr double kPi = std::numbers::pi;
enum class Shape { Sphere, Torus, Capsule, Lens, Rounded };
enum class On { Plane, Groove, Edge, Another };

struct RoundBody {
  Shape shape = Shape::Sphere;
  On on = On::Plane;
  double radius_m = 2e-3;
  int facets = 64;  ///< around
  int rings = 32;   ///< number of rings over half a turn
  Mat3 R = Mat3::Identity();
};

// Points on an arc about (r, z), from one angle to the other, both included.
void appendArc(Profile& profile, double r_m, double z_m, double radius_m, double from_rad, double to_rad,
               int steps) {
  for (int i = 0; i <= steps; ++i) {
    const double a_rad = from_rad + (to_rad - from_rad) * i / steps;
    const double at_r_m = r_m + radius_m * std::cos(a_rad);
    profile.push_back({at_r_m < 1e-9 * radius_m ? 0 : at_r_m, z_m + radius_m * std::sin(a_rad)});
  }
}

Mesh meshOf(const RoundBody& b) {
  const double r = b.radius_m;
  const int half = std::max(2, b.rings / 2);
  Profile profile;
  switch (b.shape) {
    case Shape::Sphere:
      appendArc(profile, 0, 0, r, -0.5 * kPi, 0.5 * kPi, b.rings);
      break;
    case Shape::Torus:
      appendArc(profile, r, 0, 0.4 * r, -kPi, kPi, b.rings);
      profile.pop_back();
      break;
    case Shape::Capsule:
      appendArc(profile, 0, -0.5 * r, 0.6 * r, -0.5 * kPi, 0, half);
      appendArc(profile, 0, 0.5 * r, 0.6 * r, 0, 0.5 * kPi, half);
      break;
    case Shape::Lens: {
      // Two caps of 60 degrees of spheres of twice the radius, which meet at a sharp rim.
      const double R = 1.1547 * r, rise = 0.5 * R;
      appendArc(profile, 0, rise, R, -0.5 * kPi, -kPi / 6, half);
      profile.pop_back();
      appendArc(profile, 0, -rise, R, kPi / 6, 0.5 * kPi, half);
      break;
    }
    case Shape::Rounded:  // a disc whose rim is half a circle
      profile.push_back({0, -0.4 * r});
      appendArc(profile, 0.6 * r, 0, 0.4 * r, -0.5 * kPi, 0.5 * kPi, b.rings);
      profile.push_back({0, 0.4 * r});
  }
  return test::lathe(profile, b.facets);
}

// Member 0 is the case in which the fault was found.
RoundBody bodyOf(int member) {
  RoundBody body;
  constexpr double kDegree = kPi / 180;
  if (member == 0) {
    body.R = rotationFromVector({0, 13 * kDegree, 0}) * rotationFromVector({20 * kDegree, 0, 0});
    return body;
  }
  test::Random random(static_cast<std::uint64_t>(member));
  const On supports[] = {On::Plane, On::Groove, On::Plane, On::Another, On::Plane, On::Edge};
  body.on = supports[member % 6];
  body.shape = static_cast<Shape>(member / 6 % 5);
  body.radius_m = random.logUniform(0.3e-3, 30e-3);
  body.facets = 4 * static_cast<int>(random.logUniform(3, 100));
  body.rings = std::clamp(body.facets / 2, 6, 48);
  body.R = random.rotation();
  return body;
}

std::string describe(int member) {
  const RoundBody b = bodyOf(member);
  const char* shapes[] = {"sphere", "torus", "capsule", "lens", "rounded disc"};
  const char* supports[] = {"a plane", "a groove", "an edge", "another"};
  char text[96];
  std::snprintf(text, sizeof text, "%s r %.3f mm, %d facets, on %s", shapes[static_cast<int>(b.shape)],
                1e3 * b.radius_m, b.facets, supports[static_cast<int>(b.on)]);
  return text;
}

/// The fixed body on which the round body falls, and the exact depth of the round body in it. A convex body
/// is deepest in a half-space at a vertex, so for faces the depth of the vertices is exact. For edges and for
/// another round body the overlap of the meshes is measured.
class Scene {
 public:
  Scene(World& world, const RoundBody& body, const PartMesh& part) : part_(part) {
    const double r = body.radius_m;
    const Vec3 slab(10 * r, 10 * r, 2 * r);
    const auto addSlab = [&](const Mat3& R) {
      world.add(dynamics::makePart(makeBox(slab)), Pose(R, R * Vec3(0, 0, -r)), true);
      normals_.push_back(R.col(2));
    };
    if (body.on == On::Plane) addSlab(Mat3::Identity());
    if (body.on == On::Groove)
      for (const double side : {-1.0, 1.0}) addSlab(rotationFromVector({0, side * kPi / 4, 0}));
    if (body.on == On::Edge)
      addMesh(
          world,
          search::alongX(search::makePrism({{-2 * r, -2 * r}, {2 * r, -2 * r}, {0, 0}}, {}, -4 * r, 4 * r)),
          Pose());
    if (body.on == On::Another) addMesh(world, part.mesh, Pose(body.R.transpose(), Vec3::Zero()));
    // Height of the falling body's lowest point; above another body, this body's extent is added.
    double above_m = 0.25 * r;
    if (body.on == On::Another)
      above_m -= lowest_m(part.mesh, rotationFromVector({kPi, 0, 0}) * body.R.transpose());
    X_start_ = Pose(body.R, Vec3(0, 0, 0));
    if (body.on == On::Groove || body.on == On::Plane) {
      for (const Vec3& n : normals_) {
        double lowest = 1e300;
        for (const Vec3& v : part.mesh.vertices) lowest = std::min(lowest, n.dot(body.R * v));
        X_start_.p.z() = std::max(X_start_.p.z(), (above_m - lowest) / n.z());
      }
    } else {
      X_start_.p.z() = above_m - lowest_m(part.mesh, body.R);
    }
    if (other_) mesh_ = std::make_unique<OverlapMesh>(part.exact);
  }
  [[nodiscard]] const Pose& start() const { return X_start_; }
  [[nodiscard]] double depth_m(const Pose& X) const {
    if (other_) return deepestOverlap(*mesh_, X, *other_, X_other_).depth_m;
    double deepest_m = 0;
    for (const Vec3& n : normals_)
      for (const Vec3& v : part_.mesh.vertices) deepest_m = std::max(deepest_m, -n.dot(X * v));
    return deepest_m;
  }

 private:
  static double lowest_m(const Mesh& mesh, const Mat3& R) {
    double lowest = 1e300;
    for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, (R * v).z());
    return lowest;
  }
  void addMesh(World& world, const Mesh& mesh, const Pose& X) {
    const PartMesh other = dynamics::makePart(mesh);
    world.add(other, X, true);
    other_ = std::make_unique<OverlapMesh>(other.exact);
    X_other_ = X;
  }
  const PartMesh& part_;
  std::vector<Vec3> normals_;
  std::unique_ptr<OverlapMesh> mesh_, other_;
  Pose X_other_, X_start_;
};

struct Depths {
  double impact_m = 0, rest_m = 0;
};

// The body falls by a quarter of its radius. After it has come to rest on a face or in a groove, its depth is
// measured again; from an edge or another round body it rolls off.
Depths measure(const RoundBody& body) {
  const PartMesh part = dynamics::makePart(meshOf(body));
  const double voxel_m = std::clamp(body.radius_m / 8, 0.03e-3, 0.5e-3);
  World world({dynamics::Mode::Constraint, false, dynamics::vpsEngine({voxel_m, 2 * voxel_m})});
  const Scene scene(world, body, part);
  const Placed placed = world.add(part, scene.start(), false, 0.3);
  const int landing = static_cast<int>(1e3 * std::sqrt(2 * 0.25 * body.radius_m / World::kGravity_m_s2));
  world.step(std::max(0, landing - 3));
  Depths depths;
  for (int i = 0; i < 60; ++i) {
    world.step();
    depths.impact_m = std::max(depths.impact_m, scene.depth_m(placed.pose()));
  }
  if (body.on == On::Edge || body.on == On::Another) return depths;
  world.step(300);
  for (int i = 0; i < 20; ++i) {
    world.step();
    depths.rest_m = std::max(depths.rest_m, scene.depth_m(placed.pose()));
  }
  return depths;
}

const Depths& depthsOf(int member) {
  static std::map<int, Depths> results;
  const auto it = results.find(member);
  return it != results.end() ? it->second : results.emplace(member, measure(bodyOf(member))).first->second;
}

}  // namespace

std::vector<Family> roundBodyFamilies() {
  Family rest;
  rest.key = "G_rest";
  rest.measure = "depth at rest [um]";
  rest.bar = 1;
  rest.members = 60;
  rest.every = 3;
  rest.measured = [](int member) { return 1e6 * depthsOf(member).rest_m; };
  rest.describe = describe;
  Family impact = rest;
  impact.key = "G_impact";
  impact.measure = "depth in and after the impact [um]";
  impact.bar = 10;
  impact.measured = [](int member) { return 1e6 * depthsOf(member).impact_m; };
  return {rest, impact};
}

}  // namespace vps::families

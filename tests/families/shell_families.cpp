// SPDX-License-Identifier: BSD-3-Clause
// Meshes of several shells: the solid is their union, whichever way each of them faces.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "box_union.h"
#include "dynamics/world.h"
#include "family.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"

namespace vps::families {
namespace {

constexpr int kBoxMembers = 90, kNestedMembers = 54, kRoundMembers = 60, kRestMembers = 54;

/// The pose in which member i's mesh is: of every fifth without a rotation.
Pose poseOf(int i) {
  search::Random random(9000 + static_cast<std::uint64_t>(i));
  const Mat3 R = i % 5 == 0 ? Mat3(Mat3::Identity()) : random.rotation();
  return {R, random.inBox(Vec3::Constant(0.05))};
}

/// Which shells face in: of a third of the members none, some, all.
std::vector<bool> facesIn(int i, std::size_t count) {
  search::Random random(9500 + static_cast<std::uint64_t>(i));
  std::vector<bool> faces_in;
  for (std::size_t k = 0; k < count; ++k)
    faces_in.push_back(i % 3 == 2 || (i % 3 == 1 && random.chance(0.5)));
  return faces_in;
}

std::string describeBoxes(int i) {
  const BoxMember member = boxMember(i);
  return member.kind + " of " + std::to_string(member.boxes.size()) + " boxes that overlap by " +
         std::to_string(1e6 * member.overlap_m) + " um" +
         (i % 3 == 2   ? ", all inverted"
          : i % 3 == 1 ? ", some inverted"
                       : "");
}

Mesh boxMesh(int i) {
  const BoxMember member = boxMember(i);
  return transformed(shellsOf(member.boxes, facesIn(i, member.boxes.size())), poseOf(i));
}

double massOfBoxes(int i) {
  const Mesh mesh = boxMesh(i);
  const MassProperties truth = moved(BoxUnion(boxMember(i).boxes).mass(), poseOf(i));
  const double size_m = bounds(mesh).size().norm();
  return std::max(difference(Solid(mesh).mass(), truth, size_m), difference(solidMass(mesh), truth, size_m));
}

double distanceToBoxes(int i) {
  const BoxUnion boxes(boxMember(i).boxes);
  const Solid solid(boxMesh(i));
  const Pose X = poseOf(i);
  const Box box = bounds(shellsOf(boxes.boxes()));
  search::Random random(9700 + static_cast<std::uint64_t>(i));
  double worst_m = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = box.center() + 1.2 * random.inBox(0.5 * box.size());
    worst_m = std::max(worst_m, std::abs(solid.signedDistance(X * p) - boxes.distance(p)));
  }
  return 1e6 * worst_m;
}

// ---- shells within shells

struct Nested {
  std::string kind;
  Mesh mesh;
  MassProperties truth;
};

MassProperties plus(const MassProperties& a, const MassProperties& b, double sign) {
  MassProperties sum;
  sum.volume_m3 = a.volume_m3 + sign * b.volume_m3;
  sum.com = (a.volume_m3 * a.com + sign * b.volume_m3 * b.com) / sum.volume_m3;
  const auto about = [&](const MassProperties& m) {
    const Vec3 p = m.com - sum.com;
    return Mat3(m.inertia_m5 + m.volume_m3 * (p.squaredNorm() * Mat3::Identity() - p * p.transpose()));
  };
  sum.inertia_m5 = about(a) + sign * about(b);
  return sum;
}

/// Two boxes, apart or one in the other.
Nested nestedMember(int i) {
  search::Random random(8000 + static_cast<std::uint64_t>(i));
  const Vec3 half(random.uniform(8e-3, 30e-3), random.uniform(8e-3, 30e-3), random.uniform(8e-3, 30e-3));
  const Box outer{-half, half};
  const Vec3 inner_half = half * random.uniform(0.2, 0.7), at = random.inBox(0.25 * half);
  const Box inner{at - inner_half, at + inner_half};
  const Vec3 away(2.5 * half.x(), 0, 0);
  const Box other{outer.min + away, outer.max + away};
  const MassProperties of_outer = BoxUnion({outer}).mass(), of_inner = BoxUnion({inner}).mass(),
                       of_other = BoxUnion({other}).mass();
  switch (i % 6) {
    case 0:  // the two cubes
      return {"two equal boxes, one inverted", shellsOf({outer, other}, {false, true}),
              plus(of_outer, of_other, 1)};
    case 1:
      return {"two equal boxes, both inverted", shellsOf({outer, other}, {true, true}),
              plus(of_outer, of_other, 1)};
    case 2:
      return {"an inner shell that faces out", shellsOf({outer, inner}, {false, false}), of_outer};
    case 3:
      return {"a cavity", shellsOf({outer, inner}, {false, true}), plus(of_outer, of_inner, -1)};
    case 4:
      return {"a cavity, all inverted", shellsOf({outer, inner}, {true, false}),
              plus(of_outer, of_inner, -1)};
    default:
      return {"an inner shell, all inverted", shellsOf({outer, inner}, {true, true}), of_outer};
  }
}

double massOfNested(int i) {
  const Nested member = nestedMember(i);
  const Mesh mesh = transformed(member.mesh, poseOf(i));
  const MassProperties truth = moved(member.truth, poseOf(i));
  const double size_m = bounds(mesh).size().norm();
  return std::max(difference(Solid(mesh).mass(), truth, size_m), difference(solidMass(mesh), truth, size_m));
}

// ---- round shells

/// A prism over a regular polygon, in a round number of ways half sunk into a box, stacked on it, or beside
/// it. Its volume within the box has a formula.
struct Round {
  std::string kind;
  Mesh mesh;
  double volume_m3;
};

Round roundMember(int i) {
  search::Random random(8500 + static_cast<std::uint64_t>(i));
  const double r = random.uniform(4e-3, 12e-3), h = random.uniform(5e-3, 20e-3);
  const Vec3 size(4 * r, 4 * r, 2 * h);
  const Mesh box = makeBox(size);
  const double box_m3 = size.prod(), sunk_m = i % 2 == 0 ? 0 : random.logUniform(1e-6, 0.9 * h);
  const int segments = 12 + random.index(90);
  const double prism_m2 = 0.5 * segments * r * r * std::sin(2 * std::numbers::pi / segments);
  const auto onTop = [&](Mesh mesh, double height_m) {
    const Mat3 turn = rotationFromVector(Vec3(0, 0, random.uniform(0, 6)));
    append(mesh = transformed(
               mesh, Pose(turn, Vec3(random.uniform(-0.5, 0.5) * r, 0, h + 0.5 * height_m - sunk_m))),
           box);
    return mesh;
  };
  switch (i % 3) {
    case 0:
      return {"cylinder on a box", onTop(makeCylinder(r, h, segments), h), box_m3 + prism_m2 * (h - sunk_m)};
    case 1: {  // half of the sphere's mesh is above its equator, which is one of its planes of symmetry
      Mesh mesh = transformed(makeSphere(r, 2 + i % 2), Pose(Mat3::Identity(), Vec3(0, 0, h)));
      const double sphere_m3 = massProperties(mesh).volume_m3;
      append(mesh, transformed(makeBox(Vec3(4 * r, 4 * r, 2 * r + 2 * h)), Pose::translation({0, 0, -r})));
      return {"sphere half sunk into a box", mesh, 16 * r * r * (2 * r + 2 * h) + 0.5 * sphere_m3};
    }
    default: {  // a peg in its bore, of the same facets, and through it
      Mesh mesh = makeTube(2 * r, r, h, segments);
      append(mesh, makeCylinder(r, h + sunk_m, segments));
      return {"peg in its bore", mesh, 4 * prism_m2 * h + prism_m2 * sunk_m};
    }
  }
}

double massOfRound(int i) {
  const Round member = roundMember(i);
  Mesh mesh = transformed(member.mesh, poseOf(i));
  if (i % 4 >= 2)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return std::abs(Solid(mesh).mass().volume_m3 / member.volume_m3 - 1);
}

// ---- a ball that rests on them

/// A floor of shells whose tops are flush, with a wall on one side or on both, in the frame in which gravity
/// points along -z: a U, or an L. Member 0 is the case that was found: three boxes, one of them a floor that
/// the walls stand on.
std::vector<Box> channelMember(int i) {
  search::Random random(9900 + static_cast<std::uint64_t>(i));
  const double o = i % 2 == 0 ? 0 : random.logUniform(1e-6, 5e-3);
  constexpr double kSide_m = 30e-3, kThick_m = 10e-3;
  const double seam_m = i % 3 == 0 ? kSide_m : random.uniform(-2e-3, 2e-3);
  std::vector<Box> boxes = {{{-kSide_m, -kSide_m, -kThick_m}, {seam_m, kSide_m, 0}}};
  if (seam_m < kSide_m) boxes.push_back({{seam_m - o, -kSide_m, -kThick_m}, {kSide_m, kSide_m, 0}});
  boxes.push_back({{-kSide_m, 12e-3, -o}, {kSide_m, kSide_m, 20e-3}});
  if (i % 4 != 3) boxes.push_back({{-kSide_m, -kSide_m, -o}, {kSide_m, -12e-3, 20e-3}});
  return boxes;
}

[[maybe_unused]] std::string describeChannel(int i) {
  return std::to_string(channelMember(i).size()) + " boxes" + (i % 5 == 0 ? "" : ", rotated");
}

/// The ball comes down onto the floor, where it stays: it touches nothing else.
double ballRests(int i) {
  using namespace dynamics;
  const std::vector<Box> boxes = channelMember(i);
  search::Random random(9950 + static_cast<std::uint64_t>(i));
  const BoxUnion truth(boxes);
  SceneSettings settings;
  settings.engine = vpsEngine({1e-3, 2e-3});
  World world(settings);
  const Pose X = poseOf(i);
  const PartMesh floor = makePart(transformed(shellsOf(boxes, facesIn(i, boxes.size())), X));
  // Coarse enough that its corners are features of their own: how finely meshed balls rest is kind G.
  const PartMesh ball = makePart(makeSphere(10e-3, 2));
  world.setGravity(X.R * Vec3(0, 0, -World::kGravity_m_s2));
  world.add(floor, Pose(), true);
  const Vec3 start(random.uniform(-3e-3, 3e-3), random.uniform(-1e-3, 1e-3), 10.1e-3);
  const Placed placed = world.add(ball, X * Pose(random.rotation(), start));
  world.step(300);
  double deepest_m = 0;
  const Pose X_floor = X.inverse() * placed.pose();
  for (const Vec3& v : ball.mesh.vertices) deepest_m = std::max(deepest_m, -truth.distance(X_floor * v));
  return 1e6 * deepest_m;
}

}  // namespace

std::vector<Family> shellFamilies() {
  const auto kindOf = [](auto member) { return [member](int i) { return member(i).kind; }; };
  return {
      {"E_box_mass", "relative error of volume, centre and inertia of 2 to 9 boxes that touch or overlap",
       1e-9, kBoxMembers, 3, massOfBoxes, describeBoxes},
      {"E_box_distance", "error of the signed distance to them, at 300 points [um]", 1e-3, kBoxMembers, 3,
       distanceToBoxes, describeBoxes},
      {"E_nested_mass", "relative error of mass properties of shells apart and in each other", 1e-9,
       kNestedMembers, 1, massOfNested, kindOf(nestedMember)},
      {"E_round_volume", "relative error of the volume of cylinders and spheres sunk into boxes", 1e-9,
       kRoundMembers, 2, massOfRound, kindOf(roundMember)},
      {"E_ball_rests", "depth of a ball of 10 mm that rests on shells, voxels of 1 mm [um]", 1, kRestMembers,
       9, ballRests, nullptr},
  };
}

}  // namespace vps::families

// SPDX-License-Identifier: BSD-3-Clause
// E: meshes of several shells. The solid is their union, whether a shell faces outwards or inwards.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "box_union.h"
#include "dynamics/world.h"
#include "families/family.h"
#include "vps/mesh_repair.h"
#include "vps/solid.h"

namespace vps::families {
namespace {

constexpr int kBoxMembers = 90, kNestedMembers = 54, kRoundMembers = 60, kRestMembers = 54,
              kCrossingMembers = 120, kCopyMembers = 72, kLevelMembers = 60;

/// The pose of member i's mesh; every fifth has no rotation.
Pose poseOf(int i) {
  test::Random random(9000 + static_cast<std::uint64_t>(i));
  const Mat3 R = i % 5 == 0 ? Mat3(Mat3::Identity()) : random.rotation();
  return {R, random.inBox(Vec3::Constant(0.05))};
}

/// Which shells face inwards: none, some or all, for a third of the members each.
std::vector<bool> facesIn(int i, std::size_t count) {
  test::Random random(9500 + static_cast<std::uint64_t>(i));
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
  test::Random random(9700 + static_cast<std::uint64_t>(i));
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

/// Two boxes that are apart, or one inside the other.
Nested nestedMember(int i) {
  test::Random random(8000 + static_cast<std::uint64_t>(i));
  const Vec3 half(random.uniform(8e-3, 30e-3), random.uniform(8e-3, 30e-3), random.uniform(8e-3, 30e-3));
  const Box outer{-half, half};
  const Vec3 inner_half = half * random.uniform(0.2, 0.7), at = random.inBox(0.25 * half);
  const Box inner{at - inner_half, at + inner_half};
  const Vec3 away(2.5 * half.x(), 0, 0);
  const Box other{outer.min + away, outer.max + away};
  const MassProperties of_outer = BoxUnion({outer}).mass(), of_inner = BoxUnion({inner}).mass(),
                       of_other = BoxUnion({other}).mass();
  switch (i % 6) {
    case 0:  // the two cubes of the reported case
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

// ---- shells that cross each other

/// Two or three shells that cross.
struct Crossing {
  std::string kind;
  std::vector<Box> boxes;  ///< empty: tetrahedra
};

Crossing crossingMember(int i) {
  test::Random random(8800 + static_cast<std::uint64_t>(i));
  const auto mm = [](double a, double b, double c, double d, double e, double f) {
    return Box{1e-3 * Vec3(a, b, c), 1e-3 * Vec3(d, e, f)};
  };
  const auto round = [&](int low, int high) { return low + random.index(high - low + 1); };
  switch (i % 6) {
    case 0: {  // member 0 is the case in which the fault was found
      const double o = i == 0 ? 2 : random.uniform(0.5, 19);
      return {"cubes of 20 mm, one moved along its diagonal",
              {mm(0, 0, 0, 20, 20, 20), mm(o, o, o, 20 + o, 20 + o, 20 + o)}};
    }
    case 1: {  // round numbers: faces lie in planes that contain evenly spaced points
      const double l = i == 1 ? 20 : round(6, 25), w = i == 1 ? 5 : round(2, 5), h = i == 1 ? 5 : round(1, 5);
      return {"bars that cross as a plus, faces in one plane",
              {mm(-l, -w, -5, l, w, 5), mm(-w, -l, -h, w, l, h)}};
    }
    case 2: {
      const double l = i == 2 ? 8 : random.uniform(5.1, 20);
      return {"a bar through a bar", {mm(-20, -5, -5, 20, 5, 5), mm(-5, -l, -3, 5, l, 3)}};
    }
    case 3: {
      Crossing member{"boxes centred in one point", {}};
      const int count = 2 + random.index(2);
      for (int k = 0; k < count; ++k) {
        const Vec3 half = 1e-3 * Vec3(round(1, 20), round(1, 20), round(1, 20));
        member.boxes.push_back({-half, half});
      }
      return member;
    }
    case 4: {
      const double sunk = i == 4 ? 9 : random.uniform(0.5, 9.9);
      return {"a boss sunk into a plate",
              {mm(-20, -20, -5, 20, 20, 5), mm(-5, -5, 5 - sunk, 5, 5, 15 - sunk)}};
    }
    default:
      return {"two tetrahedra in a cube", {}};
  }
}

/// True if a box lies within another one. The inner box's shell would be a void if it faced inwards.
bool isNested(const std::vector<Box>& boxes) {
  for (const Box& inner : boxes)
    for (const Box& outer : boxes)
      if (&inner != &outer && isWithin(inner, outer)) return true;
  return false;
}

std::vector<bool> crossingFacesIn(int i, std::size_t count) {
  std::vector<bool> faces_in;
  for (std::size_t k = 0; k < count; ++k) faces_in.push_back((i / 6 + 1) >> k & 1);
  return faces_in;
}

Mesh tetrahedron(double half_m, bool is_mirrored, bool faces_in) {
  Mesh mesh;
  mesh.vertices = {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  for (Vec3& v : mesh.vertices) v *= is_mirrored ? -half_m : half_m;
  if ((massProperties(mesh).volume_m3 < 0) != faces_in)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Error of volume, centre and inertia. For tetrahedra, whose union has the volume 4 h^3, the error is only
/// that of volume and centre.
double massOfCrossing(int i) {
  const Crossing member = crossingMember(i);
  test::Random random(8900 + static_cast<std::uint64_t>(i));
  const Pose X = i % 4 == 0 ? Pose(random.rotation(), random.inBox(Vec3::Constant(0.05))) : Pose();
  if (member.boxes.empty()) {
    const std::vector<bool> faces_in = crossingFacesIn(i, 2);
    const double h = random.uniform(2e-3, 20e-3);
    Mesh mesh = tetrahedron(h, false, faces_in[0]);
    append(mesh, tetrahedron(h, true, faces_in[1]));
    const MassProperties mass = Solid(transformed(mesh, X)).mass();
    return std::max(std::abs(mass.volume_m3 / (4 * h * h * h) - 1), (mass.com - X.p).norm() / h);
  }
  std::vector<bool> faces_in = crossingFacesIn(i, member.boxes.size());
  if (isNested(member.boxes)) faces_in.assign(member.boxes.size(), i / 6 % 2 == 0);
  const Mesh mesh = transformed(shellsOf(member.boxes, faces_in), X);
  const MassProperties truth = moved(BoxUnion(member.boxes).mass(), X);
  const double size_m = bounds(mesh).size().norm();
  return std::max(difference(Solid(mesh).mass(), truth, size_m), difference(solidMass(mesh), truth, size_m));
}

// ---- a solid given twice

/// A box whose faces are divided into a grid of n cells along each axis.
Mesh gridBox(const Box& box, const std::array<int, 3>& n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool is_high : {false, true}) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const int rows = n[static_cast<std::size_t>(b)], columns = n[static_cast<std::size_t>(c)];
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= rows; ++i)
        for (int k = 0; k <= columns; ++k) {
          Vec3 p = is_high ? box.max : box.min;
          p[b] = i == rows ? box.max[b] : box.min[b] + box.size()[b] * i / rows;
          p[c] = k == columns ? box.max[c] : box.min[c] + box.size()[c] * k / columns;
          mesh.vertices.push_back(p);
        }
      for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
          const std::uint32_t p = base + static_cast<std::uint32_t>(i * (columns + 1) + k),
                              q = p + static_cast<std::uint32_t>(columns) + 1;
          mesh.triangles.push_back({p, q, q + 1});
          mesh.triangles.push_back({p, q + 1, p + 1});
          if (!is_high)
            for (std::size_t t = mesh.triangles.size() - 2; t < mesh.triangles.size(); ++t)
              std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        }
    }
  return mesh;
}

struct Copies {
  Box box;
  std::vector<std::array<int, 3>> grids;
  std::vector<bool> faces_in;
};

/// In members 0 to 3 the fault was found.
Copies copiesMember(int i) {
  test::Random random(9200 + static_cast<std::uint64_t>(i));
  const auto half = [&] { return random.uniform(3e-3, 20e-3); };
  const Vec3 size(half(), half(), half());
  Copies member{{-size, size}, {{1, 1, 1}}, {i % 4 == 3}};
  const std::array<int, 3> found[] = {{2, 2, 2}, {3, 4, 5}, {1, 1, 2}, {1, 1, 1}};
  const int count = i < 4 ? 1 : 1 + random.index(3);
  for (int k = 0; k < count; ++k) {
    const std::array<int, 3> drawn = {1 + random.index(5), 1 + random.index(5), 1 + random.index(5)};
    member.grids.push_back(i < 4 ? found[i] : drawn);
    member.faces_in.push_back(k == 0 ? i % 4 < 3 : random.chance(0.5));
  }
  return member;
}

std::string describeCopies(int i) {
  const Copies member = copiesMember(i);
  std::string text = "a box given " + std::to_string(member.grids.size()) + " times, grids";
  for (std::size_t k = 0; k < member.grids.size(); ++k) {
    for (const int n : member.grids[k]) text += " " + std::to_string(n);
    text += member.faces_in[k] ? " inverted," : ",";
  }
  return text + (i / 4 % 2 == 0 ? "" : " rotated");
}

double massOfCopies(int i) {
  const Copies member = copiesMember(i);
  Mesh mesh;
  for (std::size_t k = 0; k < member.grids.size(); ++k) {
    Mesh box = gridBox(member.box, member.grids[k]);
    if (member.faces_in[k])
      for (auto& t : box.triangles) std::swap(t[1], t[2]);
    append(mesh, box);
  }
  const Pose X = i / 4 % 2 == 0 ? Pose() : poseOf(i % 5 == 0 ? i + 1 : i);
  mesh = transformed(mesh, X);
  const MassProperties truth = moved(BoxUnion({member.box}).mass(), X);
  const double size_m = bounds(mesh).size().norm();
  const Solid solid(mesh);
  const bool is_there = solid.isInside(X * Vec3(0.3 * member.box.max));
  return std::max({is_there ? 0.0 : 1.0, difference(solid.mass(), truth, size_m),
                   difference(solidMass(mesh), truth, size_m)});
}

// ---- three to six shells, each within the previous shell

/// Which shells face inwards, the outermost first. The outermost shell faces outwards after the repair.
std::vector<bool> levelFacesIn(int i) {
  test::Random random(9300 + static_cast<std::uint64_t>(i));
  if (i == 0) return {false, true, true};  // the case in which the fault was found
  std::vector<bool> faces_in;
  for (int k = 0, n = 3 + random.index(4); k < n; ++k) faces_in.push_back(random.chance(0.5));
  return faces_in;
}

std::string describeLevels(int i) {
  std::string text = "shells that face, from the outermost:";
  for (const bool faces_in : levelFacesIn(i)) text += faces_in ? " in" : " out";
  return text;
}

/// Error of the mass properties, or the number of gaps between shells whose side is wrong. A shell that faces
/// like the outermost one adds one to the winding number inside itself, a shell of the opposite orientation
/// subtracts one; space is solid where the winding number is above 0.
double massOfLevels(int i) {
  const std::vector<bool> faces_in = levelFacesIn(i);
  test::Random random(9350 + static_cast<std::uint64_t>(i));
  const Vec3 half(random.uniform(20e-3, 40e-3), random.uniform(20e-3, 40e-3), random.uniform(20e-3, 40e-3));
  std::vector<Box> boxes;
  for (std::size_t k = 0; k < faces_in.size(); ++k)
    boxes.push_back(
        {-half * (1 - 0.14 * static_cast<double>(k)), half * (1 - 0.14 * static_cast<double>(k))});
  MassProperties truth;
  std::vector<bool> is_solid;
  int winding = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    winding += faces_in[k] == faces_in[0] ? 1 : -1;
    is_solid.push_back(winding > 0);
    if (k == 0) truth = BoxUnion({boxes[0]}).mass();
    if (k > 0 && is_solid[k] != is_solid[k - 1])
      truth = plus(truth, BoxUnion({boxes[k]}).mass(), is_solid[k] ? 1 : -1);
  }
  const Pose X = poseOf(i);
  const Mesh mesh = transformed(shellsOf(boxes, faces_in), X);
  const double size_m = bounds(mesh).size().norm();
  const Solid solid(mesh);
  double wrong = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k)
    wrong += solid.isInside(X * Vec3(0.93 * boxes[k].max.x(), 0, 0)) != is_solid[k];
  return std::max({wrong, difference(solid.mass(), moved(truth, X), size_m),
                   difference(solidMass(mesh), moved(truth, X), size_m)});
}

// ---- round shells

/// A round shell and a box: a cylinder stands on the box, a sphere is half sunk into it, or a peg is in its
/// bore. The volume of the union has a formula.
struct Round {
  std::string kind;
  Mesh mesh;
  double volume_m3;
};

Round roundMember(int i) {
  test::Random random(8500 + static_cast<std::uint64_t>(i));
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
    case 1: {  // half of the sphere's mesh is above its equator, which is a plane of symmetry
      Mesh mesh = transformed(makeSphere(r, 2 + i % 2), Pose(Mat3::Identity(), Vec3(0, 0, h)));
      const double sphere_m3 = massProperties(mesh).volume_m3;
      append(mesh, transformed(makeBox(Vec3(4 * r, 4 * r, 2 * r + 2 * h)), Pose::translation({0, 0, -r})));
      return {"sphere half sunk into a box", mesh, 16 * r * r * (2 * r + 2 * h) + 0.5 * sphere_m3};
    }
    default: {  // a peg that passes through its bore, with the same facets
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

/// A floor of shells whose tops are flush, with a wall on one side (an L) or on both sides (a U); gravity
/// points along -z. Member 0 is the case in which the fault was found: three boxes, of which one is the floor
/// below the two walls.
std::vector<Box> channelMember(int i) {
  test::Random random(9900 + static_cast<std::uint64_t>(i));
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

/// The ball falls on the floor and comes to rest there, touching nothing else.
double ballRests(int i) {
  using namespace dynamics;
  const std::vector<Box> boxes = channelMember(i);
  test::Random random(9950 + static_cast<std::uint64_t>(i));
  const BoxUnion truth(boxes);
  SceneSettings settings;
  settings.engine = vpsEngine({1e-3, 2e-3});
  World world(settings);
  const Pose X = poseOf(i);
  const PartMesh floor = makePart(transformed(shellsOf(boxes, facesIn(i, boxes.size())), X));
  // The mesh is coarse enough for its corners to be features; kind G has finely meshed balls.
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
      {"E_crossing_mass", "relative error of mass properties of shells that cross, some inverted", 1e-9,
       kCrossingMembers, 2, massOfCrossing, kindOf(crossingMember)},
      {"E_copies_mass", "the same of solids given two to four times with other facets, or 1 if none is there",
       1e-9, kCopyMembers, 3, massOfCopies, describeCopies},
      {"E_levels_mass", "the same of three to six shells in each other; points on the wrong side", 1e-9,
       kLevelMembers, 1, massOfLevels, describeLevels},
      {"E_round_volume", "relative error of the volume of cylinders and spheres sunk into boxes", 1e-9,
       kRoundMembers, 2, massOfRound, kindOf(roundMember)},
      {"E_ball_rests", "depth of a ball of 10 mm that rests on shells, voxels of 1 mm [um]", 1, kRestMembers,
       9, ballRests, nullptr},
  };
}

}  // namespace vps::families

// SPDX-License-Identifier: BSD-3-Clause
// The judge of a motion itself: it finds passages between the poses of two steps, does not report a body that
// passes without touching, and gives exact depths. Contact acts only in G_printed.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "families/family.h"
#include "judge/motion_judge.h"
#include "support/fit.h"
#include "support/random_draw.h"
#include "support/units.h"
#include "vps_scenes/run/simulate.h"

namespace vps::families {
namespace {

using scenes::ExactBody;
using scenes::MotionJudge;
using test::Random;

constexpr double kStep_s = 1e-3;

std::shared_ptr<const ExactBody> exact(const Mesh& mesh) {
  return std::make_shared<const ExactBody>(std::make_shared<const Solid>(mesh));
}

/// A sphere of meridians and parallels, as in CAD exports.
Mesh uvSphere(double radius_m, int columns, int rows) {
  Mesh mesh;
  mesh.vertices.push_back({0, 0, radius_m});
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double polar = std::numbers::pi * row / rows, around = 2 * std::numbers::pi * column / columns;
      mesh.vertices.push_back(radius_m * Vec3(std::sin(polar) * std::cos(around),
                                              std::sin(polar) * std::sin(around), std::cos(polar)));
    }
  mesh.vertices.push_back({0, 0, -radius_m});
  const auto at = [&](int row, int column) {
    if (row == 0) return 0U;
    if (row == rows) return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (row - 1) * columns + column % columns);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (row + 1 < rows)
        mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
      if (row > 0) mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
    }
  return mesh;
}

Mesh sheetMesh(double side_m) {
  const double h = side_m / 2;
  Mesh mesh;
  mesh.vertices = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// A fixed body at the origin, and a body that is moved past or through it within one step.
struct Passage {
  std::string words;
  Mesh fixed, moving;
  Pose X_0, X_1;
  double formula_m = 0;  ///< depth by formula; 0: no formula is known
};

/// The greatest depth at many poses of the step.
double sampledDepth_m(const Passage& passage, int samples) {
  const std::shared_ptr<const ExactBody> fixed = exact(passage.fixed), moving = exact(passage.moving);
  const Box near = grown(fixed->box(), 0.5 * moving->box().size().norm());
  const scenes::BodyMotion motion(passage.X_0, passage.X_1, Vec3::Zero());
  // Only the part of the step in which the moving body's centre is near the fixed body is sampled.
  double from = 1, to = 0;
  for (int i = 0; i <= 200000; ++i) {
    const double share = i / 200000.0;
    if (!isWithin(passage.X_0.p + share * (passage.X_1.p - passage.X_0.p), near)) continue;
    from = std::min(from, share);
    to = std::max(to, share);
  }
  double deepest_m = 0;
  for (int i = 0; i <= samples; ++i)
    deepest_m = std::max(deepest_m, deepestOverlap(fixed->overlap(), {}, moving->overlap(),
                                                   motion.at(from + (to - from) * i / samples), true)
                                        .depth_m);
  return deepest_m;
}

MotionJudge judged(const Passage& passage) {
  const auto body = [](const Mesh& mesh, bool is_fixed) {
    return scenes::MovingBody{bounds(mesh), Vec3::Zero(), is_fixed, [&mesh] { return exact(mesh); }};
  };
  MotionJudge judge({body(passage.fixed, true), body(passage.moving, false)}, {Pose(), passage.X_0}, 0);
  judge.addStep(kStep_s, {Pose(), passage.X_1}, 200e3);
  judge.search();
  return judge;
}

/// Sets a motion that passes through the position p_W with the rotation R at a share of the step.
void move(Passage& passage, Random& random, const Vec3& p_W, const Mat3& R, const Vec3& v_W,
          const Vec3& w_W) {
  const double share = random.uniform(0.05, 0.95);
  passage.X_0 = Pose(Mat3(rotationFromVector(-share * kStep_s * w_W) * R), p_W - share * kStep_s * v_W);
  passage.X_1 =
      Pose(Mat3(rotationFromVector((1 - share) * kStep_s * w_W) * R), p_W + (1 - share) * kStep_s * v_W);
}

Passage passageThrough(int member) {
  Random random(1000 + static_cast<std::uint64_t>(member));
  Passage passage;
  const double r_m = random.logUniform(0.3, 15) * kMm;
  const Vec3 spin = random.direction() * random.uniform(0, 300) * (member % 2);
  Vec3 toward = random.direction();
  toward.z() = std::copysign(std::max(std::abs(toward.z()), 0.3), toward.z());
  toward.normalize();
  double reach_m = 3 * r_m;
  passage.moving = member % 3 == 0 ? makeBox(Vec3(1.6, 1.2, 2) * r_m) : uvSphere(r_m, 32, 16);
  const Vec3 beside_m(0.1 * r_m, -0.05 * r_m, 0);
  switch (member % 5) {
    case 0: {
      const double thick_m = random.logUniform(0.05 * kMm, r_m);
      passage.words = "plate";
      passage.fixed = makeBox({20 * r_m, 20 * r_m, thick_m});
      if (member % 3 != 0) passage.formula_m = thick_m / 2;
      reach_m += thick_m;
      break;
    }
    case 1:
      passage.words = "wall of a tube";
      passage.fixed = transformed(makeTube(12 * r_m, 11 * r_m, 40 * r_m, 64),
                                  Pose(rotationFromVector({M_PI / 2, 0, 0}), Vec3(0, 0, -11.5 * r_m)));
      reach_m += 2 * r_m;
      break;
    case 2:
      passage.words = "pin";
      passage.fixed = transformed(makeCylinder(random.uniform(0.05, 0.5) * r_m, 20 * r_m, 24),
                                  Pose(rotationFromVector({0, M_PI / 2, 0}), Vec3::Zero()));
      break;
    case 3:
      passage.words = "ring";
      passage.fixed = transformed(test::makeTorus(4 * r_m, random.uniform(0.1, 0.4) * r_m, 48, 16),
                                  Pose::translation({4 * r_m, 0, 0}));
      break;
    default:
      passage.words = "sheet";
      passage.fixed = sheetMesh(20 * r_m);
      if (member % 3 != 0) passage.formula_m = 0.97 * r_m;
      break;
  }
  const double speed_m_s = random.logUniform(std::max(5.0, 6 * reach_m / kStep_s), 5000);
  move(passage, random, beside_m, random.rotation(), speed_m_s * toward, spin);
  // The motion starts and ends far away, for any share of the step.
  const Vec3 extra = 20 * reach_m * toward;
  passage.X_0.p -= extra;
  passage.X_1.p += extra;
  passage.words += " at " + std::to_string(speed_m_s) + " m/s, r " + std::to_string(r_m / kMm) + " mm";
  return passage;
}

/// A body that passes ten micrometres beside the fixed one; the vertices give the smallest gap.
Passage passageBeside(int member) {
  Random random(3000 + static_cast<std::uint64_t>(member));
  Passage passage;
  const double r_m = random.logUniform(0.3, 15) * kMm, gap_m = 10 * kUm, speed = random.logUniform(5, 5000);
  const Vec3 along(1, 0, 0);
  Vec3 spin = Vec3::Zero();
  Vec3 p_W;
  const Mat3 R = random.rotation();
  switch (member % 5) {
    case 0:
      passage.words = "sphere over a plate";
      passage.fixed = makeBox({20 * r_m, 20 * r_m, 2 * r_m});
      passage.moving = uvSphere(r_m, 32, 16);
      spin = Vec3(0, random.uniform(-1, 1) * 300, 0);
      p_W = {0, 0, 2 * r_m + gap_m};
      break;
    case 1:
      passage.words = "sphere along an edge";
      passage.fixed = makeBox({4 * r_m, 4 * r_m, 4 * r_m});
      passage.moving = uvSphere(r_m, 32, 16);
      p_W = Vec3(0, 2 * r_m, 2 * r_m) + (r_m + gap_m) * Vec3(0, 1, 1).normalized();
      break;
    case 2:
      passage.words = "sphere past a pin";
      passage.fixed = makeCylinder(0.4 * r_m, 20 * r_m, 24);
      passage.moving = uvSphere(r_m, 32, 16);
      p_W = {0, 1.4 * r_m + gap_m, 0};
      break;
    case 3:
      passage.words = "sphere along a bore";
      passage.fixed = transformed(makeTube(2 * r_m, r_m / std::cos(M_PI / 48) + gap_m, 8 * r_m, 48),
                                  Pose(rotationFromVector({0, M_PI / 2, 0}), Vec3::Zero()));
      passage.moving = uvSphere(r_m, 32, 16);
      p_W = Vec3::Zero();
      break;
    default:
      passage.words = "box that turns over a plate";
      passage.fixed = makeBox({20 * r_m, 20 * r_m, 2 * r_m});
      passage.moving = makeBox(Vec3(1, 1, 1) * (2 * r_m / std::sqrt(3.0)));  // the corners lie on a sphere
      spin = random.direction() * random.uniform(0, 300);
      p_W = {0, 0, 2 * r_m + gap_m};
      break;
  }
  move(passage, random, p_W, R, speed * along, spin);
  passage.words += " at " + std::to_string(speed) + " m/s, r " + std::to_string(r_m / kMm) + " mm";
  return passage;
}

/// The share of the depth that the judge did not find.
double missedShare(const Passage& passage) {
  const double found_m = judged(passage).deepest().depth_m;
  const double sampled_m = sampledDepth_m(passage, 300);
  return std::max(
      {0.0, 1 - found_m / sampled_m, passage.formula_m > 0 ? 1 - found_m / passage.formula_m : 0});
}

/// The depth that is reported although nothing touches [um].
double falseDepth_um(const Passage& passage) {
  return judged(passage).deepest().depth_m / kUm;
}

/// By how much the reported bound exceeds the tolerance although nothing touches [um].
double boundExcess_um(const Passage& passage) {
  return (judged(passage).bound_m() - MotionJudge::toleranceOf(0)) / kUm;
}

/// A sphere of a random mesh at a random orientation, at a known depth.
struct Placed {
  Mesh fixed, moving;
  Pose X_WP;
  double depth_m = 0;
};

double lowest_m(const Mesh& mesh, const Mat3& R) {
  double lowest = 1e300;
  for (const Vec3& v : mesh.vertices) lowest = std::min(lowest, (R * v).z());
  return lowest;
}

/// Depth of a point inside a mesh: the distance of its nearest triangle.
double inMesh_m(const Mesh& mesh, const Vec3& p) {
  double nearest_m = 1e300;
  for (const auto& t : mesh.triangles)
    nearest_m = std::min(
        nearest_m,
        (closestOnTriangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).q - p).norm());
  return nearest_m;
}

Placed placedSphere(int member) {
  Random random(5000 + static_cast<std::uint64_t>(member));
  Placed placed;
  const int columns = static_cast<int>(random.logUniform(12, 400));
  const double r_m = random.logUniform(0.3, 30) * kMm;
  const double depth_m = std::min(random.logUniform(0.01, 300) * kUm, 0.1 * r_m);
  const Mesh sphere = uvSphere(r_m, columns, std::max(3, columns / 2));
  placed.depth_m = depth_m;
  const Mat3 R = random.rotation();
  if (member % 2 == 0) {  // on a plate: the depth of the lowest vertex
    placed.fixed = makeBox({8 * r_m, 8 * r_m, 2 * r_m});
    placed.moving = sphere;
    placed.X_WP = Pose(R, Vec3(0.3 * r_m, 0.2 * r_m, r_m - lowest_m(sphere, R) - depth_m));
  } else {  // the corner of a cube in the sphere, by all triangles
    placed.fixed = sphere;
    placed.moving = makeBox(Vec3::Constant(4 * r_m));
    const Vec3 out = random.direction();
    const Mat3 R_cube = Quat::FromTwoVectors(Vec3(-1, -1, -1), -out).toRotationMatrix();
    const Vec3 corner = (r_m - depth_m) * out;
    placed.X_WP = Pose(R_cube, corner - R_cube * Vec3::Constant(-2 * r_m));
    const bool is_inside = Solid(sphere).isInside(corner);
    placed.depth_m = is_inside ? inMesh_m(sphere, corner) : 0;
  }
  return placed;
}

double depthError_um(const Placed& placed) {
  const scenes::PairMeasure found =
      measurePair(*exact(placed.fixed), {}, *exact(placed.moving), placed.X_WP, 1 * kMm);
  return std::abs(std::max(0.0, found.depth_m) - placed.depth_m) / kUm;
}

/// A sphere dropped on a plate; member 0 is meshed like a bearing ball of a CAD program.
scenes::Scene dropScene(int member) {
  Random random(7000 + static_cast<std::uint64_t>(member));
  const double r_m = member == 0 ? 2 * kMm : random.logUniform(0.5, 3) * kMm;
  const int columns = member == 0 ? 64 : 2 * static_cast<int>(random.logUniform(6, 40));
  scenes::Scene scene;
  scene.file = scene.name = "drop";
  scene.parts.resize(2);
  scene.parts[0].part.name = "plate";
  const Vec3 plate = member == 0 ? Vec3(36, 36, 5) * r_m : Vec3(12, 12, 3) * r_m;
  scene.parts[0].part.mesh = makeBox(plate);
  scene.parts[0].is_fixed = true;
  scene.parts[0].X_WP = Pose::translation({0, 0, -0.5 * plate.z()});
  scene.parts[1].part.name = "ball";
  scene.parts[1].part.mesh = uvSphere(r_m, columns, columns / 2);
  constexpr double kDegree = M_PI / 180;
  const Mat3 drawn = rotationFromVector({0, 13 * kDegree, 0}) * rotationFromVector({20 * kDegree, 0, 0});
  const Mat3 R = member == 0 ? drawn : random.rotation();
  scene.parts[1].X_WP = Pose(R, Vec3(0, 0, 0.5 * kMm - lowest_m(scene.parts[1].part.mesh, R)));
  return scene;
}

/// Difference between the depth that simulate() prints and the depth of the lowest vertex at the ends of all
/// steps. The printed depth may be greater, since simulate() also finds depths between the ends of steps.
double printedError_um(int member) {
  scenes::Scene scene = dropScene(member);
  const Mesh mesh = scene.parts[1].part.mesh;
  double deepest_m = 0;
  scenes::SimulateOptions options;
  options.trace = [&](double, const std::vector<scenes::BodyState>& bodies, double) {
    deepest_m = std::max(deepest_m, -(bodies[0].X_WP.p.z() + lowest_m(mesh, bodies[0].X_WP.R)));
  };
  const double printed_m = scenes::simulate(scene, 0.03, options).max_penetration_m;
  return std::abs(printed_m - deepest_m) / kUm;
}

}  // namespace

std::vector<Family> judgeFamilies() {
  std::vector<Family> out;
  out.push_back({"C_judge_passages", "share of a passage's depth that the judge does not see", 0.05, 120, 4,
                 [](int member) { return missedShare(passageThrough(member)); },
                 [](int member) { return passageThrough(member).words; }});
  out.push_back({"C_judge_beside", "depth reported where a body passes at a gap of 10 um [um]", 0.01, 100, 4,
                 [](int member) { return falseDepth_um(passageBeside(member)); },
                 [](int member) { return passageBeside(member).words; }});
  // For a body in a bore no direction separates the convex hulls.
  out.push_back({"C_judge_bound", "excess of the bound where a body passes at a gap of 10 um [um]", 0.01, 100,
                 4, [](int member) { return boundExcess_um(passageBeside(member)); },
                 [](int member) { return passageBeside(member).words; }});
  out.push_back({"G_depth", "error of the judge's depth of sphere meshes [um]", 0.11, 100, 4,
                 [](int member) { return depthError_um(placedSphere(member)); }});
  out.push_back({"G_printed", "error of the depth that simulate prints [um]", 3, 50, 10, printedError_um});
  return out;
}

}  // namespace vps::families

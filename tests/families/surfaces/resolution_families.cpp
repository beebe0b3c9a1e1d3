// SPDX-License-Identifier: BSD-3-Clause
// F: the same relative answers for parts from 20 um to 20 m, with the resolution that is chosen for a scene
// that states none.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>

#include "families/family.h"
#include "support/gear.h"
#include "support/lathe.h"
#include "support/random_draw.h"
#include "vps/voxmap.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/run/explain.h"
#include "vps_scenes/run/simulate.h"

namespace vps::families {
namespace {

constexpr double kGravity_m_s2 = 9.81, kFriction = 0.15, kStep_s = 1e-3;
constexpr int kMembers = 56;
enum Kind { kBlock, kPeg, kRing, kGears, kKinds };

struct Made {
  Kind kind = kBlock;
  double size_m = 0;     ///< of the block, the peg, the hole of the ring, the wheel
  double clearance = 0;  ///< of the diameter
  double thin = 1;       ///< height of the block over its width
};

// Some members are reported cases: cubes of 500 and 800 mm, a panel of 2 m, a gear with a bore of 0.1 mm.
Made memberOf(int member) {
  test::Random random(0xF000 + static_cast<std::uint64_t>(member));
  Made made;
  made.kind = static_cast<Kind>(member % kKinds);
  made.size_m = random.logUniform(20e-6, 20);
  made.clearance = random.logUniform(1e-3, 1e-2);
  if (member == 0) made.size_m = 0.5;
  if (member == 4) made.size_m = 0.8;
  if (member == 8) made = {kBlock, 2, 0, 0.01};
  if (member == 39) made = {kGears, 1e-3, 5e-3, 1};
  return made;
}

std::string describe(int member) {
  const Made made = memberOf(member);
  const char* names[] = {"block on plate", "peg in bore", "ring over pin", "gears on pins"};
  char text[160];
  std::snprintf(text, sizeof text, "%s of %.4g mm, clearance %.2g of the diameter, height %.2g of the width",
                names[made.kind], 1e3 * made.size_m, made.clearance, made.thin);
  return text;
}

void add(scenes::Scene& scene, const std::string& name, const Mesh& mesh, const Pose& X_WP, bool is_fixed) {
  scenes::ScenePart part;
  part.part.name = name;
  part.part.mesh = mesh;
  part.part.material.friction = kFriction;
  part.file = name + ".stl";
  part.X_WP = X_WP;
  part.is_fixed = is_fixed;
  scene.parts.push_back(std::move(part));
}

Pose at(double x_m, double y_m, double z_m) {
  return Pose::translation(Vec3(x_m, y_m, z_m));
}

// The velocity at which a body slides by half its size. slideOf() allows for steps of `kStep_s`.
double slideSpeed(double size_m) {
  return std::sqrt(2 * kFriction * kGravity_m_s2 * 0.5 * size_m);
}

// The distance after which friction stops a body, if each step subtracts mu g dt from the velocity and moves
// the body by the new velocity.
double slideOf(double speed_m_s) {
  double way_m = 0;
  for (double v = speed_m_s; (v -= kFriction * kGravity_m_s2 * kStep_s) > 0;) way_m += v * kStep_s;
  return way_m;
}

constexpr int kSides = 96;  // sides of round parts: the flats are inside the circle by 5.4e-4 of the radius

// Pin and hole have their corners at the same angles, but the pin may turn. The corners of a turned pin must
// still fit between the flats of the hole.
double holeRadius(const Made& made) {
  return 0.5 * made.size_m * (1 + made.clearance) / std::cos(std::numbers::pi / kSides);
}

scenes::Scene sceneOf(const Made& made) {
  scenes::Scene scene;
  scene.file = scene.name = "family";
  const double d = made.size_m;
  if (made.kind == kBlock) {
    add(scene, "plate", makeBox(Vec3(4 * d, 4 * d, 0.2 * d)), at(0, 0, -0.1 * d), true);
    add(scene, "block", makeBox(Vec3(d, d, made.thin * d)), at(-0.5 * d, 0, 0.5 * made.thin * d), false);
    scene.parts.back().V_WP_W.v = Vec3(slideSpeed(d), 0, 0);
  } else if (made.kind == kPeg) {
    const double hole_m = holeRadius(made);
    add(scene, "hole",
        test::lathe({{0, -0.5 * d},
                     {2 * hole_m, -0.5 * d},
                     {2 * hole_m, 2 * d},
                     {hole_m, 2 * d},
                     {hole_m, 0},
                     {0, 0}},
                    kSides),
        Pose(), true);
    add(scene, "peg", makeCylinder(0.5 * d, 2 * d, kSides), at(0, 0, 2.6 * d), false);
  } else if (made.kind == kRing) {
    add(scene, "pin",
        test::lathe(
            {{0, -0.3 * d}, {2 * d, -0.3 * d}, {2 * d, 0}, {0.5 * d, 0}, {0.5 * d, 2 * d}, {0, 2 * d}},
            kSides),
        Pose(), true);
    add(scene, "ring", makeTube(d, holeRadius(made), 0.4 * d, kSides), at(0, 0, 1.2 * d), false);
  } else {
    test::GearShape gear;
    gear.teeth = 16;
    gear.module_m = d / 16;
    gear.width_m = d / 6;
    gear.backlash_m = 0.02 * gear.module_m;
    gear.other_radius_m = d / 20;
    gear.points_per_tooth = 16;
    gear.axial_steps = gear.radial_steps = 1;
    const double pin_m = gear.other_radius_m * (1 - made.clearance), apart_m = d * (1 + 1e-3);
    add(scene, "plate", makeBox(Vec3(3 * d, 2 * d, 0.2 * d)), at(0.5 * d, 0, -0.1 * d), true);
    for (const double x_m : {0.0, apart_m})
      add(scene, x_m == 0 ? "pin" : "other pin", makeCylinder(pin_m, 0.4 * d, kSides), at(x_m, 0, 0.2 * d),
          true);
    const Mesh mesh = test::makeSpurGear(gear);
    add(scene, "wheel", mesh, at(0, 0, 0.5 * gear.width_m), false);
    scene.parts.back().V_WP_W.w = Vec3(0, 0, std::min(10.0, 0.3 * std::sqrt(kGravity_m_s2 / d)));
    add(scene, "driven", mesh,
        Pose(rotationFromVector(Vec3(0, 0, std::numbers::pi / gear.teeth)),
             Vec3(apart_m, 0, 0.5 * gear.width_m)),
        false);
  }
  // Returns the settings that loadScene() gives a scene without [fidelity].
  scene.chooses_voxel = scene.chooses_spacing = true;
  scenes::resolveFidelity(scene);
  return scene;
}

struct Measured {
  double depth = 0, misplaced = 0;  ///< relative to the size
  bool begins_apart = true;
};

Measured runOf(const Made& made) {
  scenes::Scene scene = sceneOf(made);
  const double d = made.size_m;
  const double unit_s = std::sqrt(d / kGravity_m_s2);
  const double times[] = {4, 8, 8, 0.5};  // a fall by 2 d takes 2 units, a slide by d / 2 takes 2.6
  const double seconds = std::max(50 * kStep_s, times[made.kind] * unit_s);
  scenes::SimulateOptions options;
  options.judge_every = std::max(1, static_cast<int>(seconds / kStep_s / 25));
  const scenes::SimulateResult result = scenes::simulate(scene, seconds, options);
  Measured measured;
  measured.depth = result.overlap->deepest.depth_m / d;
  measured.begins_apart = result.overlap->at_start.empty();
  const Vec3 end = result.bodies.front().X_WP.p;
  if (made.kind == kBlock)
    measured.misplaced =
        (end - Vec3(-0.5 * d + slideOf(slideSpeed(d)), 0, 0.5 * made.thin * d)).cwiseAbs().maxCoeff() / d;
  else if (made.kind == kPeg)
    measured.misplaced = std::abs(end.z() - d) / d;
  else if (made.kind == kRing)
    measured.misplaced = std::abs(end.z() - 0.2 * d) / d;
  else
    measured.misplaced = std::abs(end.z() - d / 12) / d;
  return measured;
}

// Two families measure the same runs, so results are kept.
const Measured& run(int member) {
  static std::map<int, Measured> done;
  const auto found = done.find(member);
  return found != done.end() ? found->second : done.emplace(member, runOf(memberOf(member))).first->second;
}

double bytesShare(int member) {
  const scenes::Scene scene = sceneOf(memberOf(member));
  const double most_bytes =
      expectedMapBytes(makeBox(Vec3::Constant(scenes::kLargestUsual_m)), VoxMapSettings());
  const auto cost = scenes::estimate(scene, scenes::ModelPurpose::Simulate, {}).cost;
  return static_cast<double>(cost.most.bytes) / (most_bytes * static_cast<double>(scene.parts.size()));
}

}  // namespace

std::vector<Family> resolutionFamilies() {
  std::vector<Family> families;
  // The bar allows the memory of the cube's voxmap, and the same amount again for the points, which are two
  // voxels apart in thin parts.
  families.push_back({.key = "F_cost",
                      .measure = "estimated memory of the models, over that of maps of cubes of 150 mm",
                      .bar = 2,
                      .members = kMembers,
                      .every = 1,
                      .measured = bytesShare,
                      .describe = describe});
  // 10 um, the limit of `vps simulate`, for a part of 100 mm.
  families.push_back(
      {.key = "F_depth",
       .measure = "greatest overlap over the size of the part, 1 if it begins inside",
       .bar = 1e-4,
       .members = kMembers,
       .every = 13,
       .measured = [](int member) { return run(member).begins_apart ? run(member).depth : 1.0; },
       .describe = describe});
  // Parts rest at a gap of at most 0.1 um if lengths are scaled so that the parts are 1 mm across or more;
  // the rest of the bar is rounding.
  families.push_back({.key = "F_place",
                      .measure = "distance from where the part comes to rest, over its size",
                      .bar = 5.1e-4,
                      .members = kMembers,
                      .every = 13,
                      .measured = [](int member) { return run(member).misplaced; },
                      .describe = describe});
  return families;
}

}  // namespace vps::families

// SPDX-License-Identifier: BSD-3-Clause
#include "hand_scenes.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "support/lathe.h"

namespace vps::hand {

namespace {

using Profile = std::vector<std::array<double, 2>>;

/// The profile turned into a square tube of the same half widths: its corners stand at 45 degrees.
Mesh squareLathe(Profile profile) {
  for (auto& [r, z] : profile) r *= std::numbers::sqrt2;
  const double eighth_rad = std::numbers::pi / 4;
  return transformed(test::lathe(profile, 4),
                     Pose(rotationFromVector(Vec3(0, 0, eighth_rad)), Vec3(Vec3::Zero())));
}

/// Moves both halves apart along x; points on the axis stay.
Mesh stretched(Mesh mesh, double by_m) {
  for (Vec3& p : mesh.vertices)
    if (p.x() != 0) p.x() += std::copysign(0.5 * by_m, p.x());
  return mesh;
}

Mesh swept(const PegFit& fit, const Profile& profile) {
  return fit.is_round ? test::lathe(profile, kFlats) : stretched(squareLathe(profile), fit.longer_m);
}

}  // namespace

double chord_m(const PegFit& fit) {
  return fit.is_round ? 0.5 * fit.size_m * (1 - std::cos(std::numbers::pi / kFlats)) : 0;
}

Mesh holeMesh(const PegFit& fit) {
  const double out = fit.is_round ? 1 / std::cos(std::numbers::pi / kFlats) : 1;
  const double bore_m = 0.5 * (fit.size_m + fit.clearance_m), bottom_m = 1.5 * fit.depth_m;
  Profile cup = {{0, -bottom_m}, {fit.outer_m, -bottom_m}};
  if (fit.has_wall) {
    cup.push_back({fit.outer_m, 0});
    if (fit.chamfer_m > 0) cup.push_back({out * (bore_m + fit.chamfer_m), 0});
    cup.push_back({out * bore_m, -fit.chamfer_m});
    cup.push_back({out * bore_m, -fit.depth_m});
  } else {
    cup.push_back({fit.outer_m, -fit.depth_m});
  }
  cup.push_back({0, -fit.depth_m});
  return transformed(swept(fit, cup),
                     Pose(rotationFromVector(Vec3(0, 0, fit.hole_turn_rad)), Vec3(Vec3::Zero())));
}

Mesh pegMesh(const PegFit& fit) {
  const double half_m = 0.5 * fit.size_m, length_m = 2.5 * fit.depth_m;
  Profile peg = {{0, 0}, {half_m - fit.chamfer_m, 0}};
  if (fit.chamfer_m > 0) peg.push_back({half_m, fit.chamfer_m});
  peg.push_back({half_m, length_m});
  peg.push_back({0, length_m});
  return swept(fit, peg);
}

scenes::Scene pegScene(const std::string& name, Mesh hole, Mesh peg, double depth_m, std::uint64_t seed) {
  scenes::Scene scene;
  scene.file = scene.name = name;
  scene.parts.resize(2);
  scene.parts[0].part = {"hole", std::move(hole), {}, {}};
  scene.parts[0].is_fixed = true;
  scene.parts[1].part = {"peg", std::move(peg), {}, {}};
  scene.steps.resize(1);
  scene.steps[0].part = 1;
  scene.steps[0].X_WP_target = Pose::translation({0, 0, -depth_m});
  scene.steps[0].X_WP_start = Pose::translation({0, 0, 8e-3});
  scene.steps[0].timeout_s = 40;
  scene.release_s = 0.1;
  scene.hand.seed = seed;
  return scene;
}

namespace {

scenes::Scene fitScene(const std::string& name, const PegFit& fit, std::uint64_t seed) {
  scenes::Scene made = pegScene(name, holeMesh(fit), pegMesh(fit), fit.depth_m, seed);
  made.steps[0].clearance_m = fit.clearance_m;
  return made;
}

scenes::Scene roundPeg(std::uint64_t seed) {
  PegFit fit;
  fit.clearance_m = 20e-6;
  fit.chamfer_m = 0.5e-3;
  return fitScene("round", fit, seed);
}

scenes::Scene rectangularPeg(std::uint64_t seed) {
  PegFit fit;
  fit.is_round = false;
  fit.size_m = 4e-3;
  fit.clearance_m = 100e-6;
  fit.depth_m = fit.outer_m = 8e-3;
  return fitScene("rectangular", fit, seed);
}

scenes::Scene turnedPeg(std::uint64_t seed) {
  PegFit fit;
  fit.is_round = false;
  fit.size_m = 8e-3;
  fit.longer_m = 4e-3;
  fit.clearance_m = 100e-6;
  scenes::Scene made = fitScene("turned", fit, seed);
  made.hand.aim_turn_rad = 5 * std::numbers::pi / 180;
  made.steps[0].timeout_s = 60;
  return made;
}

}  // namespace

const std::vector<PegScene>& pegScenes() {
  static const std::vector<PegScene> scenes = {
      {"round", "8 mm round peg, 20 um of clearance, chamfered", roundPeg},
      {"rectangular", "4 mm square peg, 50 um on each side, sharp", rectangularPeg},
      {"turned", "8 x 12 mm peg, 50 um on each side, sharp, aimed up to 5 degrees off about its axis",
       turnedPeg}};
  return scenes;
}

}  // namespace vps::hand
